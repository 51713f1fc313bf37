#include "PlanarPath.h"

#include <viwo/core/Error.h>

#include <cmath>
#include <string>

namespace viwo::sim
{
namespace
{
using Kind = RouteSegment::Kind;

/** Between nodes the speeds are analytic, so five Gauss points over this span leave less than rounding. */
constexpr double kNodeSpan_s = 0.05;

/** A day, as that of duration_s. */
constexpr double kLongest_s = 86400;

bool translates(Kind kind)
{
	return kind == Kind::straight || kind == Kind::arc;
}

/** Sum of a sin(2 pi t / period), its derivatives and its integral from 0. */
struct SineSum
{
	double f = 0, d = 0, dd = 0, integral = 0;

	SineSum(const std::vector<double>& amplitudes, const std::vector<double>& periods_s, double t_s)
	{
		for (size_t i = 0; i < amplitudes.size(); ++i)
		{
			const double k = 2 * M_PI / periods_s[i], s = std::sin(k * t_s), c = std::cos(k * t_s);
			f += amplitudes[i] * s;
			d += amplitudes[i] * k * c;
			dd -= amplitudes[i] * k * k * s;
			integral += amplitudes[i] * (1 - c) / k;
		}
	}
};

void requireFit(double hold_s, const char* what)
{
	if (hold_s < 0)
		throw Error(std::string("[route] segments: a ") + what +
		            " is too short to reach its speed and to brake; lengthen it or raise the acceleration");
}

void requireSines(const std::vector<double>& amplitudes, const std::vector<double>& periods_s, const char* key)
{
	if (amplitudes.size() != periods_s.size()) throw Error(std::string("[route] ") + key + ": give as many periods as amplitudes");
	for (const double p : periods_s)
		if (!(p > 0)) throw Error(std::string("[route] ") + key + ": periods must be positive");
}
}  // namespace

PlanarPath::PlanarPath(const Route& route) : route_(route), end_yaw_rad_(route.start_yaw_deg * M_PI / 180)
{
	requireSines(route.free_speed_amplitudes, route.free_speed_periods_s, "free_speed_periods_s");
	requireSines(route.free_yaw_rate_amplitudes_rad_s, route.free_yaw_rate_periods_s, "free_yaw_rate_periods_s");
	nodes_.push_back({0, route.start_x_m, route.start_y_m});
	const std::vector<RouteSegment> segments = route.parsedSegments();
	double v_in_m_s = route.initial_speed ? fullSpeed(segments.front()) : 0;
	for (size_t i = 0; i < segments.size(); ++i)
	{
		const bool first = i == 0, last = i + 1 == segments.size();
		double v_out_m_s = 0;
		if (last && !route.final_stop)
			v_out_m_s = fullSpeed(segments[i]);
		else if (!last && translates(segments[i].kind) && translates(segments[i + 1].kind))
			v_out_m_s = std::min(fullSpeed(segments[i]), fullSpeed(segments[i + 1]));
		append(makeLeg(segments[i], v_in_m_s, v_out_m_s, first && route.initial_speed, last && !route.final_stop));
		v_in_m_s = v_out_m_s;
	}
	duration_s_ = route.duration_s > 0 ? std::min(route.duration_s, end_s_) : end_s_;
	if (!(duration_s_ > 0)) throw Error("[route] segments: the route takes no time; give it a length");
}

double PlanarPath::fullSpeed(const RouteSegment& segment) const
{
	if (segment.kind == Kind::straight) return route_.speed_m_s;
	if (segment.kind == Kind::arc) return std::min(route_.speed_m_s, route_.yaw_rate_rad_s * segment.radius_m);
	return 0;
}

PlanarPath::Leg PlanarPath::makeLeg(const RouteSegment& segment, double v_in_m_s, double v_out_m_s, bool in_motion_at_begin,
                                    bool in_motion_at_end) const
{
	Leg leg;
	leg.segment = segment;
	leg.v_m_s = fullSpeed(segment);
	switch (segment.kind)
	{
		case Kind::straight:
			fitStraight(leg, v_in_m_s, v_out_m_s);
			break;
		case Kind::rotate:
		case Kind::arc:
			fitTurn(leg, v_in_m_s, v_out_m_s, in_motion_at_begin, in_motion_at_end);
			break;
		case Kind::stand:
			leg.v_ramp.hold_s = leg.w_ramp.hold_s = segment.duration_s;
			break;
		case Kind::free:
			fitFree(leg, in_motion_at_begin, in_motion_at_end);
			break;
	}
	return leg;
}

void PlanarPath::fitStraight(Leg& leg, double v_in_m_s, double v_out_m_s) const
{
	const double per_speed_s = SpeedRamp::kPeakSlope / route_.acceleration_m_s2;
	if (v_in_m_s == 0 && v_out_m_s == 0) leg.v_m_s = std::min(leg.v_m_s, std::sqrt(leg.segment.length_m / per_speed_s));
	if (leg.v_m_s == 0) return;
	SpeedRamp& ramp = leg.v_ramp;
	ramp.from = v_in_m_s / leg.v_m_s;
	ramp.to = v_out_m_s / leg.v_m_s;
	ramp.up_s = per_speed_s * (leg.v_m_s - v_in_m_s);
	ramp.down_s = per_speed_s * (leg.v_m_s - v_out_m_s);
	ramp.hold_s = leg.segment.length_m / leg.v_m_s - ramp.integral();
	if (ramp.hold_s > -1e-9) ramp.hold_s = std::max(0.0, ramp.hold_s);
	requireFit(ramp.hold_s, "straight");
	leg.w_ramp.hold_s = ramp.duration_s();
}

void PlanarPath::fitTurn(Leg& leg, double v_in_m_s, double v_out_m_s, bool in_motion_at_begin, bool in_motion_at_end) const
{
	const double angle_rad = std::abs(leg.segment.angle_rad);
	double w_rad_s = leg.segment.kind == Kind::arc ? leg.v_m_s / leg.segment.radius_m : route_.yaw_rate_rad_s;
	SpeedRamp &v = leg.v_ramp, &w = leg.w_ramp;
	w.from = in_motion_at_begin ? 1 : 0;
	w.to = in_motion_at_end ? 1 : 0;
	v.from = leg.v_m_s > 0 ? v_in_m_s / leg.v_m_s : w.from;
	v.to = leg.v_m_s > 0 ? v_out_m_s / leg.v_m_s : w.to;
	const auto rampTime = [&](double v_change, double w_change)
	{
		return SpeedRamp::kPeakSlope *
		       std::max(leg.v_m_s * v_change / route_.acceleration_m_s2, w_rad_s * w_change / route_.yaw_acceleration_rad_s2);
	};
	w.up_s = rampTime(1 - v.from, 1 - w.from);
	w.down_s = rampTime(1 - v.to, 1 - w.to);
	const double ramps_rad = w_rad_s * w.integral();
	w.hold_s = (angle_rad - ramps_rad) / w_rad_s;
	if (w.hold_s < 0 && v.from == 0 && v.to == 0 && w.from == 0 && w.to == 0)
	{
		// From rest to rest: lower both speeds by one factor until the ramps alone make the angle.
		const double factor = std::sqrt(angle_rad / ramps_rad);
		leg.v_m_s *= factor;
		w_rad_s *= factor;
		w.up_s *= factor;
		w.down_s *= factor;
		w.hold_s = 0;
	}
	requireFit(w.hold_s, leg.segment.kind == Kind::arc ? "arc" : "rotation");
	v.up_s = w.up_s;
	v.hold_s = w.hold_s;
	v.down_s = w.down_s;
	leg.w_rad_s = std::copysign(w_rad_s, leg.segment.angle_rad);
}

void PlanarPath::fitFree(Leg& leg, bool in_motion_at_begin, bool in_motion_at_end) const
{
	double v_peak = 1, w_peak = std::abs(route_.free_yaw_rate_mean_rad_s);
	for (const double a : route_.free_speed_amplitudes) v_peak += std::abs(a);
	for (const double a : route_.free_yaw_rate_amplitudes_rad_s) w_peak += std::abs(a);
	const double ramp_s =
	    SpeedRamp::kPeakSlope * std::max(route_.speed_m_s * v_peak / route_.acceleration_m_s2, w_peak / route_.yaw_acceleration_rad_s2);
	SpeedRamp& ramp = leg.v_ramp;
	ramp.from = in_motion_at_begin ? 1 : 0;
	ramp.to = in_motion_at_end ? 1 : 0;
	ramp.up_s = in_motion_at_begin ? 0 : ramp_s;
	ramp.down_s = in_motion_at_end ? 0 : ramp_s;
	ramp.hold_s = leg.segment.duration_s - ramp.up_s - ramp.down_s;
	requireFit(ramp.hold_s, "free motion");
	leg.w_ramp = ramp;
	leg.v_m_s = route_.speed_m_s;
}

void PlanarPath::append(Leg leg)
{
	const SpeedRamp ramp = leg.segment.kind == Kind::straight ? leg.v_ramp : leg.w_ramp;
	if (ramp.duration_s() <= 0) return;
	leg.begin_s = end_s_;
	leg.yaw_begin_rad = end_yaw_rad_;
	const double ramp_end_s = end_s_ + ramp.up_s, hold_end_s = ramp_end_s + ramp.hold_s, leg_end_s = end_s_ + ramp.duration_s();
	if (leg_end_s > kLongest_s)
		throw Error("[route] segments: the route takes " + std::to_string(std::llround(leg_end_s)) + " s and more; at most " +
		            std::to_string(std::llround(kLongest_s)) + " s are simulated");
	integratePlace(leg, end_s_, ramp_end_s);
	integratePlace(leg, ramp_end_s, hold_end_s);
	integratePlace(leg, hold_end_s, leg_end_s);
	end_yaw_rad_ = speedsAt(leg, leg_end_s).yaw_rad;
	end_s_ = leg_end_s;
	legs_.push_back(std::move(leg));
}

void PlanarPath::integratePlace(const Leg& leg, double begin_s, double end_s)
{
	if (end_s <= begin_s) return;
	const int steps = leg.v_m_s > 0 ? static_cast<int>(std::ceil((end_s - begin_s) / kNodeSpan_s)) : 1;
	for (int i = 0; i < steps; ++i)
	{
		Node next = nodes_.back();
		const double step_begin_s = next.t_s;
		next.t_s = i + 1 == steps ? end_s : begin_s + (end_s - begin_s) * (i + 1) / steps;
		advance(leg, step_begin_s, next.t_s, next.x_m, next.y_m);
		nodes_.push_back(next);
	}
}

void PlanarPath::advance(const Leg& leg, double begin_s, double end_s, double& x_m, double& y_m) const
{
	if (leg.v_m_s == 0) return;
	static constexpr double kNodes[] = {0, 0.5384693101056831, 0.9061798459386640};
	static constexpr double kWeights[] = {0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
	const double middle_s = 0.5 * (begin_s + end_s), half_s = 0.5 * (end_s - begin_s);
	for (int i = -2; i <= 2; ++i)
	{
		const int k = std::abs(i);
		const PlanarState s = speedsAt(leg, middle_s + half_s * (i < 0 ? -kNodes[k] : kNodes[k]));
		x_m += half_s * kWeights[k] * s.v * std::cos(s.yaw_rad);
		y_m += half_s * kWeights[k] * s.v * std::sin(s.yaw_rad);
	}
}

PlanarState PlanarPath::speedsAt(const Leg& leg, double t_s) const
{
	PlanarState state;
	const double local_s = t_s - leg.begin_s;
	if (leg.segment.kind == Kind::free)
	{
		freeSpeedsAt(leg, local_s, state);
		return state;
	}
	const SpeedRamp::Value v = leg.v_ramp.at(local_s), w = leg.w_ramp.at(local_s);
	state.v = leg.v_m_s * v.f;
	state.dv = leg.v_m_s * v.d;
	state.ddv = leg.v_m_s * v.dd;
	state.w = leg.w_rad_s * w.f;
	state.dw = leg.w_rad_s * w.d;
	state.ddw = leg.w_rad_s * w.dd;
	state.yaw_rad = leg.yaw_begin_rad + leg.w_rad_s * w.integral;
	return state;
}

void PlanarPath::freeSpeedsAt(const Leg& leg, double local_s, PlanarState& state) const
{
	// The ramps slow down time itself, so that the heading stays closed-form: v = tau' v_f(tau).
	const SpeedRamp::Value tau = leg.v_ramp.at(local_s);
	const double s = tau.f, s1 = tau.d, s2 = tau.dd;
	const SineSum v(route_.free_speed_amplitudes, route_.free_speed_periods_s, tau.integral);
	const SineSum w(route_.free_yaw_rate_amplitudes_rad_s, route_.free_yaw_rate_periods_s, tau.integral);
	const double mean_w = route_.free_yaw_rate_mean_rad_s;
	state.v = leg.v_m_s * s * (1 + v.f);
	state.dv = leg.v_m_s * (s1 * (1 + v.f) + s * s * v.d);
	state.ddv = leg.v_m_s * (s2 * (1 + v.f) + 3 * s * s1 * v.d + s * s * s * v.dd);
	state.w = s * (mean_w + w.f);
	state.dw = s1 * (mean_w + w.f) + s * s * w.d;
	state.ddw = s2 * (mean_w + w.f) + 3 * s * s1 * w.d + s * s * s * w.dd;
	state.yaw_rad = leg.yaw_begin_rad + mean_w * tau.integral + w.integral;
}

PlanarState PlanarPath::at(double t_s) const
{
	t_s = std::clamp(t_s, 0.0, duration_s_);
	const auto leg_after = std::upper_bound(legs_.begin(), legs_.end(), t_s, [](double t, const Leg& leg) { return t < leg.begin_s; });
	const Leg& leg = *std::prev(leg_after);
	const auto node_after = std::upper_bound(nodes_.begin(), nodes_.end(), t_s, [](double t, const Node& node) { return t < node.t_s; });
	const Node& node = *std::prev(node_after);
	PlanarState state = speedsAt(leg, t_s);
	state.x_m = node.x_m;
	state.y_m = node.y_m;
	advance(leg, node.t_s, t_s, state.x_m, state.y_m);
	return state;
}
}  // namespace viwo::sim
