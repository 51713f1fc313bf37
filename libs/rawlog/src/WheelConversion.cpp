#include "WheelConversion.h"

#include <viwo/core/Time.h>

#include <cmath>

namespace viwo
{
namespace
{
using mrpt::obs::CObservationOdometry;
using Source = AdapterOptions::OdometrySource;

/** Wheel travel since the previous reading, m. */
struct WheelTravel
{
	double left_m = 0;
	double right_m = 0;
};

WheelTravel travelOfTicks(const EncoderTicks& before, const EncoderTicks& after, const AdapterOptions& options)
{
	const double scale_m = options.metresPerTick();
	return {(options.left_inverted ? -scale_m : scale_m) * wrappingDifference(after.left, before.left),
	        (options.right_inverted ? -scale_m : scale_m) * wrappingDifference(after.right, before.right)};
}

/** Of the arc that joins two poses of odometry. */
WheelTravel travelOfPoses(const OdometryReading& before, const OdometryReading& after, const AdapterOptions& options)
{
	const double dx_m = after.x_m - before.x_m, dy_m = after.y_m - before.y_m;
	const double half_yaw = 0.5 * std::remainder(after.yaw_rad - before.yaw_rad, 2 * M_PI);
	const double chord_yaw = before.yaw_rad + half_yaw;
	const double chord_m = dx_m * std::cos(chord_yaw) + dy_m * std::sin(chord_yaw);
	const double arc_m = std::abs(half_yaw) < 1e-9 ? chord_m : chord_m * half_yaw / std::sin(half_yaw);
	return {arc_m - options.track_m * half_yaw, arc_m + options.track_m * half_yaw};
}
}  // namespace

bool hasSource(const CObservationOdometry& odometry, Source source)
{
	switch (source)
	{
		case Source::velocity:
			return odometry.hasVelocities;
		case Source::ticks_absolute:
		case Source::ticks_increment:
			return odometry.hasEncodersInfo;
		case Source::pose:
			return true;
	}
	return false;
}

std::string describeSources(const CObservationOdometry& odometry)
{
	std::string text;
	if (odometry.hasVelocities) text += "velocity, ";
	if (odometry.hasEncodersInfo) text += "ticks_absolute or ticks_increment, ";
	return text + "pose";
}

bool isFinite(const CObservationOdometry& odometry, Source source)
{
	const auto& p = odometry.odometry;
	const auto& v = odometry.velocityLocal;
	if (source == Source::pose) return std::isfinite(p.x()) && std::isfinite(p.y()) && std::isfinite(p.phi());
	return source != Source::velocity || (std::isfinite(v.vx) && std::isfinite(v.omega));
}

std::optional<WheelSample> wheelSampleFrom(const OdometryReading* previous, const OdometryReading& current, const AdapterOptions& options)
{
	if (options.odometry_source == Source::velocity)
	{
		WheelTwist twist = current.twist;
		if (options.velocity_meaning == AdapterOptions::VelocityMeaning::instantaneous && previous)
		{
			twist.v_m_s = 0.5 * (twist.v_m_s + previous->twist.v_m_s);
			twist.w_rad_s = 0.5 * (twist.w_rad_s + previous->twist.w_rad_s);
		}
		return wheelSampleFromTwist(current.t_ns, twist, options.track_m);
	}
	if (!previous) return std::nullopt;
	const double dt_s = secondsBetween(previous->t_ns, current.t_ns);
	const WheelTravel travel = options.odometry_source == Source::pose ? travelOfPoses(*previous, current, options)
	                                                                   : travelOfTicks(previous->ticks, current.ticks, options);
	return WheelSample{current.t_ns, travel.left_m / dt_s, travel.right_m / dt_s};
}
}  // namespace viwo
