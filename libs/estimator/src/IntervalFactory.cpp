#include "IntervalFactory.h"

#include "ImuPreintegration.h"
#include "WheelPreintegration.h"
#include "Window.h"

namespace viwo
{
namespace
{
// Beyond these the neglected second order of the correction is no longer small against the noise of a three-second interval.
constexpr double kGyroBiasMove_rad_s = 2e-3;
constexpr double kAccBiasMove_m_s2 = 0.05;
constexpr double kWheelMove = 2e-3;  // relative

void countOnce(bool is_gap, bool& in_gap, int& gaps)
{
	if (is_gap && !in_gap) ++gaps;
	in_gap = is_gap;
}
}  // namespace

IntervalFactory::IntervalFactory(const EstimatorOptions& options, const WheelIntrinsics& nominal) : options_(options), wheels_(nominal) {}

Interval IntervalFactory::between(const ImuBuffer& imu, const WheelBuffer& wheels, int64_t t_begin_ns, int64_t t_end_ns)
{
	Interval interval;
	if (options_.useImu())
	{
		auto span = imu.span(t_begin_ns, t_end_ns, options_.window.max_imu_gap_s);
		countOnce(!span, in_imu_gap_, imu_gaps_);
		if (!span) span = imu.span(t_begin_ns, t_end_ns, options_.window.reinitialize_after_gap_s);
		if (span)
		{
			interval.imu = std::make_shared<ImuPreintegration>(options_.noise.imu, b_a_, b_g_);
			interval.imu->integrate(*span);
		}
	}
	if (options_.useWheels())
	{
		const auto segments = wheels.segments(t_begin_ns, t_end_ns, options_.window.max_wheel_gap_s);
		countOnce(!segments, in_wheel_gap_, wheel_gaps_);
		if (segments)
		{
			interval.wheels = std::make_shared<WheelPreintegration>(options_.noise.wheels, wheels_);
			for (const WheelSegment& segment : *segments) interval.wheels->integrate(segment);
		}
	}
	return interval;
}

void IntervalFactory::relinearize(Window& window)
{
	const NavState state = window.latest().state();
	if ((state.b_g - b_g_).norm() > kGyroBiasMove_rad_s || (state.b_a - b_a_).norm() > kAccBiasMove_m_s2)
		relinearizeAt(window, state.b_a, state.b_g);

	const WheelIntrinsics k = window.wheelIntrinsics();
	const double moved =
	    std::abs(k.k_left - wheels_.k_left) + std::abs(k.k_right - wheels_.k_right) + std::abs(k.track_m / wheels_.track_m - 1);
	if (moved <= kWheelMove) return;
	wheels_ = k;
	for (auto& frame : window.frames)
		if (frame->interval.wheels)
		{
			frame->interval.wheels->repropagate(k);
			frame->wheel_factor.reset();
		}
}

void IntervalFactory::beginAt(const Belief& belief)
{
	b_a_ = belief.b_a;
	b_g_ = belief.b_g;
	wheels_ = belief.wheels;
}

void IntervalFactory::relinearizeAt(Window& window, const Eigen::Vector3d& b_a, const Eigen::Vector3d& b_g)
{
	b_a_ = b_a;
	b_g_ = b_g;
	for (auto& frame : window.frames)
		if (frame->interval.imu)
		{
			frame->interval.imu->repropagate(b_a, b_g);
			frame->imu_factor.reset();
		}
}
}  // namespace viwo
