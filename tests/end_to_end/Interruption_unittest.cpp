#include <viwo/core/Time.h>

#include <chrono>
#include <csignal>

#include "EditedLog.h"
#include "OdometryProgram.h"

namespace viwo::testing
{
namespace
{
class Interruption : public OdometryProgram
{
   protected:
	ProgramResult interrupt(const std::string& rawlog, int signal, double after_s, const std::string& mode)
	{
		return runAndSignal(program("viwo-odometry"), {"-i", rawlog, "-o", folder_.file("out"), "--mode", mode, "--realtime", "--quiet"},
		                    signal, output("out", "trajectory.tum.part"), after_s);
	}

	void expectValidOutputs(const ProgramResult& result)
	{
		EXPECT_EQ(result.status, 1) << result.err;
		const Json s = summary("out");
		EXPECT_EQ(s.at("interrupted"), true);
		EXPECT_EQ(trajectory("out").size(), s.at("poses").get<size_t>());
		for (const char* name : {"trajectory_imu_rate.tum", "trajectory_covariance.csv", "landmarks.ply", "keyframes.csv", "config.ini"})
			EXPECT_TRUE(std::filesystem::exists(output("out", name))) << name;
		for (const auto& entry : std::filesystem::directory_iterator(folder_.file("out")))
			EXPECT_NE(entry.path().extension(), ".part") << entry.path();
	}

	const TestLog log_ = testLog(lobbyTestDrive());
};

TEST_F(Interruption, LeavesWhatWasComputed)
{
	for (const int signal : {SIGINT, SIGTERM, SIGHUP})
	{
		expectValidOutputs(interrupt(log_.rawlog, signal, 3, "wio"));
		const double duration_s = summary("out").at("duration_s").get<double>();
		std::cout << "[measured] signal " << signal << " after " << duration_s << " s of the log\n";
		EXPECT_GT(duration_s, 1);
		EXPECT_LT(duration_s, 15) << "the log has 20 s";
		std::filesystem::remove_all(folder_.file("out"));
	}
}

/** A replay by the clock of the log that waits for the end of a gap of an hour. */
TEST_F(Interruption, AlsoWhileNothingHappens)
{
	const auto pause = [](mrpt::obs::CObservation& o, double t_s, RawlogWriter& w)
	{
		if (t_s > 2) shiftStamp(o, 3600);
		w.write(o);
	};
	const std::string paused = editedLog(log_.rawlog, folder_, 6, pause);
	const auto begin = std::chrono::steady_clock::now();
	expectValidOutputs(interrupt(paused, SIGINT, 4, "wio"));
	EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(), 60);
	EXPECT_LT(summary("out").at("duration_s").get<double>(), 3);
}
}  // namespace
}  // namespace viwo::testing
