#pragma once

#include "LoopCloser.h"
#include "OdometryCalibration.h"

namespace viwo::gt
{
/** Scans left out of the map, against it. */
struct HoldoutErrors
{
	size_t scans = 0;
	double median_m = 0, p95_m = 0, median_deg = 0, p95_deg = 0;
};

/** All that is known at the end. */
struct Solution
{
	KeyScans keys;
	std::vector<GraphEdge> edges;
	GyroTurns gyro;
	std::vector<FinalPose> poses;
	LoopCounts loops;
	size_t window_searches = 0;
	size_t contradicted = 0;  //!< steps of odometry that scans have refuted
	std::optional<HoldoutErrors> holdout;
	OdometryCalibration calibration;
};

/** The whole computation. `progress` gets the fraction done and a word; it returns false to stop, which is an Error. */
Solution solve(const Session& session, const GroundTruthRunOptions& options,
               const std::function<bool(double, const std::string&)>& progress);
}  // namespace viwo::gt
