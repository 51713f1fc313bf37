#include "OdometryProgram.h"

#include <algorithm>
#include <sstream>

namespace viwo::testing
{
namespace
{
/** A fenced block of a page: "```sh", or "```ini my_robot.ini" for a file. */
struct Block
{
	std::string language, file, text;
};

std::vector<Block> blocksOf(const std::string& page)
{
	std::vector<Block> blocks;
	bool inside = false;
	std::istringstream lines(readFile(page));
	for (std::string line; std::getline(lines, line);)
	{
		if (line.rfind("```", 0) != 0)
		{
			if (inside) blocks.back().text += line + "\n";
			continue;
		}
		inside = !inside;
		if (!inside) continue;
		std::istringstream words(line.substr(3));
		blocks.emplace_back();
		words >> blocks.back().language >> blocks.back().file;
	}
	return blocks;
}

class Tutorial : public OdometryProgram
{
   protected:
	/** As a user does: in one folder, with the programs in PATH. */
	ProgramResult shell(const std::string& command) const
	{
		return runProgram("/bin/sh",
		                  {"-c", "cd " + quoted(folder_.path()) + " && PATH=" + quoted(VIWO_BINARY_DIR "/bin") + ":$PATH " + command});
	}

	double ate_m(const std::string& estimate) const
	{
		return evaluate(Trajectory::loadTum(VIWO_SOURCE_DIR "/rawlogs/sample_ground_truth.tum"),
		                Trajectory::loadTum(folder_.file(estimate)), EvaluationOptions())
		    .ate_xyz_m;
	}
};

// The page is the test: its files are written and its commands run, in their order.
TEST_F(Tutorial, EachCommandOfThePageRuns)
{
	const std::string to_bag = program("viwo_rawlog_to_bag");
	if (!std::filesystem::exists(to_bag)) GTEST_SKIP() << "built without ROS bags";
	ASSERT_EQ(runProgram(to_bag, {VIWO_SOURCE_DIR "/rawlogs/sample.rawlog", "-o", folder_.file("run.bag")}).status, 0);
	int commands = 0;
	for (const Block& block : blocksOf(VIWO_SOURCE_DIR "/doc/tutorial.md"))
	{
		if (!block.file.empty()) writeFile(folder_.file(block.file), block.text);
		if (block.language != "sh") continue;
		const std::string command = block.text.substr(0, block.text.size() - 1);
		ASSERT_EQ(std::count(block.text.begin(), block.text.end(), '\n'), 1) << "a command a block: " << block.text;
		const ProgramResult result = shell(command);
		ASSERT_EQ(result.status, 0) << command << "\n" << result.err;
		EXPECT_EQ(result.err.find("error"), std::string::npos) << command << "\n" << result.err;
		++commands;
	}
	EXPECT_EQ(commands, 10);

	for (const char* file : {"run.rawlog", "rig.ini", "truth/map.png", "report.html", "map.bt", "map.yaml", "map.png", "camera.csv"})
		EXPECT_GT(std::filesystem::file_size(folder_.file(file)), 40u) << file;
	std::cout << "[measured] tutorial: ATE wheels " << ate_m("wheel/trajectory.tum") << " m, all " << ate_m("out/trajectory.tum")
	          << " m, ground truth " << ate_m("truth/trajectory.tum") << " m\n";
	EXPECT_LT(ate_m("out/trajectory.tum"), 0.015);
	EXPECT_LT(ate_m("truth/trajectory.tum"), 0.015);
	EXPECT_LT(ate_m("wheel/trajectory.tum"), 0.06);
}
}  // namespace
}  // namespace viwo::testing
