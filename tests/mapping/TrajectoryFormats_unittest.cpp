#include "ExpectError.h"
#include "TempFolder.h"

#include <mrpt/poses/CPose3DInterpolator.h>
#include <viwo/core/MrptPose.h>
#include <viwo/mapping/TrajectoryFormats.h>
#include <viwo/rawlog/MrptTime.h>

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <random>
#include <sstream>

namespace viwo
{
namespace
{
using namespace testing;

constexpr int64_t kStart_ns = 1'403'715'273'262'142'976;
const TrajectoryFormat kFormats[] = {TrajectoryFormat::tum, TrajectoryFormat::kitti, TrajectoryFormat::euroc, TrajectoryFormat::mrpt,
                                     TrajectoryFormat::g2o};

Trajectory randomTrajectory(int count = 30)
{
	std::mt19937_64 random(4);
	std::normal_distribution<double> normal;
	Trajectory trajectory;
	for (int i = 0; i < count; ++i)
		trajectory.push_back({kStart_ns + i * 49'999'872,
		                      Pose3(Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random)).normalized(),
		                            {normal(random), 10 * normal(random), 1e3 + normal(random)})});
	return trajectory;
}

/** Two poses whose text is known by hand: at rest, and turned by 90 deg about z. */
Trajectory twoPoses()
{
	Trajectory trajectory;
	trajectory.push_back({kStart_ns, Pose3(Eigen::Quaterniond::Identity(), {1, 2, 3})});
	const double s = std::sqrt(0.5);
	trajectory.push_back({kStart_ns + 1'000'000'000, Pose3(Eigen::Quaterniond(s, 0, 0, s), {1, 3, 3})});
	return trajectory;
}

std::string saved(TrajectoryFormat format, const std::string& name)
{
	const TempFolder folder;
	saveTrajectory(folder.file(name), format, twoPoses());
	std::string all = readFile(folder.file(name));
	const std::string stamps = stampsPathOf(folder.file(name), format);
	if (!stamps.empty()) all += "--\n" + readFile(stamps);
	return all;
}
}  // namespace

// The formats byte by byte, as they are defined: what evo and others read.

TEST(TrajectoryFormats, TumIsTimePositionQuaternion)
{
	EXPECT_EQ(saved(TrajectoryFormat::tum, "t.tum"),
	          "1403715273.262142976 1.000000000 2.000000000 3.000000000 0.000000000000 0.000000000000 0.000000000000 1.000000000000\n"
	          "1403715274.262142976 1.000000000 3.000000000 3.000000000 0.000000000000 0.000000000000 0.707106781187 0.707106781187\n");
}

TEST(TrajectoryFormats, KittiIsTheUpperPartOfTheMatrix)
{
	const std::string text = saved(TrajectoryFormat::kitti, "t.kitti");
	EXPECT_EQ(text.substr(0, text.find('\n')),
	          "1.000000000000e+00 0.000000000000e+00 0.000000000000e+00 1.000000000000e+00 0.000000000000e+00 1.000000000000e+00 "
	          "0.000000000000e+00 "
	          "2.000000000000e+00 0.000000000000e+00 0.000000000000e+00 1.000000000000e+00 3.000000000000e+00");
	EXPECT_NE(text.find("--\n1403715273.262142976\n1403715274.262142976\n"), std::string::npos);
	// Second pose: x of the body along y of the world.
	std::istringstream second(text.substr(text.find('\n') + 1));
	double m[12];
	for (double& value : m) second >> value;
	EXPECT_NEAR(m[1], -1, 1e-12);
	EXPECT_NEAR(m[4], 1, 1e-12);
	EXPECT_EQ(m[7], 3);
}

TEST(TrajectoryFormats, EurocHasNanosecondsAndTheQuaternionsRealPartFirst)
{
	EXPECT_EQ(saved(TrajectoryFormat::euroc, "t.csv"),
	          "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z []\n"
	          "1403715273262142976,1.000000000,2.000000000,3.000000000,1.000000000000,0.000000000000,0.000000000000,0.000000000000\n"
	          "1403715274262142976,1.000000000,3.000000000,3.000000000,0.707106781187,0.000000000000,0.000000000000,0.707106781187\n");
}

TEST(TrajectoryFormats, G2oHasVerticesEdgesAndStamps)
{
	EXPECT_EQ(saved(TrajectoryFormat::g2o, "t.g2o"),
	          "VERTEX_SE3:QUAT 0 1.000000000 2.000000000 3.000000000 0.000000000000 0.000000000000 0.000000000000 1.000000000000\n"
	          "VERTEX_SE3:QUAT 1 1.000000000 3.000000000 3.000000000 0.000000000000 0.000000000000 0.707106781187 0.707106781187\n"
	          "EDGE_SE3:QUAT 0 1 0.000000000 1.000000000 0.000000000 0.000000000000 0.000000000000 0.707106781187 0.707106781187"
	          " 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1\n--\nid,t_ns\n0,1403715273262142976\n1,1403715274262142976\n");
}

TEST(TrajectoryFormats, MrptsOwnClassReadsItsText)
{
	const TempFolder folder;
	const Trajectory trajectory = randomTrajectory();
	saveTrajectory(folder.file("t.mrpt"), TrajectoryFormat::mrpt, trajectory);
	mrpt::poses::CPose3DInterpolator path;
	ASSERT_TRUE(path.loadFromTextFile(folder.file("t.mrpt")));
	ASSERT_EQ(path.size(), trajectory.size());
	size_t i = 0;
	for (const auto& [stamp, pose] : path)
	{
		const StampedPose& expected = trajectory.poses()[i++];
		EXPECT_NEAR(static_cast<double>(nanosecondsOf(stamp) - expected.t_ns), 0, 500) << "a double holds that much of Unix time";
		const Pose3 T = fromMrpt(mrpt::poses::CPose3D(pose));
		EXPECT_LT((T.p - expected.T.p).norm(), 1e-8);
		EXPECT_LT(T.R.angularDistance(expected.T.R), 1e-7);
	}
	// And the other way round.
	ASSERT_TRUE(path.saveToTextFile(folder.file("theirs.mrpt")));
	EXPECT_EQ(loadTrajectory(folder.file("theirs.mrpt"), TrajectoryFormat::mrpt).size(), trajectory.size());
}

TEST(TrajectoryFormats, EveryFormatComesBack)
{
	const TempFolder folder;
	const Trajectory trajectory = randomTrajectory();
	double worst_m = 0, worst_rad = 0;
	for (const TrajectoryFormat format : kFormats)
	{
		const std::string path = folder.file("t" + std::to_string(static_cast<int>(format)));
		saveTrajectory(path, format, trajectory);
		const Trajectory read = loadTrajectory(path, format);
		ASSERT_EQ(read.size(), trajectory.size());
		for (size_t i = 0; i < read.size(); ++i)
		{
			EXPECT_EQ(read.poses()[i].t_ns, trajectory.poses()[i].t_ns);
			worst_m = std::max(worst_m, (read.poses()[i].T.p - trajectory.poses()[i].T.p).norm());
			worst_rad = std::max(worst_rad, read.poses()[i].T.R.angularDistance(trajectory.poses()[i].T.R));
		}
	}
	std::cout << "[measured] off by " << worst_m << " m, " << worst_rad << " rad\n";
	EXPECT_LT(worst_m, 2e-9);
	EXPECT_LT(worst_rad, 1e-7);
}

TEST(TrajectoryFormats, PlanarGraphs)
{
	const TempFolder folder;
	writeFile(folder.file("g.g2o"), "VERTEX_SE2 7 1 2 1.5\nVERTEX_SE2 3 0 0 0\nEDGE_SE2 3 7 1 2 1.5 1 0 0 1 0 1\n");
	writeFile(folder.file("g_stamps.csv"), "id,t_ns\n3,100\n7,200\n");
	const Trajectory read = loadTrajectory(folder.file("g.g2o"), TrajectoryFormat::g2o);
	ASSERT_EQ(read.size(), 2u);
	EXPECT_EQ(read.poses()[1].t_ns, 200);
	EXPECT_NEAR(read.poses()[1].T.R.angularDistance(Eigen::Quaterniond::Identity()), 1.5, 1e-12);
}

TEST(TrajectoryFormats, ResamplingAndFrames)
{
	const Trajectory trajectory = twoPoses();
	const Trajectory at_4_hz = resampled(trajectory, 4, 2);
	ASSERT_EQ(at_4_hz.size(), 5u);
	EXPECT_NEAR(at_4_hz.poses()[1].T.p.y(), 2.25, 1e-12);
	EXPECT_TRUE(resampled(trajectory, 4, 0.5).size() < 5) << "not across a gap";
	EXPECT_EQ(resampledLike(trajectory, at_4_hz, 2).size(), 5u);
	Trajectory with_1970;
	with_1970.push_back({0, Pose3()});
	for (const StampedPose& pose : trajectory.poses()) with_1970.push_back(pose);
	const Trajectory at_1000_hz = resampled(with_1970, 1000, 2);
	EXPECT_EQ(at_1000_hz.size(), 1001u) << "the first pose, and every millisecond from the first after " << kStart_ns << " on";
	EXPECT_NEAR(static_cast<double>(at_1000_hz.poses()[1].t_ns - kStart_ns), 857024, 300) << "the next whole millisecond";
	const Trajectory moved = inOtherFrame(trajectory, Pose3(Eigen::Quaterniond::Identity(), {1, 0, 0}));
	EXPECT_LT((moved.poses()[0].T.p - Eigen::Vector3d(2, 2, 3)).norm(), 1e-12);
	EXPECT_LT((moved.poses()[1].T.p - Eigen::Vector3d(1, 4, 3)).norm(), 1e-12);
}

TEST(TrajectoryFormats, DamagedFilesAreOneLine)
{
	const TempFolder folder;
	const auto load = [&](TrajectoryFormat format, const std::string& content)
	{
		writeFile(folder.file("t"), content);
		loadTrajectory(folder.file("t"), format);
	};
	writeFile(folder.file("t_times.txt"), "1\n2\n");
	writeFile(folder.file("t_stamps.csv"), "id,t_ns\n0,1\n1,1\n");
	expectError([&] { load(TrajectoryFormat::kitti, "1 0 0 0 0 1 0 0 0 0 1\n"); }, {"t:1", "11 columns"});
	expectError([&] { load(TrajectoryFormat::kitti, "1 0 0 0 0 1 0 0 0 0 1 0\n"); }, {"t_times.txt:2", "fewer poses"});
	expectError([&] { load(TrajectoryFormat::kitti, "1 0 0 0 0 1 0 0 0 0 -1 0\n"); }, {"t:1", "no rotation"});
	expectError([&] { load(TrajectoryFormat::euroc, "5,0,0,0,1,0,0\n"); }, {"t:1", "7 columns"});
	expectError([&] { load(TrajectoryFormat::euroc, "5,0,0,0,1,0,0,1\n"); }, {"t:1", "unit length"});
	expectError([&] { load(TrajectoryFormat::euroc, "5,0,0,nan,1,0,0,0\n"); }, {"t:1", "nan"});
	expectError([&] { load(TrajectoryFormat::euroc, "5,0,0,0,1,0,0,0\n5,0,0,0,1,0,0,0\n"); }, {"t:2", "sort"});
	expectError([&] { load(TrajectoryFormat::euroc, "5.5,0,0,0,1,0,0,0\n"); }, {"t:1", "whole number"});
	expectError([&] { load(TrajectoryFormat::mrpt, "x 0 0 0 0 0 0\n"); }, {"t:1", "seconds"});
	expectError([&] { load(TrajectoryFormat::g2o, "VERTEX_SE3:QUAT 2 0 0 0 0 0 0 1\n"); }, {"t:1", "no stamp"});
	expectError([&] { load(TrajectoryFormat::g2o, "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 0 0 0\n"); }, {"t:2", "two vertices"});
	expectError([&] { load(TrajectoryFormat::g2o, "EDGE_SE2 0 1 0 0 0 1 0 0 1 0 1\n"); }, {"no pose"});
	expectError([&] { load(TrajectoryFormat::mrpt, ""); }, {"empty"});
	expectError([&] { loadTrajectory(folder.file("absent"), TrajectoryFormat::euroc); }, {"absent"});
}
}  // namespace viwo
