#include <chrono>
#include <regex>

#include "OdometryProgram.h"

namespace viwo::testing
{
namespace
{
class Replay : public OdometryProgram
{
   protected:
	std::string command(const std::string& rawlog, const std::string& options) const
	{
		return quoted(program("viwo-odometry")) + " -i " + quoted(rawlog) + " -o " + quoted(folder_.file("out")) + " " + options;
	}

	/** What the program shows on a terminal of so many columns: script(1) is one. */
	ProgramResult onTerminal(int columns, const std::string& options) const
	{
		const std::string inside = "stty cols " + std::to_string(columns) + "; " + command(log_.rawlog, options);
		return runProgram(kScript, {"-qec", inside, "/dev/null"});
	}

	static constexpr const char* kScript = "/usr/bin/script";
	const TestLog log_ = testLog(lobbyTestDrive());
};

TEST_F(Replay, OneStatusLineOnATerminal)
{
	if (!std::filesystem::exists(kScript)) GTEST_SKIP() << kScript << " is not there";
	const ProgramResult result = onTerminal(250, "--mode wio --to 4 --realtime --speed 4");
	ASSERT_EQ(result.status, 0) << result.out;
	const std::regex line(
	    R"(([0-9.]+) s at [0-9.]+ x, [a-z_]+, [0-9]+ features, x -?[0-9.]+ y -?[0-9.]+ m, sigma [0-9.]+ m, [0-9.]+ m/s, lag [0-9.]+ s)");
	int updates = 0;
	double last_s = 0;
	for (std::sregex_iterator at(result.out.begin(), result.out.end(), line), end; at != end; ++at, ++updates)
	{
		EXPECT_GE(std::stod((*at)[1]), last_s);
		last_s = std::stod((*at)[1]);
	}
	std::cout << "[measured] " << updates << " updates of the status line in a second\n";
	EXPECT_GE(updates, 3);
	EXPECT_GT(last_s, 2);
	EXPECT_NE(result.out.find("replay by the log's clock"), std::string::npos) << result.out;
}

TEST_F(Replay, StaysOnOneLineOfANarrowTerminal)
{
	if (!std::filesystem::exists(kScript)) GTEST_SKIP() << kScript << " is not there";
	const std::string out = onTerminal(60, "--mode wheel --to 2 --realtime --speed 4").out;
	const std::regex update("\r(\\[[^\r\n\033]*)\033");
	int updates = 0;
	for (std::sregex_iterator at(out.begin(), out.end(), update), end; at != end; ++at, ++updates) EXPECT_LT((*at)[1].length(), 60);
	EXPECT_GE(updates, 1) << out;
}

// Faster than any machine: it says that it is behind, and gives every pose of a run without a clock.
TEST_F(Replay, BehindRealTimeNothingIsDropped)
{
	odometry(log_.rawlog, "free", {"--to", "8", "--quiet"});
	const ProgramResult result = runOdometry(log_.rawlog, "behind", {"--to", "8", "--realtime", "--speed", "1000"});
	ASSERT_EQ(result.status, 0) << result.err;
	expectSameFiles("free", "behind");
	EXPECT_NE(result.err.find("behind real time; nothing is dropped"), std::string::npos) << result.err;
	const double lag_s = summary("behind").at("largest_lag_s").get<double>();
	std::cout << "[measured] lag " << lag_s << " s\n";
	EXPECT_GT(lag_s, 0.5);
	EXPECT_TRUE(summary("free").at("largest_lag_s").is_null());
	EXPECT_EQ(summary("behind").at("poses"), summary("free").at("poses"));
}

// A recorder that has stopped to write, and does not end: what came until then is there after one signal.
TEST_F(Replay, NamedPipeThatStallsCanBeInterrupted)
{
	const std::string fifo = folder_.file("robot.fifo"), trajectory_part = output("out", "trajectory.tum.part");
	const auto bytes = std::filesystem::file_size(log_.rawlog) * 7 / 10;
	std::filesystem::create_directory_symlink(std::filesystem::path(log_.rawlog).parent_path() / "log_Images",
	                                          folder_.file("robot_Images"));
	for (const char* signal : {"INT", "TERM"})
	{
		const std::string script = "mkfifo " + quoted(fifo) + "; { head -c " + std::to_string(bytes) + " " + quoted(log_.rawlog) +
		                           "; exec sleep 100; } > " + quoted(fifo) + " & w=$!; " +
		                           command(fifo, "--mode wio --realtime --speed 20 --quiet") + " & p=$!; for i in $(seq 200); do [ -e " +
		                           quoted(trajectory_part) + " ] && break; sleep 0.1; done; sleep 2; kill -" + signal +
		                           " $p; wait $p; s=$?; kill $w; exit $s";
		const auto begin = std::chrono::steady_clock::now();
		const ProgramResult result = runProgram("/bin/sh", {"-c", script});
		EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(), 60);
		EXPECT_EQ(result.status, 1) << result.err;
		EXPECT_EQ(summary("out").at("interrupted"), true);
		EXPECT_EQ(trajectory("out").size(), summary("out").at("poses").get<size_t>());
		EXPECT_GT(trajectory("out").size(), 50u);
		EXPECT_FALSE(std::filesystem::exists(trajectory_part));
		std::filesystem::remove_all(folder_.file("out"));
		std::filesystem::remove(fifo);
	}
}
}  // namespace
}  // namespace viwo::testing
