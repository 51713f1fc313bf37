#include <gtest/gtest.h>
#include <viwo/core/Error.h>
#include <viwo/core/So3.h>
#include <viwo/frontend/FeatureTracker.h>

#include <chrono>
#include <iostream>
#include <map>
#include <set>

#include "TexturedPlane.h"

namespace viwo
{
namespace
{
using test::medianOf;
using test::TexturedPlane;

const CameraModel kCamera(640, 480, 300, 300, 319.5, 239.5, CameraModel::Distortion::plumb_bob, {-0.05, 0.01, 1e-4, -2e-4, 0});
constexpr double kDepth_m = 2;

/** Feeds images of the plane to a tracker and keeps, for every track, the point of the plane on which it began. */
class Sequence
{
   public:
	explicit Sequence(const TrackerOptions& options = {}, const cv::Mat& mask = {}) : tracker(kCamera, options, mask) {}

	const FeatureFrame& next(const Pose3& T_WC, double gain = 1, double noise = 0)
	{
		std::optional<Eigen::Quaterniond> R;
		if (count > 0) R = T_previous.R.conjugate() * T_WC.R;
		frame = tracker.track(100'000'000LL * count, plane.render(kCamera, T_WC, gain, noise, 100 + static_cast<uint64_t>(count)),
		                      with_rotation ? R : std::nullopt);
		++count;
		T_previous = T_WC;
		errors.clear();
		for (const FeatureObservation& f : frame.features)
		{
			const auto [it, is_new] = origin.emplace(f.id, plane.pointAt(f.bearing_C, T_WC));
			if (!is_new) errors[f.id] = f.pixel - *kCamera.project(T_WC.inverse() * it->second);
		}
		return frame;
	}

	/** Of the tracks with id < end_id that go on. */
	double medianError_px(uint64_t end_id = UINT64_MAX) const
	{
		std::vector<double> norms;
		for (const auto& [id, e] : errors)
			if (id < end_id) norms.push_back(e.norm());
		return medianOf(norms);
	}
	Eigen::Vector2d bias_px() const
	{
		std::vector<double> x, y;
		for (const auto& [id, e] : errors) x.push_back(e.x()), y.push_back(e.y());
		return {medianOf(x), medianOf(y)};
	}

