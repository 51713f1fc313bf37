#pragma once

#include "TempFolder.h"

#include <viwo/rawlog/RawlogWriter.h>
#include <viwo/sim/LidarModel.h>
#include <viwo/sim/Rig.h>

#include <string>
#include <vector>

namespace viwo::testing
{
/** A simulated drive with planar scans in a shipped world: noise and mixed pixels of the shipped rig, at a third of its rate. */
struct SimulatedScans
{
	sim::World world;
	std::string rawlog, ground_truth;
	std::vector<Eigen::Vector3d> true_hits;  //!< where the beams that came back met their surfaces, without any error; W, m

	SimulatedScans(const TempFolder& folder, const std::string& world_name, const std::string& route_name, double systematic_mm)
	    : world(sim::World::load(shared("worlds/" + world_name))), rawlog(folder.file("x.rawlog")), ground_truth(folder.file("x.tum"))
	{
		sim::Rig rig;
		sim::Route route;
		sim::loadRun(shared("rigs/turtlebot2"), shared("routes/" + route_name), {"lidar.rate_hz=8"}, rig, route);
		rig.lidar.systematic_error_mm = systematic_mm;
		constexpr uint64_t kSeed = 1;
		const sim::Motion motion(route, rig.floor, rig.vibration, kSeed);
		motion.groundTruth().saveTum(ground_truth);
		sim::LidarModel lidar(motion, world, rig.lidar, kSeed);
		RawlogWriter writer(rawlog);
		for (int64_t i = 0; i < lidar.count(); ++i)
		{
			const sim::LidarScan scan = lidar.scan(i);
			writer.write(makeScan(scan.t_ns, scan.ranges_m, rig.lidar.aperture_deg * M_PI / 180, rig.lidar.max_range_m, lidar.T_OL()));
			for (size_t beam = 0; beam < scan.ranges_m.size(); ++beam)
				if (scan.ranges_m[beam] > 0) addTrueHit(motion, lidar, i, static_cast<int>(beam));
		}
		writer.close();
	}

   private:
	static std::string shared(const std::string& name) { return std::string(VIWO_SOURCE_DIR) + "/share/viwo/" + name + ".ini"; }

	void addTrueHit(const sim::Motion& motion, const sim::LidarModel& lidar, int64_t scan, int beam)
	{
		const sim::LidarOptions& o = lidar.options();
		const double t_s = lidar.time_s(scan) + 1e-3 * o.sweep_ms * beam / (o.beams - 1), angle = lidar.beamAngle_rad(beam);
		const Pose3 T_WL = motion.at(t_s).T_WO * lidar.T_OL();
		const Eigen::Vector3d direction = (T_WL.R * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0)).normalized();
		if (const auto hit = world.castRay(T_WL.p, direction, o.max_range_m)) true_hits.push_back(T_WL.p + hit->distance_m * direction);
	}
};
}  // namespace viwo::testing
