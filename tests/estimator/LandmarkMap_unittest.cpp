#include <LandmarkMap.h>

#include <viwo/core/So3.h>

#include <PointScene.h>
#include <gtest/gtest.h>
#include <residuals/BlockAlgebra.h>
#include <residuals/ReprojectionResidual.h>

#include <iostream>

namespace viwo
{
namespace
{
const Pose3 kT_BC(forwardOpticalAxes(), Eigen::Vector3d(0.05, -0.02, 0.1));
constexpr double kSigma_rad = 2e-3;

/** Frames of a camera that drives sideways past a wall of points. */
struct Views
{
	explicit Views(int count, double noise_rad = 0, double outlier_share = 0)
	    : scene(Eigen::Vector3d(2, -2, -1), Eigen::Vector3d(5, 2, 1.5), 60, 0, 5), map(settings())
	{
		for (int k = 0; k < count; ++k)
		{
			auto frame = std::make_unique<Frame>();
			frame->id = k;
			const Pose3 T_WB(so3::expQuaternion({0, 0.01 * k, 0.03 * k}), Eigen::Vector3d(0.05 * k, 0.15 * k, 0.01 * k));
			poseToBlock(T_WB, frame->pose.data());
			frame->features = scene.observe(k * 100'000'000, T_WB * kT_BC, {noise_rad, outlier_share, 3});
			frames.push_back(std::move(frame));
			map.add(*frames.back());
		}
	}

	static LandmarkMap::Settings settings()
	{
		LandmarkMap::Settings s;
		s.sigma_rad = kSigma_rad;
		s.outlier_rad = 5 * kSigma_rad;
		s.prior_sigma_1_m = 5;
		return s;
	}

	Eigen::Vector3d pointOf(const Landmark& l) const
	{
		return poseFromBlock(l.anchor().pose.data()) * kT_BC * Eigen::Vector3d(l.sightings.front().bearing_C / l.inverse_depth_1_m);
	}
	double largestError_m() const
	{
		double worst = 0;
		for (const auto& [id, l] : map.all())
			if (l.in_use) worst = std::max(worst, (pointOf(l) - scene.points_W[id]).norm());
		return worst;
	}
	int inUse() const
	{
		int count = 0;
		for (const auto& [id, l] : map.all()) count += l.in_use;
		return count;
	}
	bool refersTo(const Frame& frame) const
	{
		for (const auto& [id, l] : map.all())
			for (const Sighting& s : l.sightings)
				if (s.frame == &frame) return true;
		return false;
	}

