#include "OdometryProgram.h"
#include "SurfaceFigures.h"

#include <octomap/OcTree.h>

#include <memory>

namespace viwo::testing
{
namespace
{
/** The map that a user gets without any ground truth: trajectory and landmarks of viwo-odometry. */
class MapOfTheEstimate : public OdometryProgram
{
   protected:
	SurfaceFigures mapped(const std::string& rawlog, const std::string& ground_truth, const std::string& world)
	{
		odometry(rawlog, "out", {"--to", "15", "--quiet"});
		// In the world's axes, as the simulator has them: seen from the truth at the first pose.
		const Trajectory truth = Trajectory::loadTum(ground_truth), estimate = trajectory("out");
		Trajectory placed;
		const StampedPose& first = estimate.poses().front();
		const Pose3 T_world_W = *truth.at(first.t_ns, 0.1) * first.T.inverse();
		for (const StampedPose& pose : estimate.poses()) placed.push_back({pose.t_ns, T_world_W * pose.T});
		placed.saveTum(folder_.file("placed.tum"));
		const ProgramResult map =
		    runProgram(program("viwo-octomap"), {"-i", rawlog, "-t", folder_.file("placed.tum"), "-o", folder_.file("map.ot"),
		                                         "--landmarks", folder_.file("out"), "--scan-duration", "0.03", "--quiet"});
		EXPECT_EQ(map.status, 0) << map.err;
		std::unique_ptr<octomap::AbstractOcTree> tree(octomap::AbstractOcTree::read(folder_.file("map.ot")));
		return surfaceFigures(dynamic_cast<const octomap::OcTree&>(*tree),
		                      sim::World::load(VIWO_SOURCE_DIR "/share/viwo/worlds/" + world + ".ini"), {});
	}
};

TEST_F(MapOfTheEstimate, LobbyOfTheSample)
{
	const SurfaceFigures f = mapped(VIWO_SOURCE_DIR "/rawlogs/sample.rawlog", VIWO_SOURCE_DIR "/rawlogs/sample_ground_truth.tum", "lobby");
	print("lobby, trajectory and landmarks of viwo-odometry", f);
	EXPECT_GT(f.near_surface, 0.8);
	EXPECT_LT(f.wrongly_occupied, 0.01);
}

TEST_F(MapOfTheEstimate, Corridor)
{
	const TestLog log = testLog(corridorTestDrive());
	const SurfaceFigures f = mapped(log.rawlog, log.ground_truth, "corridor");
	print("corridor, trajectory and landmarks of viwo-odometry", f);
	EXPECT_GT(f.near_surface, 0.8);
	EXPECT_LT(f.wrongly_occupied, 0.01);
}
}  // namespace
}  // namespace viwo::testing