	TexturedPlane plane{kDepth_m};
	FeatureTracker tracker;
	FeatureFrame frame;
	bool with_rotation = true;
	int count = 0;
	Pose3 T_previous;
	std::map<uint64_t, Eigen::Vector3d> origin;
	std::map<uint64_t, Eigen::Vector2d> errors;
};

Pose3 poseAt(const Eigen::Vector3d& phi, const Eigen::Vector3d& p)
{
	return {so3::expQuaternion(phi), p};
}

TEST(FeatureTracker, FollowsATranslationToAFewHundredthsOfAPixel)
{
	Sequence s;
	s.next(poseAt({0, 0, 0}, {0, 0, 0}), 1, 2);
	EXPECT_GT(s.frame.features.size(), 140u);
	s.next(poseAt({0, 0, 0}, {0.02, 0.004, 0.03}), 1, 2);
	const double error = s.medianError_px();
	std::cout << "[measured] one step, noise 2 grey levels: tracked " << s.tracker.stats().tracked << " of 150, median error " << error
	          << " px, bias " << s.bias_px().transpose() << " px\n";
	EXPECT_GE(s.tracker.stats().tracked, 130);
	EXPECT_LT(error, 0.08);
	EXPECT_LT(s.bias_px().norm(), 0.02);
}

TEST(FeatureTracker, DriftsLittleOverManyFrames)
{
	for (const Eigen::Vector3d& step : {Eigen::Vector3d(0.01, 0.003, 0), Eigen::Vector3d(0, 0, 0.01)})
	{
		Sequence s;
		for (int k = 0; k <= 40; ++k) s.next(poseAt({0, 0, 0}, k * step), 1, 2);
		size_t survivors = 0;
		for (const auto& [id, e] : s.errors) survivors += id < 150;
		const double error = s.medianError_px(150);
		std::cout << "[measured] after 40 frames of " << step.transpose() << " m: " << survivors << " of the first 150 live, median drift "
		          << error << " px\n";
		EXPECT_GE(survivors, 90u);
		EXPECT_LT(error, 0.3);
	}
}

TEST(FeatureTracker, PredictsAFastRotation)
{
	Sequence with, without;
	without.with_rotation = false;
	for (int k = 0; k < 2; ++k)
	{
		with.next(poseAt({0.03 * k, 0.25 * k, 0.12 * k}, {0, 0, 0}));
		without.next(poseAt({0.03 * k, 0.25 * k, 0.12 * k}, {0, 0, 0}));
	}
	std::cout << "[measured] 16 degrees in one frame: tracked " << with.tracker.stats().tracked << ", without prediction "
	          << without.tracker.stats().tracked << ", median error " << with.medianError_px() << " px\n";
	EXPECT_GE(with.tracker.stats().tracked, 75);
	EXPECT_LT(with.medianError_px(), 0.8);  // the window is not warped
	EXPECT_LT(without.tracker.stats().tracked, with.tracker.stats().tracked);
}

TEST(FeatureTracker, StandsAnExposureStep)
{
	TrackerOptions uncompensated;
	uncompensated.gain_compensation = false;
	for (const double gain : {0.5, 0.8, 1.35})
	{
		Sequence s, plain(uncompensated);
		for (Sequence* each : {&s, &plain})
		{
			each->next(poseAt({0, 0, 0}, {0, 0, 0}), 1, 1);
			each->next(poseAt({0, 0, 0.02}, {0.02, 0, 0}), gain, 1);
		}
		std::cout << "[measured] gain " << gain << " (found " << s.tracker.stats().gain << "): tracked " << s.tracker.stats().tracked
		          << ", median error " << s.medianError_px() << " px; uncompensated " << plain.tracker.stats().tracked << ", "
		          << plain.medianError_px() << " px\n";
		EXPECT_NEAR(s.tracker.stats().gain, gain, 0.02 * gain);
		EXPECT_GE(s.tracker.stats().tracked, 125);
		EXPECT_LT(s.medianError_px(), 0.1);
		EXPECT_TRUE(plain.tracker.stats().tracked < s.tracker.stats().tracked || plain.medianError_px() > s.medianError_px());
	}
}

TEST(FeatureTracker, BlackAndOverexposedImagesEndAllTracksAndIdsAreNeverReused)
{
	Sequence s;
	std::set<uint64_t> before, after;
	for (int k = 0; k < 3; ++k)
		for (const auto& f : s.next(poseAt({0, 0, 0}, {0.01 * k, 0, 0})).features) before.insert(f.id);
	for (const double level : {0.0, 255.0})
	{
		const FeatureFrame dark =
		    s.tracker.track(1'000'000'000, cv::Mat(480, 640, CV_8U, cv::Scalar(level)), Eigen::Quaterniond::Identity());
		EXPECT_TRUE(dark.features.empty());
		EXPECT_EQ(dark.t_ns, 1'000'000'000);
		EXPECT_FALSE(s.tracker.stats().usable);
	}
	EXPECT_TRUE(s.tracker.track(1'100'000'000, cv::Mat(), std::nullopt).features.empty());
	for (int k = 0; k < 3; ++k)
		for (const auto& f : s.next(poseAt({0, 0, 0}, {0.01 * k, 0, 0})).features) after.insert(f.id);
	EXPECT_TRUE(s.tracker.stats().usable);
	EXPECT_GT(after.size(), 100u);
	EXPECT_GT(*after.begin(), *before.rbegin());
	s.tracker.reset();
	EXPECT_GT(s.next(poseAt({0, 0, 0}, {0, 0, 0})).features.front().id, *after.rbegin());
}

TEST(FeatureTracker, FeaturesAreSortedInsideTheMaskApartFromEachOtherAndKnowTheirBearing)
{
	cv::Mat mask(480, 640, CV_8U, cv::Scalar(255));
	mask(cv::Rect(0, 300, 640, 180)).setTo(0);
	TrackerOptions options;
	Sequence s(options, mask);
	for (int k = 0; k < 8; ++k)
	{
		const FeatureFrame& frame = s.next(poseAt({0, 0, 0.01 * k}, {0, -0.03 * k, 0}));
		ASSERT_GT(frame.features.size(), 80u);
		ASSERT_LE(frame.features.size(), 150u);
		for (size_t i = 0; i < frame.features.size(); ++i)
		{
			const FeatureObservation& f = frame.features[i];
			EXPECT_LT(f.pixel.y(), 300.5);
			EXPECT_LT((*kCamera.project(f.bearing_C) - f.pixel).norm(), 1e-6);
			EXPECT_NEAR(f.bearing_C.norm(), 1, 1e-12);
			if (i == 0) continue;
			EXPECT_GT(f.id, frame.features[i - 1].id);
			for (size_t j = 0; j < i; ++j) EXPECT_GT((frame.features[j].pixel - f.pixel).norm(), 0.49 * options.min_distance_px);
		}
	}
}

TEST(FeatureTracker, CornersAreSpreadOverTheImage)
{
	Sequence s;
	std::map<int, int> count;
	for (const auto& f : s.next({}).features) ++count[static_cast<int>(f.pixel.x()) / 160 + 4 * (static_cast<int>(f.pixel.y()) / 160)];
	EXPECT_EQ(count.size(), 12u);
	for (const auto& [cell, n] : count) EXPECT_GE(n, 5) << "cell " << cell;
}

TEST(FeatureTracker, SameImagesSameBytesWhateverTheThreads)
{
	const int threads = cv::getNumThreads();
	std::vector<std::vector<double>> runs;
	for (const int n : {1, 4})
	{
		cv::setNumThreads(n);
		Sequence s;
		runs.emplace_back();
		for (int k = 0; k < 6; ++k)
			for (const auto& f : s.next(poseAt({0, 0.01 * k, 0}, {0.02 * k, 0, 0.02 * k}), 1, 3).features)
				runs.back().insert(runs.back().end(), {static_cast<double>(f.id), f.pixel.x(), f.pixel.y(), f.bearing_C.x()});
	}
	cv::setNumThreads(threads);
	EXPECT_GT(runs[0].size(), 1000u);
	EXPECT_EQ(runs[0], runs[1]);
}

TEST(FeatureTracker, RefusesWhatDoesNotFitTheCalibration)
{
	EXPECT_THROW(FeatureTracker(CameraModel(), {}), Error);
	EXPECT_THROW(FeatureTracker(kCamera, {}, cv::Mat(10, 10, CV_8U)), Error);
	TrackerOptions missing_mask;
	missing_mask.mask_path = "no such file.png";
	EXPECT_THROW(FeatureTracker(kCamera, missing_mask), Error);
	FeatureTracker tracker(kCamera, {});
	EXPECT_THROW(tracker.track(0, cv::Mat(100, 100, CV_8U, cv::Scalar(100))), Error);
	EXPECT_THROW(tracker.track(0, cv::Mat(480, 640, CV_8UC3, cv::Scalar(100))), Error);
}

TEST(FeatureTracker, Speed)
{
	const int threads = cv::getNumThreads();
	cv::setNumThreads(1);
	TexturedPlane plane(kDepth_m);
	std::vector<cv::Mat> images;
	for (int k = 0; k < 15; ++k) images.push_back(plane.render(kCamera, poseAt({0, 0, 0.005 * k}, {0.015 * k, 0, 0.02 * k}), 1, 2));
	FeatureTracker tracker(kCamera, {});
	const Eigen::Quaterniond R = so3::expQuaternion({0, 0, 0.005});
	std::vector<double> times_ms;
	for (const cv::Mat& image : images)
	{
		const auto begin = std::chrono::steady_clock::now();
		tracker.track(0, image, R);
		times_ms.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
	}
	cv::setNumThreads(threads);
	EXPECT_GT(tracker.stats().tracked, 100);
	std::cout << "[measured] " << medianOf(times_ms) << " ms a frame of 640x480 with 150 features, one thread\n";
}
}  // namespace
}  // namespace viwo