	test::PointScene scene;
	std::vector<std::unique_ptr<Frame>> frames;
	LandmarkMap map;
};

TEST(LandmarkMap, TriangulatesExactlyWhatIsExact)
{
	Views views(6);
	views.map.triangulate(kT_BC);
	std::cout << "[measured] " << views.inUse() << " landmarks, largest error " << 1e3 * views.largestError_m() << " mm\n";
	EXPECT_GT(views.inUse(), 40);
	// The weak prior on the depth pulls by a trace.
	EXPECT_LT(views.largestError_m(), 1e-3);
	EXPECT_EQ(views.map.assess(kT_BC), 0);
	for (const auto& [id, l] : views.map.all())
	{
		if (!l.in_use) continue;
		EXPECT_GT(l.deviation, 0);
		EXPECT_LT(l.deviation, 0.3);
	}
	EXPECT_EQ(views.map.countKnown(*views.frames.back()), views.map.countSeen(*views.frames.back()));
}

TEST(LandmarkMap, DeviationIsThatOfTheDepth)
{
	// The anchor's bearing counts as exact (Niu et al. Eq. 16): its noise, common to all sightings, makes the errors larger than the
	// deviations say, at most by the factor of one anchor and n others against n others alone.
	double sum = 0;
	int count = 0;
	Views views(5, kSigma_rad);
	views.map.triangulate(kT_BC);
	views.map.assess(kT_BC);
	for (const auto& [id, l] : views.map.all())
	{
		if (!l.in_use) continue;
		const Pose3 T_WC = poseFromBlock(l.anchor().pose.data()) * kT_BC;
		const double truth = 1 / (T_WC.inverse() * views.scene.points_W[id]).norm();
		sum += std::pow((l.inverse_depth_1_m - truth) / (l.deviation * l.inverse_depth_1_m), 2);
		++count;
	}
	std::cout << "[measured] normalised squared error of the inverse depth " << sum / count << " over " << count << " landmarks\n";
	EXPECT_GT(count, 30);
	EXPECT_GT(sum / count, 0.8);
	EXPECT_LT(sum / count, 1 + 4 + 1);
}

TEST(LandmarkMap, OneSightingHasNoDepth)
{
	Views views(1);
	views.map.triangulate(kT_BC);
	EXPECT_EQ(views.inUse(), 0);
	EXPECT_EQ(views.map.countSeen(*views.frames[0]), 0);
}

TEST(LandmarkMap, WithoutParallaxTheDepthIsUnknown)
{
	Views views(1);
	Frame again = *views.frames[0];
	views.map.add(again);
	views.map.triangulate(kT_BC);
	views.map.assess(kT_BC);
	EXPECT_GT(views.map.countSeen(again), 30);
	EXPECT_EQ(views.map.countKnown(again), 0);
}

TEST(LandmarkMap, AnchorsMoveAndPointsStay)
{
	Views views(6);
	views.map.triangulate(kT_BC);
	std::map<uint64_t, Eigen::Vector3d> before;
	for (const auto& [id, l] : views.map.all())
		if (l.in_use) before[id] = views.pointOf(l);
	for (auto& [id, l] : views.map.all())
		for (size_t i = 1; i < l.sightings.size(); ++i)
			l.sightings[i].factor = std::make_shared<ReprojectionResidual>(l.sightings[0].bearing_C, l.sightings[i].bearing_C, kSigma_rad);
	views.map.forget(*views.frames[0], kT_BC);
	EXPECT_FALSE(views.refersTo(*views.frames[0]));
	double worst_m = 0;
	int moved = 0;
	for (const auto& [id, l] : views.map.all())
	{
		if (!l.in_use) continue;
		worst_m = std::max(worst_m, (views.pointOf(l) - before.at(id)).norm());
		if (&l.anchor() != views.frames[1].get()) continue;
		++moved;
		for (const Sighting& s : l.sightings) EXPECT_EQ(s.factor, nullptr);  // made against the anchor that is gone
	}
	std::cout << "[measured] " << moved << " landmarks moved to another anchor, by " << 1e6 * worst_m << " um at most\n";
	EXPECT_GT(moved, 30);
	EXPECT_LT(worst_m, 2e-3);  // exact bearings; depths carry the prior's trace
}

TEST(LandmarkMap, ForgettingAFrameInTheMiddleKeepsTheAnchor)
{
	Views views(6);
	views.map.triangulate(kT_BC);
	const int used = views.inUse();
	views.map.forget(*views.frames[3], kT_BC);
	EXPECT_FALSE(views.refersTo(*views.frames[3]));
	EXPECT_EQ(views.inUse(), used);
	for (const auto& [id, l] : views.map.all()) EXPECT_NE(&l.anchor(), views.frames[3].get());
	for (int k : {5, 4, 2, 1, 0}) views.map.forget(*views.frames[k], kT_BC);
	EXPECT_TRUE(views.map.all().empty());
}

TEST(LandmarkMap, ErasingAnAnchorBeginsTracksAnew)
{
	Views views(4);
	views.map.triangulate(kT_BC);
	views.map.eraseAnchoredIn(*views.frames[0]);
	EXPECT_FALSE(views.refersTo(*views.frames[0]));
	for (const auto& [id, l] : views.map.all()) EXPECT_NE(&l.anchor(), views.frames[0].get());
	Frame next = *views.frames[3];
	FeatureObservation seen;
	for (const FeatureObservation& a : views.frames[0]->features.features)
		for (const FeatureObservation& b : next.features.features)
			if (a.id == b.id) seen = a;
	EXPECT_EQ(views.map.all().count(seen.id), 0u);
	views.map.add(next);
	ASSERT_EQ(views.map.all().count(seen.id), 1u);
	EXPECT_EQ(views.map.all().at(seen.id).sightings.size(), 1u);
	EXPECT_EQ(&views.map.all().at(seen.id).anchor(), &next);
	EXPECT_FALSE(views.map.all().at(seen.id).in_use);
}

TEST(LandmarkMap, OutliersAreThrownOut)
{
	Views views(6);
	views.map.triangulate(kT_BC);
	const int used = views.inUse();
	// Two sightings of one track jump to other corners; another's depth turns negative.
	auto it = views.map.all().begin();
	while (!it->second.in_use || it->second.sightings.size() < 5) ++it;
	const uint64_t jumped = it->first;
	it->second.sightings[2].bearing_C = so3::exp({0.05, 0.02, 0}) * it->second.sightings[2].bearing_C;
	it->second.sightings[4].bearing_C = so3::exp({-0.05, 0.04, 0}) * it->second.sightings[4].bearing_C;
	++it;
	while (!it->second.in_use) ++it;
	const uint64_t behind = it->first;
	it->second.inverse_depth_1_m = -0.2;
	EXPECT_EQ(views.map.assess(kT_BC), 2);
	EXPECT_EQ(views.map.all().count(jumped), 0u);
	EXPECT_EQ(views.map.all().count(behind), 0u);
	EXPECT_EQ(views.inUse(), used - 2);
}

TEST(LandmarkMap, TracksThatFitNoPointAreNotUsed)
{
	Views views(6, 0, 0.2);
	views.map.triangulate(kT_BC);
	EXPECT_GT(views.inUse(), 30);
	for (const auto& [id, l] : views.map.all())
	{
		if (!l.in_use) continue;
		EXPECT_GE(id % 100, 20u) << "a bearing off by up to 0.15 rad was given a depth";
	}
}

TEST(LandmarkMap, OrderedById)
{
	Views views(3);
	std::vector<uint64_t> ids;
	for (const auto& [id, l] : views.map.all())
	{
		EXPECT_EQ(l.id, id);
		ids.push_back(id);
	}
	EXPECT_GT(ids.size(), 30u);
	EXPECT_TRUE(std::is_sorted(ids.begin(), ids.end()));
}
}  // namespace
}  // namespace viwo
