#pragma once

#include <viwo/core/Trajectory.h>
#include <viwo/rawlog/RawlogReader.h>
#include <viwo/sim/Simulation.h>

#include <string>
#include <vector>

#include "TempFolder.h"

namespace viwo::testing
{
/** A simulated log without images: a straight line, a turn on the spot, an arc; 17 s. */
struct DrivenLog
{
	TempFolder folder;
	std::string rawlog = folder.file("drive.rawlog");
	Trajectory truth;

	explicit DrivenLog(const std::string& segments = "straight 0.9 m, rotate 30 deg, arc 0.8 m 40 deg")
	{
		sim::Route route;
		route.segments = segments;
		sim::Rig rig;
		rig.lidar.enabled = false;
		sim::Simulation simulation(sim::World({sim::Material()}, {}), route, rig, 7);
		sim::SimulationRunOptions options;
		options.images = false;
		truth = Trajectory::loadTum(simulation.run(rawlog, options).ground_truth);
	}

	std::vector<mrpt::obs::CObservation::Ptr> observations() const
	{
		std::vector<mrpt::obs::CObservation::Ptr> all;
		RawlogReader reader(rawlog);
		while (const auto observation = reader.next()) all.push_back(observation);
		return all;
	}
};

/** Largest distance between two trajectories where both are, each relative to its first common pose. */
inline double largestDistance_m(const Trajectory& estimate, const Trajectory& truth)
{
	std::optional<Pose3> T_truth_est;
	double largest_m = 0;
	for (const StampedPose& pose : estimate.poses())
	{
		const auto T = truth.at(pose.t_ns, 0.1);
		if (!T) continue;
		if (!T_truth_est) T_truth_est = *T * pose.T.inverse();
		largest_m = std::max(largest_m, ((*T_truth_est * pose.T).p - T->p).norm());
	}
	return T_truth_est ? largest_m : std::numeric_limits<double>::infinity();
}
}  // namespace viwo::testing
