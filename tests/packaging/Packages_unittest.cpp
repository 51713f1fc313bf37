#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <map>
#include <regex>
#include <set>

#include "Shell.h"

/** The packages that cpack makes of this build; a test that runs before these makes them in build/packages_test. */
namespace viwo::testing
{
namespace
{
const std::string kFolder = VIWO_BINARY_DIR "/packages_test";
const std::string kLibraries = "libviwo0", kPrograms = "viwo", kDevelopment = "libviwo-dev";

class Packages : public ::testing::Test
{
   protected:
	void SetUp() override
	{
		if (bash("command -v dpkg-deb && command -v dpkg-shlibdeps").status != 0)
			GTEST_SKIP() << "no Debian system with dpkg-dev: no packages";
		ASSERT_EQ(packageFiles().size(), 3u) << "in " << kFolder << "; they are made by: ctest -R Packaging.Make";
	}

	static std::vector<std::string> packageFiles()
	{
		std::vector<std::string> files;
		for (const auto& entry : std::filesystem::directory_iterator(kFolder))
			if (entry.path().extension() == ".deb") files.push_back(entry.path().string());
		return files;
	}

	static std::string fileOf(const std::string& package)
	{
		for (const std::string& file : packageFiles())
			if (std::filesystem::path(file).filename().string().rfind(package + "_", 0) == 0) return file;
		return {};
	}

	static std::string field(const std::string& package, const std::string& name)
	{
		const ProgramResult result = bash("dpkg-deb -f \"$1\" \"$2\"", {fileOf(package), name});
		EXPECT_EQ(result.status, 0) << result.err;
		return result.out.substr(0, result.out.find_last_not_of('\n') + 1);
	}

	/** Names of the packages that it depends on, without their versions. */
	static std::set<std::string> dependencies(const std::string& package)
	{
		const std::vector<std::string> names =
		    lines(bash("dpkg-deb -f \"$1\" Depends | tr ',' '\\n' | sed -E 's/^ *([^ ]+).*/\\1/'", {fileOf(package)}).out);
		return {names.begin(), names.end()};
	}

