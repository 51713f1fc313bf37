#include "ReferencePatch.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include <cmath>
#include <iostream>
#include <opencv2/imgproc.hpp>

namespace viwo
{
namespace
{
constexpr int kSide_px = 21;
const cv::Point2f kCorner(100.3f, 80.7f);

/** Smooth random texture. */
cv::Mat texture(uint64_t seed)
{
	cv::Mat noise(160, 200, CV_32F), image;
	cv::RNG rng(seed);
	rng.fill(noise, cv::RNG::NORMAL, 0, 1);
	cv::GaussianBlur(noise, noise, {}, 3);
	cv::normalize(noise, noise, 20, 230, cv::NORM_MINMAX);
	noise.convertTo(image, CV_8U);
	return image;
}

/** The image moved so that what was at the corner is at `centre`, deformed by A around it. */
cv::Mat moved(const cv::Mat& image, const Eigen::Matrix2f& A, const cv::Point2f& centre)
{
	const cv::Mat M = (cv::Mat_<double>(2, 3) << A(0, 0), A(0, 1), centre.x - A(0, 0) * kCorner.x - A(0, 1) * kCorner.y, A(1, 0), A(1, 1),
	                   centre.y - A(1, 0) * kCorner.x - A(1, 1) * kCorner.y);
	cv::Mat result;
	cv::warpAffine(image, result, M, image.size(), cv::INTER_CUBIC, cv::BORDER_REFLECT);
	return result;
}

TEST(ReferencePatch, FindsItsCornerUnderAnAffineWarp)
{
	double worst_px = 0;
	for (uint64_t seed = 1; seed <= 20; ++seed)
	{
		const cv::Mat first = texture(seed);
		auto patch = ReferencePatch::at(first, kCorner, kSide_px);
		ASSERT_TRUE(patch) << seed;
		cv::Point2f centre = kCorner;
		// Turned, sheared and enlarged step by step, as a wall is by an approach at an angle.
		for (int step = 1; step <= 10; ++step)
		{
			const float s = static_cast<float>(step);
			Eigen::Matrix2f A;
			A << 1 + 0.02f * s, 0.01f * s, -0.015f * s, 1 + 0.01f * s;
			centre = kCorner + cv::Point2f(2.3f * s, -1.1f * s);
			const auto found = patch->find(moved(first, A, centre), centre + cv::Point2f(0.4f, -0.5f), {});
			ASSERT_TRUE(found) << "seed " << seed << " step " << step;
			worst_px = std::max(worst_px, cv::norm(*found - centre));
			EXPECT_NEAR(patch->magnification(), A.determinant(), 0.05);
		}
	}
	std::cout << "[measured] worst error of 20 corners, enlarged up to " << 1.2 * 1.1 << " fold: " << worst_px << " px\n";
	EXPECT_LT(worst_px, 0.1);
}

TEST(ReferencePatch, BrightnessAndContrastDoNotMatter)
{
	const cv::Mat first = texture(3);
	auto patch = ReferencePatch::at(first, kCorner, kSide_px);
	ASSERT_TRUE(patch);
	cv::Mat dimmed;
	first.convertTo(dimmed, CV_8U, 0.5, 40);
	const auto found = patch->find(dimmed, kCorner + cv::Point2f(0.5f, 0.3f), {});
	ASSERT_TRUE(found);
	EXPECT_LT(cv::norm(*found - kCorner), 0.05);
}

/** The left half stands still while the right half slides: such a corner is no point of one surface. */
TEST(ReferencePatch, ACornerOfTwoSurfacesIsLost)
{
	int lost = 0;
	constexpr int kCorners = 20;
	for (uint64_t seed = 1; seed <= kCorners; ++seed)
	{
		const cv::Mat behind = texture(seed), before = texture(seed + 100);
		const cv::Rect left(0, 0, static_cast<int>(kCorner.x), before.rows);
		const auto scene = [&](float slide_px)
		{
			cv::Mat image = moved(behind, Eigen::Matrix2f::Identity(), kCorner + cv::Point2f(slide_px, 0));
			before(left).copyTo(image(left));
			return image;
		};
		auto patch = ReferencePatch::at(scene(0), kCorner, kSide_px);
		ASSERT_TRUE(patch);
		bool found = true;
		for (int step = 1; step <= 12 && found; ++step) found = patch->find(scene(static_cast<float>(step)), kCorner, {}).has_value();
		lost += found ? 0 : 1;
	}
	std::cout << "[measured] lost " << lost << " of " << kCorners << " corners between two surfaces\n";
	EXPECT_GE(lost, kCorners - 1);
}

TEST(ReferencePatch, AnotherTextureIsNotTheCorner)
{
	int mistaken = 0;
	for (uint64_t seed = 1; seed <= 50; ++seed)
	{
		auto patch = ReferencePatch::at(texture(seed), kCorner, kSide_px);
		ASSERT_TRUE(patch);
		mistaken += patch->find(texture(seed + 1000), kCorner, {}) ? 1 : 0;
	}
	EXPECT_EQ(mistaken, 0);
}

TEST(ReferencePatch, NeedsTextureInTwoDirectionsAndAPlaceInTheImage)
{
	const cv::Mat flat(160, 200, CV_8UC1, cv::Scalar(128));
	EXPECT_FALSE(ReferencePatch::at(flat, kCorner, kSide_px));
	cv::Mat edge = flat.clone();
	edge.colRange(100, 200) = 200;
	cv::GaussianBlur(edge, edge, {}, 2);
	EXPECT_FALSE(ReferencePatch::at(edge, kCorner, kSide_px));
	EXPECT_FALSE(ReferencePatch::at(texture(1), {9, 80}, kSide_px));

	auto patch = ReferencePatch::at(texture(1), {14, 80}, kSide_px);
	ASSERT_TRUE(patch);
	EXPECT_FALSE(patch->find(texture(1), {5, 80}, {})) << "it has left the image";
}

TEST(ReferencePatch, DoesNotJumpToWhereOpticalFlowIsNot)
{
	const cv::Mat first = texture(4);
	TrackerOptions options;
	options.reference_shift_px = 0.5;
	auto patch = ReferencePatch::at(first, kCorner, kSide_px);
	ASSERT_TRUE(patch);
	EXPECT_FALSE(patch->find(first, kCorner + cv::Point2f(0.8f, 0), options));
	EXPECT_TRUE(patch->find(first, kCorner + cv::Point2f(0.3f, 0), options));
}
}  // namespace
}  // namespace viwo
