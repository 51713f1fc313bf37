#pragma once

#include <gtest/gtest.h>
#include <viwo/core/Trajectory.h>
#include <viwo/evaluation/Json.h>
#include <viwo/evaluation/TrajectoryErrors.h>

#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "RunProgram.h"
#include "TempFolder.h"
#include "TestLogs.h"

namespace viwo::testing
{
inline std::string program(const std::string& name)
{
	return VIWO_BINARY_DIR "/bin/" + name;
}

/** viwo-odometry on a log, its outputs below a temporary folder. */
class OdometryProgram : public ::testing::Test
{
   protected:
	/** Runs into folder_/<name>. */
	ProgramResult runOdometry(const std::string& rawlog, const std::string& name, const std::vector<std::string>& options = {})
	{
		std::vector<std::string> arguments{"-i", rawlog, "-o", folder_.file(name)};
		arguments.insert(arguments.end(), options.begin(), options.end());
		return runProgram(program("viwo-odometry"), arguments);
	}

	/** The same, expecting success. */
	void odometry(const std::string& rawlog, const std::string& name, const std::vector<std::string>& options = {})
	{
		const ProgramResult result = runOdometry(rawlog, name, options);
		ASSERT_EQ(result.status, 0) << result.err;
	}

	std::string output(const std::string& name, const std::string& file) const { return folder_.file(name) + "/" + file; }
	Trajectory trajectory(const std::string& name) const { return Trajectory::loadTum(output(name, "trajectory.tum")); }
	Json summary(const std::string& name) const { return loadJson(output(name, "summary.json")); }

	TrajectoryErrors errors(const std::string& name, const std::string& ground_truth) const
	{
		return evaluate(Trajectory::loadTum(ground_truth), trajectory(name), EvaluationOptions());
	}

	/** All outputs whose content is to be repeatable. */
	static const std::vector<std::string>& repeatableFiles()
	{
		static const std::vector<std::string> files{"trajectory.tum", "trajectory_imu_rate.tum", "trajectory_covariance.csv",
		                                            "landmarks.ply", "landmark_observations.csv", "keyframes.csv"};
		return files;
	}

	void expectSameFiles(const std::string& a, const std::string& b) const
	{
		for (const std::string& file : repeatableFiles())
		{
			EXPECT_FALSE(readFile(output(a, file)).empty()) << file;
			EXPECT_TRUE(readFile(output(a, file)) == readFile(output(b, file))) << file << " of " << a << " and " << b;
		}
	}

	const TempFolder folder_;
};
}  // namespace viwo::testing
