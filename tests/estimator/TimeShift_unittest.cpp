#include <SampleBuffer.h>
#include <StateOrder.h>
#include <TimeShift.h>
#include <gtest/gtest.h>

#include <iostream>
#include <random>

#include "ImuMotion.h"

namespace viwo
{
namespace
{
constexpr int64_t ms = 1'000'000;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/** Change of the deltas when both ends move by shift_ns. */
Eigen::Matrix<double, 9, 1> recutImu(const ImuBuffer& buffer, int64_t begin_ns, int64_t end_ns, int64_t shift_ns)
{
	const Eigen::Vector3d b_a(0.03, -0.02, 0.05), b_g(0.004, -0.002, 0.003);
	const auto at = [&](int64_t s) { return test::preintegrated(buffer, begin_ns + s, end_ns + s, {}, b_a, b_g).delta(); };
	return test::difference(at(shift_ns), at(0));
}

WheelPreintegration cutWheels(const WheelBuffer& buffer, int64_t begin_ns, int64_t end_ns)
{
	WheelPreintegration result({}, {1.01, 0.99, 0.24});
	const std::vector<WheelSegment> segments = buffer.segments(begin_ns, end_ns, 1).value();
	for (const WheelSegment& s : segments) result.integrate(s);
	return result;
}

/** Speeds that change from sample to sample. */
WheelBuffer livelyWheels()
{
	WheelBuffer buffer;
	for (int i = 0; i < 40; ++i) buffer.add({i * 50 * ms, 0.3 + 0.1 * std::sin(i), 0.25 + 0.12 * std::cos(1.3 * i)});
	return buffer;
}
/** With the wheels' own speeds, which here have no noise. */
WheelTimeShift::Jacobian exactShift(const WheelPreintegration& interval)
{
	const auto twistAt = [&](const WheelSegment& s)
	{
		const WheelTwist twist = twistOf({0, s.v_left_m_s, s.v_right_m_s}, interval.intrinsics());
		return OdometerTwist{{twist.v_m_s, 0, 0}, {0, 0, twist.w_rad_s}};
	};
	return shiftJacobian(interval, twistAt(interval.segments().front()), twistAt(interval.segments().back()));
}
}  // namespace

TEST(TimeShift, OfTheImuIsWhatCuttingElsewhereGives)
{
	const ImuBuffer buffer = test::sampled(test::ImuMotion(), ms / 2, 2500 * ms);
	const Eigen::Vector3d b_a(0.03, -0.02, 0.05), b_g(0.004, -0.002, 0.003);
	for (const int64_t end_ns : {600 * ms, 1500 * ms})
	{
		const auto J = shiftJacobian(test::preintegrated(buffer, 500 * ms, end_ns, {}, b_a, b_g));
		const auto error = [&](int64_t shift_ns)
		{ return (recutImu(buffer, 500 * ms, end_ns, shift_ns) - secondsBetween(0, shift_ns) * J).segment<3>(StateOrder::phi).norm(); };
		std::cout << "[measured] shift of an IMU interval of " << (end_ns - 500 * ms) / ms << " ms: " << J.norm()
		          << " rad per s; cut again 2 ms later it is off by " << error(2 * ms) << ", 1 ms by " << error(ms) << "\n";
		EXPECT_LT(error(ms), 0.02 * 1e-3 * J.norm());
		EXPECT_NEAR(error(2 * ms) / error(ms), 4, 0.3);
	}
}

TEST(TimeShift, OfTheWheelsIsWhatCuttingElsewhereGives)
{
	const WheelBuffer buffer = livelyWheels();
	const int64_t begin_ns = 520 * ms, end_ns = 1220 * ms;
	const WheelPreintegration interval = cutWheels(buffer, begin_ns, end_ns);
	const Vector6 J = exactShift(interval);
	const auto error = [&](int64_t shift_ns)
	{
		const WheelPreintegration moved = cutWheels(buffer, begin_ns + shift_ns, end_ns + shift_ns);
		Vector6 change;
		change << moved.dp() - interval.dp(), so3::log(Eigen::Quaterniond(interval.dR().conjugate() * moved.dR()));
		return (change - secondsBetween(0, shift_ns) * J).norm();
	};
	std::cout << "[measured] shift of a wheel interval: " << J.norm() << " (m, rad) per s; cut again 10 ms later it is off by "
	          << error(10 * ms) << ", 5 ms by " << error(5 * ms) << "\n";
	EXPECT_LT(error(5 * ms), 0.03 * 5e-3 * J.norm());
	EXPECT_NEAR(error(10 * ms) / error(5 * ms), 4, 0.3);
}

TEST(TimeShift, IsZeroAtConstantTwist)
{
	ImuBuffer imu;
	WheelBuffer wheels;
	const Eigen::Vector3d w(0.02, -0.01, 0.4), f(0.1, 0.2, 9.8);
	for (int i = 0; i <= 400; ++i) imu.add({i * 5 * ms, so3::exp(w * (-0.005 * i)) * f, w});
	for (int i = 0; i <= 40; ++i) wheels.add({i * 50 * ms, 0.2, 0.3});
	const ImuPreintegration interval = test::preintegrated(imu, 503 * ms, 1203 * ms);
	const auto J = shiftJacobian(interval);
	std::cout << "[measured] shift at constant twist: rotation " << J.segment<3>(3).norm() << " rad/s, wheels "
	          << exactShift(cutWheels(wheels, 503 * ms, 1203 * ms)).norm() << "\n";
	EXPECT_LT(J.segment<3>(3).norm(), 1e-12);
	EXPECT_LT(exactShift(cutWheels(wheels, 503 * ms, 1203 * ms)).norm(), 1e-12);
}

TEST(TimeShift, NoiseAloneTellsNothing)
{
	std::mt19937_64 engine(5);
	std::normal_distribution<double> normal;
	const auto noise = [&](double sigma)
	{ return Eigen::Vector3d(sigma * normal(engine), sigma * normal(engine), sigma * normal(engine)); };
	ImuBuffer straight, turning;
	for (int i = 0; i < 20000; ++i)
	{
		const Eigen::Vector3d g_up(0, 0, 9.81);
		const double begins_to_turn = 0.15 * std::clamp((i * 0.005 - 50) / 0.375, 0.0, 1.0);
		straight.add({i * 5 * ms, g_up + noise(0.028), noise(0.0028)});
		turning.add({i * 5 * ms, g_up + noise(0.028), noise(0.0028) + Eigen::Vector3d(0, 0, begins_to_turn)});
	}
	int false_alarms = 0, intervals = 0, seen = 0;
	for (int64_t t = 100 * ms; t < 99'000 * ms; t += 100 * ms, ++intervals)
		if (!significantShiftJacobian(test::preintegrated(straight, t, t + 97 * ms)).isZero(0)) ++false_alarms;
	for (int64_t t = 50'000 * ms; t < 50'300 * ms; t += 100 * ms)
		if (!significantShiftJacobian(test::preintegrated(turning, t, t + 100 * ms)).segment<3>(3).isZero(0)) ++seen;
	std::cout << "[measured] intervals of noise taken for motion: " << false_alarms << " of " << intervals << "; of a turn that begins "
	          << seen << " of 3\n";
	EXPECT_LE(false_alarms, 2);
	EXPECT_EQ(seen, 3);
}
}  // namespace viwo
