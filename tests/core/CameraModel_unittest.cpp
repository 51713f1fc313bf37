#include <gtest/gtest.h>
#include <viwo/core/CameraModel.h>

#include <cmath>
#include <iostream>

using namespace viwo;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Distortion = CameraModel::Distortion;

namespace
{
CameraModel euroc()
{
	return {752, 480, 458.654, 457.296, 367.215, 248.375, Distortion::plumb_bob, {-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05, 0}};
}
CameraModel wide()
{
	return {640, 480, 245, 245, 319.5, 239.5, Distortion::plumb_bob, {-0.2, 0.03, 0.001, -0.0008, 0}};
}
CameraModel fisheye()
{
	return {512, 512, 240.98, 240.97, 254.93, 256.9, Distortion::kannala_brandt, {0.0034824, 0.000715, -0.0020532, 0.00020294}};
}
CameraModel pinhole()
{
	return {640, 480, 300, 310, 320, 240};
}

double worstRoundTrip_px(const CameraModel& camera)
{
	double worst = 0;
	for (int v = 0; v < camera.height_px(); v += 7)
		for (int u = 0; u < camera.width_px(); u += 7)
		{
			const Vector3d ray = camera.unproject(Vector2d(u, v));
			EXPECT_NEAR(ray.norm(), 1, 1e-15);
			const auto pixel = camera.project(2.5 * ray);
			if (!pixel) return 1e9;
			worst = std::max(worst, (*pixel - Vector2d(u, v)).norm());
		}
	return worst;
}
}  // namespace

TEST(CameraModel, UnprojectInvertsProjectOverTheImage)
{
	for (const auto& camera : {euroc(), wide(), fisheye(), pinhole()})
	{
		const double worst = worstRoundTrip_px(camera);
		std::cout << "[measured] round trip: " << worst << " px\n";
		EXPECT_LT(worst, 1e-9);
	}
}

TEST(CameraModel, PinholeByHand)
{
	const auto pixel = pinhole().project(Vector3d(0.5, -0.25, 2));
	ASSERT_TRUE(pixel);
	EXPECT_DOUBLE_EQ(pixel->x(), 320 + 300 * 0.25);
	EXPECT_DOUBLE_EQ(pixel->y(), 240 - 310 * 0.125);
}

TEST(CameraModel, PlumbBobByHand)
{
	const CameraModel camera(640, 480, 100, 200, 320, 240, Distortion::plumb_bob, {0.1, 0.02, 0.01, 0.03, 0.005});
	const double x = 0.5, y = -0.2, r2 = x * x + y * y;
	const double radial = 1 + 0.1 * r2 + 0.02 * r2 * r2 + 0.005 * r2 * r2 * r2;
	const double xd = x * radial + 2 * 0.01 * x * y + 0.03 * (r2 + 2 * x * x);
	const double yd = y * radial + 0.01 * (r2 + 2 * y * y) + 2 * 0.03 * x * y;
	const auto pixel = camera.project(Vector3d(3 * x, 3 * y, 3));
	ASSERT_TRUE(pixel);
	EXPECT_NEAR(pixel->x(), 320 + 100 * xd, 1e-12);
	EXPECT_NEAR(pixel->y(), 240 + 200 * yd, 1e-12);
}

TEST(CameraModel, EquidistantFisheyeByHand)
{
	const CameraModel camera(640, 480, 100, 100, 320, 240, Distortion::kannala_brandt, {});
	const auto pixel = camera.project(Vector3d(std::tan(1.2), 0, 1));
	ASSERT_TRUE(pixel);
	EXPECT_NEAR(pixel->x(), 320 + 100 * 1.2, 1e-12);
	EXPECT_NEAR(pixel->y(), 240, 1e-12);
}

TEST(CameraModel, NothingBehindTheCamera)
{
	for (const auto& camera : {euroc(), fisheye(), pinhole()})
	{
		EXPECT_FALSE(camera.project(Vector3d(0.1, 0.1, -1)));
		EXPECT_FALSE(camera.project(Vector3d(0.1, 0.1, 0)));
		EXPECT_FALSE(camera.project(Vector3d(0, 0, std::nan(""))));
		EXPECT_FALSE(camera.project(Vector3d(std::nan(""), 0, 1)));
		EXPECT_TRUE(camera.project(Vector3d(0, 0, 1)));
	}
}

TEST(CameraModel, NothingBeyondTheTurningPoint)
{
	// r (1 - 0.3 r^2) turns at r^2 = 1 / 0.9.
	const CameraModel camera(640, 480, 300, 300, 320, 240, Distortion::plumb_bob, {-0.3, 0, 0, 0, 0});
	const double turning = std::sqrt(1 / 0.9);
	EXPECT_TRUE(camera.project(Vector3d(turning * 0.999999, 0, 1)));
	EXPECT_FALSE(camera.project(Vector3d(turning * 1.000001, 0, 1)));
	EXPECT_FALSE(camera.project(Vector3d(50, 0, 1)));
	// The same for a fisheye: a (1 - 0.3 a^2) turns at the angle 1 / sqrt(0.9).
	const CameraModel fisheye(640, 480, 300, 300, 320, 240, Distortion::kannala_brandt, {-0.3, 0, 0, 0});
	EXPECT_TRUE(fisheye.project(Vector3d(std::tan(turning * 0.999999), 0, 1)));
	EXPECT_FALSE(fisheye.project(Vector3d(std::tan(turning * 1.000001), 0, 1)));
}

TEST(CameraModel, UnprojectNearTheTurningPointAndBeyondIt)
{
	const CameraModel camera(640, 480, 300, 300, 320, 240, Distortion::plumb_bob, {-0.3, 0, 0, 0, 0});
	const double turning = std::sqrt(1 / 0.9);
	const auto pixel = camera.project(Vector3d(0.9999 * turning, 0, 1));
	ASSERT_TRUE(pixel);
	const Vector3d ray = camera.unproject(*pixel);
	EXPECT_NEAR(ray.x() / ray.z(), 0.9999 * turning, 1e-9);
	const Vector3d beyond = camera.unproject(Vector2d(320 + 300, 240));
	EXPECT_NEAR(beyond.x() / beyond.z(), turning, 1e-6);
}

TEST(CameraModel, AnIncreasingPolynomialHasNoTurningPoint)
{
	const CameraModel camera(640, 480, 300, 300, 320, 240, Distortion::plumb_bob, {0.1, 0.01, 0, 0, 0});
	EXPECT_TRUE(camera.project(Vector3d(30, 0, 1)));
	EXPECT_TRUE(pinhole().project(Vector3d(1e6, 0, 1)));
}

TEST(CameraModel, ContainsPixelCentres)
{
	const auto camera = pinhole();
	EXPECT_TRUE(camera.contains({0, 0}));
	EXPECT_TRUE(camera.contains({639, 479}));
	EXPECT_FALSE(camera.contains({639.1, 0}));
	EXPECT_FALSE(camera.contains({-0.1, 0}));
	EXPECT_FALSE(camera.contains({5, 100}, 6));
	EXPECT_TRUE(camera.contains({6, 100}, 6));
	EXPECT_FALSE(camera.contains({std::nan(""), 3}));
}