	/** Lines of "tar -tv" by path: mode, owner, size, date; and where a link points. */
	static std::map<std::string, std::string> contents(const std::string& package)
	{
		std::map<std::string, std::string> files;
		for (const std::string& line : lines(bash("dpkg-deb --fsys-tarfile \"$1\" | tar --numeric-owner -tvf -", {fileOf(package)}).out))
		{
			const size_t start = line.find(" ./");
			const size_t end = std::min(line.find(" -> "), line.size());
			files[line.substr(start + 2, end - start - 2)] = line.substr(0, start) + line.substr(end);
		}
		return files;
	}
};

TEST_F(Packages, SayWhatTheyAreAndNeed)
{
	for (const std::string& package : {kPrograms, kLibraries, kDevelopment})
	{
		EXPECT_EQ(field(package, "Package"), package);
		EXPECT_EQ(field(package, "Version").find(field(kPrograms, "Version")), 0u);
		EXPECT_FALSE(field(package, "Maintainer").empty());
		EXPECT_GE(lines(field(package, "Description")).size(), 4u) << field(package, "Description");
	}
	EXPECT_EQ(field(kPrograms, "Section"), "science");
	const std::string same = " (= " + field(kLibraries, "Version") + ")";
	for (const std::string& package : {kPrograms, kDevelopment})
		EXPECT_NE((field(package, "Depends") + ",").find(kLibraries + same + ","), std::string::npos) << field(package, "Depends");
	// What each library links, and what each #include and find_dependency() of the headers asks for.
	const std::set<std::string> libraries = dependencies(kLibraries), headers = dependencies(kDevelopment);
	for (const char* name :
	     {"libc6", "libmrpt-obs2.5", "libmrpt-poses2.5", "libopencv-core406", "libopencv-calib3d406", "liboctomap1.9", "libyaml-cpp0.7"})
		EXPECT_EQ(libraries.count(name), 1u) << name << " is not among: " << field(kLibraries, "Depends");
	for (const char* name : {"libeigen3-dev", "libmrpt-obs-dev", "libopencv-dev", "nlohmann-json3-dev", "liboctomap-dev"})
		EXPECT_EQ(headers.count(name), 1u) << name << " is not among: " << field(kDevelopment, "Depends");
	EXPECT_EQ(libraries.count(kPrograms) + libraries.count(kLibraries), 0u);
	EXPECT_EQ(field(kPrograms, "Recommends"), "mrpt-apps");
}

/** find_package(viwo) asks for packages of the build; each of them must come with libviwo-dev. */
TEST_F(Packages, DevelopmentBringsWhatFindPackageAsksFor)
{
	const std::string config = readFile(VIWO_BINARY_DIR "/viwoConfig.cmake");
	const std::set<std::string> names = dependencies(kDevelopment);
	const std::map<std::string, std::string> brings{
	    {"Eigen3", "libeigen3-dev"}, {"OpenCV", "libopencv-dev"}, {"nlohmann_json", "nlohmann-json3-dev"}, {"octomap", "liboctomap-dev"}};
	for (const auto& [asked, package] : brings)
	{
		EXPECT_NE(config.find("find_dependency(" + asked), std::string::npos) << asked << " is asked for no more";
		EXPECT_EQ(names.count(package), 1u) << package;
	}
	for (const std::string& module :
	     lines(bash("sed -nE 's/^foreach\\(module (.*)\\)$/\\1/p' \"$1\" | tr ' ' '\\n'", {VIWO_BINARY_DIR "/viwoConfig.cmake"}).out))
		EXPECT_EQ(names.count("libmrpt-" + module + "-dev"), 1u) << module;
	for (const std::string& line : lines(config))
	{
		if (line.rfind("find_dependency(", 0) != 0 || line.find("Threads") != std::string::npos) continue;
		EXPECT_EQ(brings.count(line.substr(16, line.find_first_of(" )", 16) - 16)), 1u) << line << ": which package brings this?";
	}
}

TEST_F(Packages, HoldEachFileOnce)
{
	const auto programs = contents(kPrograms), libraries = contents(kLibraries), headers = contents(kDevelopment);
	for (const std::string& name : allPrograms())
	{
		ASSERT_EQ(programs.count("/usr/bin/" + name), 1u) << name;
		EXPECT_EQ(programs.at("/usr/bin/" + name).substr(0, 10), "-rwxr-xr-x") << name;
		EXPECT_EQ(programs.count("/usr/share/man/man1/" + name + ".1.gz"), 1u) << name;
		EXPECT_NE(programs.at("/usr/share/bash-completion/completions/" + name).find(" -> viwo"), std::string::npos) << name;
	}
	for (const auto& entry : std::filesystem::directory_iterator(VIWO_SOURCE_DIR "/libs"))
	{
		if (!entry.is_directory()) continue;
		const std::string base = "libviwo_" + entry.path().filename().string() + ".so";
		const auto has = [&](const auto& files, const std::string& name) {
			return std::any_of(files.begin(), files.end(),
			                   [&](const auto& file) { return std::filesystem::path(file.first).filename() == name; });
		};
		EXPECT_TRUE(has(libraries, base + ".0")) << base;
		EXPECT_FALSE(has(libraries, base)) << base << " is for building only";
		EXPECT_TRUE(has(headers, base)) << base;
	}
	for (const char* name :
	     {"/usr/share/viwo/config_files/viwo-odometry/default.ini", "/usr/share/doc/viwo/README.md", "/usr/share/doc/viwo/doc/tuning.md"})
		EXPECT_EQ(programs.count(name), 1u) << name;
	EXPECT_EQ(headers.count("/usr/include/viwo/odometry/Odometry.h"), 1u);
	for (const auto* files : {&programs, &libraries, &headers})
		for (const auto& [name, line] : *files)
		{
			EXPECT_NE(line.find(" 0/0 "), std::string::npos) << name << " is not root's: " << line;
			if (name.back() == '/') continue;
			EXPECT_EQ(programs.count(name) + libraries.count(name) + headers.count(name), 1u) << name;
			EXPECT_EQ(name.find("/usr/"), 0u) << name;
		}
	for (const std::string& package : {kPrograms, kLibraries, kDevelopment})
		for (const char* name : {"copyright", "changelog.gz", "changelog.Debian.gz"})
			EXPECT_EQ(contents(package).count("/usr/share/doc/" + package + "/" + name), 1u) << package << " " << name;
}

/** Unpacks all three, and looks at what the loader would do. */
TEST_F(Packages, ProgramsRunWithoutAPathInThem)
{
	const TempFolder root;
	for (const std::string& file : packageFiles()) ASSERT_EQ(bash("dpkg-deb -x \"$1\" \"$2\"", {file, root.path()}).status, 0);
	const ProgramResult elf = bash(
	    "cd \"$1/usr\" && for f in bin/* $(find lib -name '*.so.*' -type f); do readelf -d \"$f\" | grep -E 'RPATH|RUNPATH' && echo "
	    "\"$f\"; readelf -S \"$f\" | grep -q symtab && echo \"$f is not stripped\"; done; true",
	    {root.path()});
	EXPECT_EQ(elf.out, "");
	const std::string libraries = bash("dirname $(find \"$1/usr/lib\" -name 'libviwo_core.so.0')", {root.path()}).out;
	const std::string environment = "LD_LIBRARY_PATH=" + libraries.substr(0, libraries.find('\n'));
	for (const std::string& name : allPrograms())
	{
		const ProgramResult result = runProgram(root.file("usr/bin/" + name), {"--version"}, environment);
		EXPECT_EQ(result.status, 0) << result.err;
		EXPECT_EQ(result.out.find(name + " (viwo) "), 0u) << result.out;
	}
}

/** As somebody reads them who has installed viwo. */
TEST_F(Packages, LinksOfTheInstalledPagesLeadSomewhere)
{
	const TempFolder root;
	for (const std::string& file : packageFiles()) ASSERT_EQ(bash("dpkg-deb -x \"$1\" \"$2\"", {file, root.path()}).status, 0);
	const std::regex link("\\]\\(([^()#\\s]+)(#[^()\\s]*)?\\)");
	size_t pages = 0, links = 0;
	for (const auto& page : std::filesystem::recursive_directory_iterator(root.file("usr/share/doc/viwo")))
	{
		if (page.path().extension() != ".md") continue;
		++pages;
		const std::string text = readFile(page.path().string());
		for (std::sregex_iterator it(text.begin(), text.end(), link), end; it != end; ++it)
		{
			const std::string target = (*it)[1];
			if (target.find("://") != std::string::npos || target == "const") continue;  // "[](const viwo::FrameEstimate& ..."
			++links;
			EXPECT_TRUE(std::filesystem::exists(page.path().parent_path() / target)) << page.path() << " -> " << target;
		}
	}
	EXPECT_GT(pages, 10u);
	EXPECT_GT(links, 50u);
}

TEST_F(Packages, LintianFindsNoError)
{
	if (bash("command -v lintian").status != 0) GTEST_SKIP() << "lintian is not here (package lintian)";
	const ProgramResult result = bash("lintian --allow-root --fail-on error,warning --tag-display-limit 0 \"$1\"/*.deb 2>&1", {kFolder});
	std::cout << result.out;
	EXPECT_EQ(result.status, 0);
}
}  // namespace
}  // namespace viwo::testing
