#include <gtest/gtest.h>
#include <viwo/core/Error.h>

#include <numeric>

#include "SimFixtures.h"

namespace viwo::sim
{
namespace
{
constexpr double kTick_m = 2 * M_PI * 0.035 / 2578.33;

/** True travel of the wheels by a fine midpoint sum. */
WheelSpeeds trueTravel(const Motion& motion, double end_s, double track_m)
{
	WheelSpeeds sum;
	const double step_s = 1e-3;
	const auto steps = static_cast<int>(std::round(end_s / step_s));
	for (int i = 0; i < steps; ++i)
	{
		const MotionState s = motion.at((i + 0.5) * step_s);
		const double v = (s.T_WO.R.conjugate() * s.v_WO).x();
		sum.left_m_s += step_s * (v - 0.5 * track_m * s.w_O.z());
		sum.right_m_s += step_s * (v + 0.5 * track_m * s.w_O.z());
	}
	return sum;
}

TEST(WheelModel, TicksAgreeWithTrueWheelTravel)
{
	const Motion motion(variedRoute(), FloorOptions(), VibrationOptions::off(), 3);
	WheelOptions options = WheelOptions::perfect();
	options.tick_quantisation = true;
	options.radius_error = 0.01;
	options.left_right_difference = 0.004;
	options.track_error = 0.01;
	const WheelModel wheels(motion, options, 3);
	EXPECT_NEAR(wheels.actual().k_left, 1.008, 1e-12);
	EXPECT_NEAR(wheels.actual().k_right, 1.012, 1e-12);
	EXPECT_NEAR(wheels.actual().track_m, 0.2323, 1e-12);
	const WheelReading &first = wheels.readings().front(), &last = wheels.readings().back();
	const WheelSpeeds truth = trueTravel(motion, last.t_s, 0.2323);
	const double left = kTick_m * 1.008 * static_cast<double>(last.ticks_left - first.ticks_left) - truth.left_m_s;
	const double right = kTick_m * 1.012 * static_cast<double>(last.ticks_right - first.ticks_right) - truth.right_m_s;
	measured("left ticks against true travel of " + std::to_string(truth.left_m_s) + " m", 1e6 * left, "um");
	measured("right ticks against true travel of " + std::to_string(truth.right_m_s) + " m", 1e6 * right, "um");
	EXPECT_LT(std::abs(left), 1.1 * kTick_m);
	EXPECT_LT(std::abs(right), 1.1 * kTick_m);
}

TEST(WheelModel, PerfectWheelsGiveTheExactMeanTwistAndPath)
{
	const Motion motion(variedRoute());
	const WheelModel wheels(motion, WheelOptions::perfect(), 1);
	double yaw = 0, distance = 0;
	for (size_t i = 1; i < wheels.readings().size(); ++i)
	{
		const double dt_s = wheels.readings()[i].t_s - wheels.readings()[i - 1].t_s;
		yaw += dt_s * wheels.readings()[i].mean_twist.w_rad_s;
		distance += dt_s * wheels.readings()[i].mean_twist.v_m_s;
		const MotionState truth = motion.at(wheels.readings()[i].t_s), start = motion.at(0);
		const Pose3 relative = start.T_WO.inverse() * truth.T_WO;
		EXPECT_NEAR(std::remainder(yaw - yawOf(relative.R), 2 * M_PI), 0, 1e-7);
		EXPECT_NEAR(wheels.readings()[i].x_m, relative.p.x(), 5e-4) << "constant twist over 50 ms is not quite the motion";
		EXPECT_NEAR(wheels.readings()[i].y_m, relative.p.y(), 5e-4);
	}
	EXPECT_NEAR(distance, trueTravel(motion, wheels.readings().back().t_s, 0).left_m_s, 1e-6);
}

TEST(WheelModel, NoiseGrowsWithSpeedAndVanishesAtRest)
{
	const Motion drive(routeOf("straight 60 m", true, false)), rest(routeOf("stand 10 s"));
	WheelOptions options = WheelOptions::perfect();
	options.noise_m_s_sqrtHz = 1e-3;
	options.noise_per_speed_sqrtHz = 0.01;
	const WheelModel wheels(drive, options, 8);
	const double density = std::hypot(1e-3, 0.01 * 0.15);
	double squared = 0;
	const auto samples = wheels.samples(0.05, drive.duration_s());
	for (const WheelSample& s : samples) squared += (s.v_left_m_s - 0.15) * (s.v_left_m_s - 0.15) / 20;
	const double found = std::sqrt(squared / static_cast<double>(samples.size()));
	measured("wheel noise density at 0.15 m/s (asked for " + std::to_string(density) + ")", found, "m/s/sqrtHz");
	EXPECT_NEAR(found, density, 0.03 * density);
	const WheelModel standing(rest, options, 8);
	for (const WheelReading& r : standing.readings()) EXPECT_EQ(r.ticks_left, standing.readings().front().ticks_left);
}

TEST(WheelModel, SlipTurnsOneWheelTooFarForItsTime)
{
	const Motion motion(routeOf("straight 3 m", true, false));
	WheelOptions options = WheelOptions::perfect();
	options.slips = {5.02, 2, 0.3, 1};
	const WheelModel wheels(motion, options, 1);
	double excess_m = 0;
	for (const WheelSample& s : wheels.samples(0.05, motion.duration_s()))
	{
		const double t_s = secondsBetween(motion.epoch_ns(), s.t_ns);
		EXPECT_NEAR(s.v_left_m_s, 0.15, 1e-9);
		if (t_s < 5 || t_s > 7.1)
		{
			EXPECT_NEAR(s.v_right_m_s, 0.15, 1e-9);
		}
		excess_m += (s.v_right_m_s - 0.15) / 20;
	}
	EXPECT_NEAR(excess_m, 0.3 * 0.15 * 2, 1e-6);
	options.slips = {1, 2, 3};
	EXPECT_THROW(WheelModel(motion, options, 1), Error);
	options.slips = {1, 2, 0.3, 2};
	EXPECT_THROW(WheelModel(motion, options, 1), Error);
}

TEST(WheelModel, SilenceLosesReadingsButNoTravel)
{
	const Motion motion(routeOf("straight 3 m", true, false));
	WheelOptions options = WheelOptions::perfect();
	const WheelModel full(motion, options, 1);
	options.silences = {5, 5};
	const WheelModel gap(motion, options, 1);
	EXPECT_EQ(gap.readings().size() + 100, full.readings().size());
	EXPECT_EQ(gap.readings().back().ticks_left, full.readings().back().ticks_left);
	for (const WheelReading& r : gap.readings()) EXPECT_NEAR(r.mean_twist.v_m_s, 0.15, 1e-9);
}

TEST(WheelModel, IntrinsicsAreThoseOfTheRigOrDrawnFromTheSeed)
{
	const Motion motion(routeOf("straight 0.5 m"));
	WheelOptions options;
	EXPECT_EQ(WheelModel(motion, options, 1).actual().k_left, WheelModel(motion, options, 2).actual().k_left);
	options.radius_error = options.left_right_difference = options.track_error = 0;
	options.radius_deviation = options.left_right_deviation = options.track_deviation = 0.01;
	double k = 0, track = 0;
	const int runs = 400;
	for (int seed = 0; seed < runs; ++seed)
	{
		const WheelIntrinsics actual = WheelModel(motion, options, static_cast<uint64_t>(seed)).actual();
		k += std::pow(0.5 * (actual.k_left + actual.k_right) - 1, 2) / runs;
		track += std::pow(actual.track_m / 0.23 - 1, 2) / runs;
	}
	EXPECT_NEAR(std::sqrt(k), 0.01, 0.0015);
	EXPECT_NEAR(std::sqrt(track), 0.01, 0.0015);
}
}  // namespace
}  // namespace viwo::sim
