#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace viwo
{
/** What every import takes. */
struct ImportJob
{
	std::string folder;       //!< the recording: a folder, or the log's file
	std::string rawlog_path;  //!< X.rawlog; images go to X_Images/, the truth to X_ground_truth.tum beside it
	/** Called with the fraction done; the import stops with an Error when it returns false. */
	std::function<bool(double)> proceed = [](double) { return true; };
};

/** What an import made. */
struct ImportResult
{
	size_t images = 0, imu_samples = 0, odometry_samples = 0, scans = 0, ground_truth_poses = 0;
	size_t gps_fixes = 0, point_clouds = 0;
	double duration_s = 0;          //!< first to last observation
	std::string ground_truth_path;  //!< empty without a ground truth
	/** Whether nothing says whose poses the truth has, or where O is from there, so that they were taken for those of O. */
	bool ground_truth_assumed = false;
	std::string gps_path;            //!< TUM file of the antenna's positions, east-north-up of the first; empty without GPS
	std::string stamps_path;         //!< rawlog stamps against original ones; empty where they are the same
	std::string mapping;             //!< which topic became what, as an INI that can be edited and given back; ROS bags only
	std::vector<std::string> notes;  //!< what the user should know: what was absent, skipped, or assumed
};
}  // namespace viwo
