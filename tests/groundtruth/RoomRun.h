#pragma once

#include "RoomLog.h"
#include "RunProgram.h"

#include <viwo/core/Trajectory.h>
#include <viwo/groundtruth/GroundTruthRun.h>

#include <gtest/gtest.h>

#include <algorithm>

namespace viwo::testing
{
inline gt::GroundTruthRunOptions optionsFor(const TempFolder& folder, const std::string& out = "out")
{
	gt::GroundTruthRunOptions options;
	options.rawlogs = {folder.file("x.rawlog")};
	options.output_dir = folder.file(out);
	return options;
}

inline gt::Pose2 pose2(const Pose3& T)
{
	return {T.p.x(), T.p.y(), yawOf(T.R)};
}

struct RoomErrors
{
	double rms_m = 0, max_m = 0;
	size_t poses = 0;
};

/** Against the truth, both seen from the first pose. */
inline RoomErrors errorsOf(const TempFolder& folder, const RoomLog& log, const std::string& out = "out")
{
	const Trajectory trajectory = Trajectory::loadTum(folder.file(out + "/trajectory.tum"));
	RoomErrors errors;
	errors.poses = trajectory.size();
	const StampedPose& first = trajectory.poses()[0];
	for (const StampedPose& pose : trajectory.poses())
	{
		const gt::Pose2 estimate = between(pose2(first.T), pose2(pose.T));
		const double e = (estimate.p - between(log.truth.at(first.t_ns), log.truth.at(pose.t_ns)).p).norm();
		errors.rms_m += e * e / static_cast<double>(trajectory.size());
		errors.max_m = std::max(errors.max_m, e);
	}
	errors.rms_m = std::sqrt(errors.rms_m);
	return errors;
}
}  // namespace viwo::testing
