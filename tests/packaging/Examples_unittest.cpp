#include <gtest/gtest.h>

#include <regex>

#include "Shell.h"

/** What is shown to users in doc/examples does what it says, as far as that can be tried without a container. */
namespace viwo::testing
{
namespace
{
const std::string kExamples = VIWO_SOURCE_DIR "/doc/examples/";

/** The instructions of a Dockerfile, continued lines joined. */
std::vector<std::string> instructions(const std::string& path)
{
	std::vector<std::string> all;
	bool goes_on = false;
	for (std::string line : lines(readFile(path)))
	{
		if (line.empty() || line[0] == '#') continue;
		const bool continued = line.back() == '\\';
		if (continued) line.pop_back();
		if (goes_on)
			all.back() += line;
		else
			all.push_back(line);
		goes_on = continued;
	}
	return all;
}

bool contains(const std::string& text, const std::string& part)
{
	return text.find(part) != std::string::npos;
}
}  // namespace

TEST(Examples, DockerfileCallsWhatThereIs)
{
	const std::string verbs = bash("\"$1\" --help", {VIWO_SOURCE_DIR "/run.sh"}).out;
	int stages = 0, verbs_called = 0;
	bool all_copied = false;
	for (const std::string& line : instructions(kExamples + "Dockerfile"))
	{
		stages += line.rfind("FROM debian:12", 0) == 0 ? 1 : 0;
		std::smatch match;
		if (std::regex_search(line, match, std::regex(R"(RUN \./run\.sh (\w+))")))
		{
			++verbs_called;
			EXPECT_TRUE(contains(verbs, "\n  " + match[1].str() + " ")) << line << ": run.sh has no such verb";
			EXPECT_TRUE(match[1] == "prepare" || all_copied) << line << ": without the source";
		}
		all_copied = all_copied || line == "COPY . .";
		if (contains(line, "apt-get install"))
		{
			EXPECT_LT(line.find("apt-get update"), line.find("apt-get install")) << line;
			for (const char* part : {" -y ", "--no-install-recommends", "rm -rf /var/lib/apt/lists"})
				EXPECT_TRUE(contains(line, part)) << line;
		}
	}
	EXPECT_EQ(stages, 2);
	EXPECT_EQ(verbs_called, 2);
}

/** The packages of the second stage are those that the first makes. */
TEST(Examples, DockerfileTakesThePackagesThatAreMade)
{
	std::string copied;
	for (const std::string& line : instructions(kExamples + "Dockerfile"))
		if (line.rfind("COPY --from=build", 0) == 0) copied = line;
	const std::string config = readFile(VIWO_BINARY_DIR "/CPackConfig.cmake");
	for (const char* package : {"viwo", "libviwo0"})
	{
		EXPECT_TRUE(contains(config, "_PACKAGE_NAME \"" + std::string(package) + "\"")) << package;
		EXPECT_TRUE(contains(copied, "/src/build/packages/" + std::string(package) + "_*.deb")) << copied;
		EXPECT_TRUE(contains(readFile(kExamples + "github-actions.yml"), "./packages/" + std::string(package) + "_*.deb"));
	}
}

/** The steps that run viwo's programs, on the sample as the robot's log. */
TEST(Examples, ContinuousIntegrationRuns)
{
	const TempFolder folder;
	std::filesystem::create_directories(folder.file("logs"));
	const std::string sample = VIWO_SOURCE_DIR "/rawlogs/sample";
	std::filesystem::copy(sample + ".rawlog", folder.file("logs/run.rawlog"));
	std::filesystem::copy(sample + "_ground_truth.tum", folder.file("logs/run_ground_truth.tum"));
	std::filesystem::create_directory_symlink(sample + "_Images", folder.file("logs/sample_Images"));
	write(folder, "robot.ini", "[rawlog]\nimu_label = IMU\n");
	size_t steps = 0;
	for (const std::string& line : lines(readFile(kExamples + "github-actions.yml")))
	{
		const size_t start = line.find("run: viwo-");
		if (start == std::string::npos) continue;
		++steps;
		const ProgramResult result =
		    bash("cd \"$1\" && PATH=\"$2:$PATH\" && eval \"$3\"", {folder.path(), VIWO_BINARY_DIR "/bin", line.substr(start + 5)});
		EXPECT_EQ(result.status, 0) << line << "\n" << result.out << result.err;
	}
	EXPECT_EQ(steps, 3u);
	EXPECT_TRUE(contains(readFile(folder.file("out/report.html")), "<svg"));
}
}  // namespace viwo::testing
