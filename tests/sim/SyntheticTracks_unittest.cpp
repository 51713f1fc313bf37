#include <gtest/gtest.h>
#include <viwo/sim/Mounting.h>
#include <viwo/sim/SyntheticTracks.h>

#include <map>
#include <set>

#include "SimFixtures.h"

namespace viwo::sim
{
namespace
{
using Eigen::Vector3d;

Calibration rig()
{
	Calibration c;
	c.T_OC = mountingPose({0.1, 0, 0.3, -90, 0, -90}, "pose");
	c.camera = CameraModel(640, 480, 338, 338, 319.5, 239.5, CameraModel::Distortion::plumb_bob, {-0.28, 0.07, 2e-4, -1e-4, 0});
	return c;
}

const std::vector<Vector3d> kPoints = randomRoomPoints({-4, -5, 0}, {6, 5, 3}, 3000, 1);

TEST(SyntheticTracks, RoomPointsLieOnTheWalls)
{
	for (const Vector3d& p : kPoints)
	{
		const Vector3d a = (p - Vector3d(-4, -5, 0)).cwiseAbs(), b = (p - Vector3d(6, 5, 3)).cwiseAbs();
		EXPECT_LT(std::min(a.minCoeff(), b.minCoeff()), 1e-12);
	}
}

TEST(SyntheticTracks, NoiseFreeBearingsPointAtOnePointEach)
{
	const Motion motion(variedRoute(), FloorOptions(), VibrationOptions(), 2);
	const auto frames = makeFeatureFrames(motion, rig(), kPoints, 0, 2);
	std::map<uint64_t, size_t> point_of_id;
	double worst = 0;
	for (const FeatureFrame& frame : frames)
	{
		const Pose3 T_CW = (motion.at_ns(frame.t_ns).T_WO * rig().T_OC).inverse();
		EXPECT_LE(frame.features.size(), 150u);
		EXPECT_GT(frame.features.size(), 100u);
		for (const FeatureObservation& f : frame.features)
		{
			const auto known = point_of_id.find(f.id);
			double best = 1;
			if (known != point_of_id.end())
				best = ((T_CW * kPoints[known->second]).normalized() - f.bearing_C).norm();
			else
				for (size_t i = 0; i < kPoints.size(); ++i)
				{
					const double error = ((T_CW * kPoints[i]).normalized() - f.bearing_C).norm();
					if (error < best) best = error, point_of_id[f.id] = i;
				}
			worst = std::max(worst, best);
		}
	}
	measured("bearing against the point, all tracks", worst, "rad");
	EXPECT_LT(worst, 1e-9);
}

TEST(SyntheticTracks, NoiseHasItsStrengthAndSeedsDecide)
{
	const Motion motion(routeOf("straight 1 m"));
	TrackOptions options;
	options.pixel_noise_px = 0;
	const auto exact = makeFeatureFrames(motion, rig(), kPoints, options, 3);
	options.pixel_noise_px = 0.5;
	const auto noisy = makeFeatureFrames(motion, rig(), kPoints, options, 3), again = makeFeatureFrames(motion, rig(), kPoints, options, 3);
	double squared = 0;
	int count = 0;
	for (size_t k = 0; k < exact.size(); ++k)
		for (size_t i = 0; i < exact[k].features.size(); ++i, count += 2)
		{
			ASSERT_EQ(exact[k].features[i].id, noisy[k].features[i].id);
			EXPECT_EQ(noisy[k].features[i].pixel, again[k].features[i].pixel);
			squared += (noisy[k].features[i].pixel - exact[k].features[i].pixel).squaredNorm();
		}
	EXPECT_NEAR(std::sqrt(squared / count), 0.5, 0.01);
}

TEST(SyntheticTracks, WallsHideWhatIsBehindThem)
{
	std::vector<Surface> surfaces;
	appendBox(surfaces, {2, 0, 0}, {0.2, 1, 1}, 0, 0);
	const World world({Material()}, surfaces);
	const auto visible = visibleIn(world);
	EXPECT_TRUE(visible({0, 0, 0.5}, {1.9, 0.2, 0.5})) << "on its face";
	EXPECT_FALSE(visible({0, 0, 0.5}, {2.1, 0.2, 0.5}));
	EXPECT_FALSE(visible({0, 0, 0.5}, {5, 0, 0.5}));
	EXPECT_TRUE(visible({0, 0, 0.5}, {5, 3, 0.5}));
}

TEST(SyntheticTracks, IdsAreSortedAndNeverReturn)
{
	const Motion motion(routeOf("rotate 360 deg"));
	std::set<uint64_t> live, ended;
	for (const FeatureFrame& frame : makeFeatureFrames(motion, rig(), kPoints, 0.3, 4))
	{
		std::set<uint64_t> now;
		for (size_t i = 0; i < frame.features.size(); ++i)
		{
			now.insert(frame.features[i].id);
			EXPECT_EQ(ended.count(frame.features[i].id), 0u);
			if (i > 0)
			{
				EXPECT_LT(frame.features[i - 1].id, frame.features[i].id);
			}
		}
		for (const uint64_t id : live)
			if (now.count(id) == 0) ended.insert(id);
		live = now;
	}
	EXPECT_GT(ended.size(), 100u);
}
}  // namespace
}  // namespace viwo::sim
