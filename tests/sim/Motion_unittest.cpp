#include <gtest/gtest.h>
#include <viwo/core/Error.h>
#include <viwo/core/So3.h>

#include "SimFixtures.h"

namespace viwo::sim
{
namespace
{
using Eigen::Vector3d;

struct Worst
{
	double v = 0, a = 0, w = 0, alpha = 0;
};

/** Exact derivatives against fourth-order differences of the state one order below. */
Worst worstDifference(const Motion& motion, double h)
{
	Worst worst;
	const auto difference = [h](const Vector3d& m2, const Vector3d& m1, const Vector3d& p1, const Vector3d& p2) -> Vector3d
	{ return (m2 - 8 * m1 + 8 * p1 - p2) / (12 * h); };
	for (double t = 0.05; t < motion.duration_s() - 0.05; t += 0.0371)
	{
		const MotionState s = motion.at(t), m2 = motion.at(t - 2 * h), m1 = motion.at(t - h), p1 = motion.at(t + h),
		                  p2 = motion.at(t + 2 * h);
		const auto turn = [&](const MotionState& other) { return so3::log(s.T_WO.R.conjugate() * other.T_WO.R); };
		worst.v = std::max(worst.v, (difference(m2.T_WO.p, m1.T_WO.p, p1.T_WO.p, p2.T_WO.p) - s.v_WO).norm());
		worst.a = std::max(worst.a, (difference(m2.v_WO, m1.v_WO, p1.v_WO, p2.v_WO) - s.a_WO).norm());
		worst.w = std::max(worst.w, (difference(turn(m2), turn(m1), turn(p1), turn(p2)) - s.w_O).norm());
		worst.alpha = std::max(worst.alpha, (difference(m2.w_O, m1.w_O, p1.w_O, p2.w_O) - s.alpha_O).norm());
	}
	return worst;
}

TEST(Motion, DerivativesAreThoseOfThePoseOnEveryKindOfSegment)
{
	const Motion motion(variedRoute(), FloorOptions(), VibrationOptions(), 3);
	const Worst worst = worstDifference(motion, 2e-4);
	measured("velocity against differences", worst.v, "m/s");
	measured("acceleration against differences", worst.a, "m/s^2");
	measured("rate against differences", worst.w, "rad/s");
	measured("angular acceleration against differences", worst.alpha, "rad/s^2");
	EXPECT_LT(worst.v, 1e-9);
	EXPECT_LT(worst.a, 1e-6);
	EXPECT_LT(worst.w, 1e-9);
	EXPECT_LT(worst.alpha, 1e-6);
}

TEST(Motion, FlatFloorWithoutVibrationStaysInThePlane)
{
	const Motion motion(variedRoute());
	for (double t = 0; t < motion.duration_s(); t += 0.1)
	{
		const MotionState s = motion.at(t);
		EXPECT_EQ(s.T_WO.p.z(), 0);
		EXPECT_EQ(s.v_WO.z(), 0);
		EXPECT_NEAR(s.w_O.head<2>().norm(), 0, 1e-15);
		EXPECT_NEAR((s.T_WO.R * Vector3d::UnitZ() - Vector3d::UnitZ()).norm(), 0, 1e-14);
	}
}

TEST(Motion, RollsAlongItsOwnAxisOnAnUnevenFloor)
{
	const Motion motion(variedRoute(), FloorOptions(), VibrationOptions::off(), 5);
	double tilt_squared = 0, height_squared = 0;
	int count = 0;
	for (double t = 0; t < motion.duration_s(); t += 0.05, ++count)
	{
		const MotionState s = motion.at(t);
		const Vector3d v_O = s.T_WO.R.conjugate() * s.v_WO;
		EXPECT_NEAR(v_O.z(), 0, 1e-12);
		EXPECT_NEAR(v_O.y(), 0, 1e-5);
		tilt_squared += (s.T_WO.R * Vector3d::UnitZ()).head<2>().squaredNorm();
		height_squared += s.T_WO.p.z() * s.T_WO.p.z();
	}
	const double tilt_deg = std::sqrt(tilt_squared / count) * 180 / M_PI, height_mm = 1e3 * std::sqrt(height_squared / count);
	measured("tilt rms", tilt_deg, "deg");
	measured("height rms", height_mm, "mm");
	EXPECT_GT(tilt_deg, 0.05);
	EXPECT_LT(tilt_deg, 0.5);
	EXPECT_GT(height_mm, 0.3);
	EXPECT_LT(height_mm, 2);
}

TEST(Motion, VibrationHasTheStrengthAskedForAndStopsWithTheRobot)
{
	const Motion smooth(routeOf("straight 3 m, stand 2 s")),
	    shaken(routeOf("straight 3 m, stand 2 s"), FloorOptions::flat(), VibrationOptions(), 7);
	double acc_squared = 0, rate_squared = 0;
	int count = 0;
	for (double t = 3; t < 18; t += 0.0013, ++count)
	{
		acc_squared += (shaken.at(t).a_WO - smooth.at(t).a_WO).squaredNorm() / 3;
		rate_squared += (shaken.at(t).w_O - smooth.at(t).w_O).squaredNorm() / 3;
	}
	measured("vibration acceleration rms", std::sqrt(acc_squared / count), "m/s^2");
	EXPECT_NEAR(std::sqrt(acc_squared / count), VibrationOptions().acceleration_m_s2, 0.1 * VibrationOptions().acceleration_m_s2);
	EXPECT_NEAR(std::sqrt(rate_squared / count) * 180 / M_PI, VibrationOptions().rate_deg_s, 0.1 * VibrationOptions().rate_deg_s);
	EXPECT_EQ(shaken.at(shaken.duration_s() - 0.5).a_WO, Vector3d(Vector3d::Zero()));
}

TEST(Motion, SegmentsEndWhereTheyShould)
{
	Route route = routeOf("straight 2 m, rotate 90 deg, straight 1 m, arc 1 m -180 deg");
	route.start_x_m = route.start_y_m = route.start_yaw_deg = 0;
	const Motion motion(route);
	const MotionState end = motion.at(motion.duration_s());
	// The arc is entered in motion: its yaw rate ramps up, which shifts the end, but not the heading.
	EXPECT_NEAR(yawOf(end.T_WO.R), -M_PI / 2, 1e-9);
	EXPECT_NEAR(end.v_WO.norm(), 0, 1e-12);
	EXPECT_NEAR(end.w_O.norm(), 0, 1e-12);
	EXPECT_NEAR(end.T_WO.p.x(), 4, 0.2);
	route.segments = "arc 1 m 180 deg";
	const Motion arc(route);
	EXPECT_NEAR((arc.at(arc.duration_s()).T_WO.p - Vector3d(0, 2, 0)).norm(), 0, 1e-9)
	    << "from rest to rest speed and yaw rate ramp together";
	route.segments = "straight 0.02 m, rotate 2 deg";
	const Motion tiny(route);
	EXPECT_NEAR((tiny.at(tiny.duration_s()).T_WO.p - Vector3d(0.02, 0, 0)).norm(), 0, 1e-9);
	EXPECT_NEAR(yawOf(tiny.at(tiny.duration_s()).T_WO.R), 2 * M_PI / 180, 1e-9);
}

TEST(Motion, BeginsInMidMotionWhenAsked)
{
	for (const char* segments : {"straight 3 m", "arc 1 m 90 deg"})
	{
		const MotionState begin = Motion(routeOf(segments, true)).at(0);
		EXPECT_NEAR(begin.v_WO.norm(), 0.15, 1e-12) << segments;
	}
	EXPECT_NEAR(Motion(routeOf("arc 1 m 90 deg", true)).at(0).w_O.z(), 0.15, 1e-12);
	EXPECT_NEAR(Motion(routeOf("rotate -360 deg", true, false)).at(0).w_O.z(), -0.15, 1e-12);
	const Motion free(routeOf("free 20 s", true, false));
	EXPECT_NEAR(free.at(0).v_WO.norm(), 0.15, 1e-12);
	EXPECT_GT(free.at(free.duration_s()).v_WO.norm(), 0.05);
}

TEST(Motion, AccelerationStaysWithinItsLimits)
{
	const Route route = routeOf("straight 2 m, arc 0.5 m 90 deg, rotate 90 deg");
	const Motion motion(route);
	for (double t = 0; t < motion.duration_s(); t += 0.01)
	{
		const MotionState s = motion.at(t);
		const double centripetal_m_s2 = s.v_WO.norm() * std::abs(s.w_O.z());
		EXPECT_LE(s.a_WO.norm(), std::hypot(route.acceleration_m_s2, centripetal_m_s2) + 1e-9);
		EXPECT_LE(std::abs(s.alpha_O.z()), route.yaw_acceleration_rad_s2 + 1e-9);
	}
}

TEST(Route, RepetitionsAndErrors)
{
	Route route;
	route.segments = "2 x (straight 1 m, rotate 90 deg), stand 2 s";
	EXPECT_EQ(route.parsedSegments().size(), 5u);
	for (const char* bad : {"straight", "straight 1", "straight 1 cm", "fly 1 m", "straight 1 m rotate 3 deg", "", "straight 1 m,",
	                        "arc 0 m 90 deg", "0 x (stand 1 s)", "2 x (stand 1 s", "stand -1 s"})
	{
		route.segments = bad;
		EXPECT_THROW(route.parsedSegments(), Error) << bad;
	}
	EXPECT_THROW(Motion(routeOf("straight 0.01 m", true)), Error) << "cannot brake within a centimetre";
}
}  // namespace
}  // namespace viwo::sim
