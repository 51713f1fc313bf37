#include "WheelConversion.h"

#include <viwo/core/Time.h>
#include <viwo/rawlog/MrptTime.h>

#include <cmath>

namespace viwo
{
namespace
{
using mrpt::obs::CObservationOdometry;
using Source = AdapterOptions::OdometrySource;

/** Encoder registers wrap around. */
double tickDifference(int32_t before, int32_t after)
{
	return static_cast<int32_t>(static_cast<uint32_t>(after) - static_cast<uint32_t>(before));
}

/** Wheel travel since the previous reading, m. */
struct WheelTravel
{
	double left_m = 0;
	double right_m = 0;
};

WheelTravel travelOfTicks(double left_ticks, double right_ticks, const AdapterOptions& options)
{
	const double scale = options.metresPerTick();
	return {(options.left_inverted ? -scale : scale) * left_ticks, (options.right_inverted ? -scale : scale) * right_ticks};
}

/** Of the arc that joins two poses of odometry. */
WheelTravel travelOfPoses(const mrpt::poses::CPose2D& before, const mrpt::poses::CPose2D& after, const AdapterOptions& options)
{
	const mrpt::poses::CPose2D step = after - before;
	const double half_yaw = 0.5 * step.phi();
	const double chord_m = step.x() * std::cos(half_yaw) + step.y() * std::sin(half_yaw);
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

bool isFinite(const CObservationOdometry& odometry)
{
	const auto& p = odometry.odometry;
	const auto& v = odometry.velocityLocal;
	const bool pose_is_finite = std::isfinite(p.x()) && std::isfinite(p.y()) && std::isfinite(p.phi());
	return pose_is_finite && (!odometry.hasVelocities || (std::isfinite(v.vx) && std::isfinite(v.omega)));
}

std::optional<WheelSample> wheelSampleFrom(const CObservationOdometry* previous, const CObservationOdometry& current,
                                           const AdapterOptions& options)
{
	const int64_t t_ns = nanosecondsOf(current.timestamp) + nanoseconds(options.wheel_time_offset_s);
	if (options.odometry_source == Source::velocity)
	{
		WheelTwist twist{current.velocityLocal.vx, current.velocityLocal.omega};
		if (options.velocity_meaning == AdapterOptions::VelocityMeaning::instantaneous && previous)
		{
			twist.v_m_s = 0.5 * (twist.v_m_s + previous->velocityLocal.vx);
			twist.w_rad_s = 0.5 * (twist.w_rad_s + previous->velocityLocal.omega);
		}
		return wheelSampleFromTwist(t_ns, twist, options.track_m);
	}
	if (!previous) return std::nullopt;
	const double dt_s = secondsBetween(nanosecondsOf(previous->timestamp), nanosecondsOf(current.timestamp));
	WheelTravel travel;
	if (options.odometry_source == Source::pose)
		travel = travelOfPoses(previous->odometry, current.odometry, options);
	else if (options.odometry_source == Source::ticks_increment)
		travel = travelOfTicks(current.encoderLeftTicks, current.encoderRightTicks, options);
	else
		travel = travelOfTicks(tickDifference(previous->encoderLeftTicks, current.encoderLeftTicks),
		                       tickDifference(previous->encoderRightTicks, current.encoderRightTicks), options);
	return WheelSample{t_ns, travel.left_m / dt_s, travel.right_m / dt_s};
}
}  // namespace viwo
