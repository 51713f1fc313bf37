#include "IntervalFactory.h"

#include "ImuPreintegration.h"
#include "WheelPreintegration.h"
#include "Window.h"

#include <viwo/core/Time.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace viwo
{
namespace
{
// Beyond these the neglected second order of the correction is no longer small against the noise of a three-second interval.
constexpr double kGyroBiasMove_rad_s = 2e-3;
constexpr double kAccBiasMove_m_s2 = 0.05;
constexpr double kWheelMove = 2e-3;  // relative
constexpr double kOffsetMove_s = 1e-3;

void countOnce(bool is_gap, bool& in_gap, int& gaps)
{
	if (is_gap && !in_gap) ++gaps;
	in_gap = is_gap;
}

/** How far the wheels are trusted was judged when their samples came, and holds for these, however they are cut. */
class TrustOverTime
{
   public:
	explicit TrustOverTime(const Window& window)
	{
		for (size_t i = 1; i < window.frames.size(); ++i)
		{
			const Interval& interval = window.frames[i]->interval;
			if (!interval.wheels) continue;
			int64_t t_ns = interval.cut_at.wheelTime(window.frames[i - 1]->t_ns);
			for (const WheelSegment& s : interval.wheels->segments()) pieces_.push_back({t_ns += nanoseconds(s.dt_s), s.variance_scale});
		}
	}

	void apply(int64_t t_begin_ns, WheelPreintegration& wheels) const
	{
		std::vector<double> scales;
		for (const WheelSegment& s : wheels.segments())
		{
			const bool rolls = s.v_left_m_s != 0 || s.v_right_m_s != 0;
			const double scale = scaleAt(t_begin_ns + nanoseconds(0.5 * s.dt_s));
			// What comes in from beyond the ends, and moves, has not stood.
			scales.push_back(rolls ? std::max(1.0, scale) : scale);
			t_begin_ns += nanoseconds(s.dt_s);
		}
		wheels.setVarianceScales(scales);
	}

   private:
	struct Piece
	{
		int64_t end_ns;
		double variance_scale;
	};
	double scaleAt(int64_t t_ns) const
	{
		const auto piece = std::lower_bound(pieces_.begin(), pieces_.end(), t_ns, [](const Piece& p, int64_t t) { return p.end_ns < t; });
		if (pieces_.empty()) return 1;
		return piece == pieces_.end() ? pieces_.back().variance_scale : piece->variance_scale;
	}

	std::vector<Piece> pieces_;  //!< in the wheels' clock, rising
};
}  // namespace

IntervalFactory::IntervalFactory(const EstimatorOptions& options, const WheelIntrinsics& nominal) : options_(options), wheels_(nominal) {}

Interval IntervalFactory::between(const ImuBuffer& imu, const WheelBuffer& wheels, int64_t t_begin_ns, int64_t t_end_ns)
{
	Interval interval;
	interval.cut_at = offsets_;
	if (options_.useImu())
	{
		interval.imu = cutImu(imu, t_begin_ns, t_end_ns, options_.window.max_imu_gap_s);
		countOnce(!interval.imu, in_imu_gap_, imu_gaps_);
		if (!interval.imu) interval.imu = cutImu(imu, t_begin_ns, t_end_ns, options_.window.reinitialize_after_gap_s);
	}
	if (options_.useWheels())
	{
		interval.wheels = cutWheels(wheels, t_begin_ns, t_end_ns);
		countOnce(!interval.wheels, in_wheel_gap_, wheel_gaps_);
	}
	return interval;
}

std::shared_ptr<ImuPreintegration> IntervalFactory::cutImu(const ImuBuffer& imu, int64_t t_begin_ns, int64_t t_end_ns,
                                                           double max_gap_s) const
{
	const auto span = imu.span(offsets_.imuTime(t_begin_ns), offsets_.imuTime(t_end_ns), max_gap_s);
	if (!span) return nullptr;
	auto interval = std::make_shared<ImuPreintegration>(options_.noise.imu, b_a_, b_g_);
	interval->integrate(*span);
	return interval;
}

std::shared_ptr<WheelPreintegration> IntervalFactory::cutWheels(const WheelBuffer& wheels, int64_t t_begin_ns, int64_t t_end_ns) const
{
	const auto segments = wheels.segments(offsets_.wheelTime(t_begin_ns), offsets_.wheelTime(t_end_ns), options_.window.max_wheel_gap_s);
	if (!segments) return nullptr;
	auto interval = std::make_shared<WheelPreintegration>(options_.noise.wheels, wheels_);
	for (const WheelSegment& segment : *segments) interval->integrate(segment);
	return interval;
}

void IntervalFactory::recut(Window& window, const ImuBuffer& imu, const WheelBuffer& wheels)
{
	const ClockOffsets before = std::exchange(offsets_, window.offsets());
	if (std::max(std::abs(offsets_.t_d_s - before.t_d_s), std::abs(offsets_.t_w_s - before.t_w_s)) <= kOffsetMove_s)
	{
		offsets_ = before;
		return;
	}
	const TrustOverTime trust(window);
	std::vector<Interval> cut(window.frames.size());
	for (size_t i = 1; i < cut.size(); ++i)
	{
		const Interval& old = window.frames[i]->interval;
		const int64_t t_begin_ns = window.frames[i - 1]->t_ns, t_end_ns = window.frames[i]->t_ns;
		cut[i].cut_at = offsets_;
		if (old.imu) cut[i].imu = cutImu(imu, t_begin_ns, t_end_ns, options_.window.reinitialize_after_gap_s);
		if (old.wheels) cut[i].wheels = cutWheels(wheels, t_begin_ns, t_end_ns);
		if (cut[i].wheels) trust.apply(offsets_.wheelTime(t_begin_ns), *cut[i].wheels);
		if (!old.imu == !cut[i].imu) continue;
		offsets_ = before;
		return;
	}
	for (size_t i = 1; i < cut.size(); ++i)
	{
		window.frames[i]->interval = cut[i];
		window.frames[i]->imu_factor.reset();
		window.frames[i]->wheel_factor.reset();
	}
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
	offsets_ = belief.offsets;
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
