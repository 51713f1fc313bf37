#include <viwo/core/Error.h>
#include <viwo/core/Time.h>
#include <viwo/core/TimeText.h>
#include <viwo/rawlog/MrptTime.h>
#include <viwo/rawlog/ObservationAdapter.h>

#include <cmath>

#include "WheelConversion.h"

using namespace mrpt::obs;

namespace viwo
{
namespace
{
AdaptedObservation rejection(Rejection reason)
{
	AdaptedObservation result;
	result.rejected = reason;
	return result;
}

/** The class that stands under a label of the configuration. */
template <class Observation>
const Observation& as(const CObservation& observation, const char* key)
{
	const auto* typed = dynamic_cast<const Observation*>(&observation);
	if (!typed)
		throw Error("observation at " + formatSeconds(nanosecondsOf(observation.timestamp)) + " s under label " + observation.sensorLabel +
		            " is a " + observation.GetRuntimeClass()->className + ", not a " + Observation::GetRuntimeClassIdStatic().className +
		            "; correct " + key + " in the configuration");
	return *typed;
}
}  // namespace

double AdapterOptions::metresPerTick() const
{
	return metres_per_tick > 0 ? metres_per_tick : 2 * M_PI * wheel_radius_m / ticks_per_revolution;
}

const char* nameOf(Rejection reason)
{
	switch (reason)
	{
		case Rejection::not_finite:
			return "not_finite";
		case Rejection::duplicate_stamp:
			return "duplicate_stamp";
		case Rejection::stamp_backwards:
			return "stamp_backwards";
		case Rejection::missing_data:
			return "missing_data";
		case Rejection::too_fast:
			return "too_fast";
		case Rejection::out_of_range:
			return "out_of_range";
		case Rejection::stamp_jump:
			return "stamp_jump";
	}
	return "unknown";
}

std::optional<Rejection> ObservationAdapter::checkStamp(const std::optional<int64_t>& last_t_ns, int64_t t_ns) const
{
	if (!last_t_ns || t_ns > *last_t_ns) return std::nullopt;
	return t_ns == *last_t_ns ? Rejection::duplicate_stamp : Rejection::stamp_backwards;
}

AdaptedObservation ObservationAdapter::convert(const CObservation::Ptr& observation)
{
	const std::string& label = observation->sensorLabel;
	AdaptedObservation result;
	if (label == options_.cam_label)
	{
		as<CObservationImage>(*observation, "cam_label");
		result = convertImage(std::dynamic_pointer_cast<CObservationImage>(observation));
	}
	else if (label == options_.imu_label)
		result = convertImu(as<CObservationIMU>(*observation, "imu_label"));
	else if (label == options_.odometry_label)
		result = convertOdometry(as<CObservationOdometry>(*observation, "odometry_label"));
	else
		return result;

	auto& counts = counts_[label];
	if (result.rejected)
		counts.rejected[nameOf(*result.rejected)]++;
	else
		counts.accepted++;
	return result;
}

AdaptedObservation ObservationAdapter::convertImage(const CObservationImage::Ptr& image)
{
	const int64_t t_ns = nanosecondsOf(image->timestamp) + nanoseconds(options_.camera_time_offset_s);
	if (const auto reason = checkStamp(last_image_t_ns_, t_ns)) return rejection(*reason);
	last_image_t_ns_ = t_ns;
	AdaptedObservation result;
	result.sample = ImageRef(t_ns, image);
	return result;
}

AdaptedObservation ObservationAdapter::convertImu(const CObservationIMU& imu)
{
	for (const auto slot : {IMU_X_ACC, IMU_Y_ACC, IMU_Z_ACC, IMU_WX, IMU_WY, IMU_WZ})
	{
		if (imu.has(slot)) continue;
		if (!last_imu_t_ns_)
			throw Error("IMU observation at " + formatSeconds(nanosecondsOf(imu.timestamp)) + " s under label " + imu.sensorLabel +
			            " has no " + (slot <= IMU_Z_ACC ? "accelerations" : "angular rates") + "; set imu_label to a full IMU");
		return rejection(Rejection::missing_data);
	}
	ImuSample sample;
	sample.t_ns = nanosecondsOf(imu.timestamp);
	sample.acc_m_s2 = {imu.get(IMU_X_ACC), imu.get(IMU_Y_ACC), imu.get(IMU_Z_ACC)};
	sample.gyro_rad_s = {imu.get(IMU_WX), imu.get(IMU_WY), imu.get(IMU_WZ)};
	if (!sample.acc_m_s2.allFinite() || !sample.gyro_rad_s.allFinite()) return rejection(Rejection::not_finite);
	if (sample.acc_m_s2.norm() > options_.max_acc_m_s2 || sample.gyro_rad_s.norm() > options_.max_rate_rad_s)
		return rejection(Rejection::out_of_range);
	if (const auto reason = checkStamp(last_imu_t_ns_, sample.t_ns)) return rejection(*reason);
	last_imu_t_ns_ = sample.t_ns;
	AdaptedObservation result;
	result.sample = sample;
	return result;
}

OdometryReading ObservationAdapter::readingOf(const CObservationOdometry& odometry)
{
	OdometryReading reading;
	reading.t_ns = nanosecondsOf(odometry.timestamp) + nanoseconds(options_.wheel_time_offset_s);
	reading.twist = {odometry.velocityLocal.vx, odometry.velocityLocal.omega};
	reading.ticks = {odometry.encoderLeftTicks, odometry.encoderRightTicks};
	reading.x_m = odometry.odometry.x();
	reading.y_m = odometry.odometry.y();
	reading.yaw_rad = odometry.odometry.phi();
	if (options_.odometry_source == AdapterOptions::OdometrySource::ticks_increment)
	{
		summed_increments_ = {wrappingSum(summed_increments_.left, reading.ticks.left),
		                      wrappingSum(summed_increments_.right, reading.ticks.right)};
		reading.ticks = summed_increments_;
	}
	return reading;
}

AdaptedObservation ObservationAdapter::convertOdometry(const CObservationOdometry& odometry)
{
	const bool is_velocity = options_.odometry_source == AdapterOptions::OdometrySource::velocity;
	if (!hasSource(odometry, options_.odometry_source))
	{
		if (!last_odometry_t_ns_)
			throw Error("odometry at " + formatSeconds(nanosecondsOf(odometry.timestamp)) + " s under label " + odometry.sensorLabel +
			            " has no " + (is_velocity ? "velocities" : "encoder ticks") +
			            "; set odometry_source to what it has: " + describeSources(odometry));
		return rejection(Rejection::missing_data);
	}
	if (!isFinite(odometry, options_.odometry_source)) return rejection(Rejection::not_finite);
	const int64_t t_ns = nanosecondsOf(odometry.timestamp);
	if (const auto reason = checkStamp(last_odometry_t_ns_, t_ns)) return rejection(*reason);
	last_odometry_t_ns_ = t_ns;

	AdaptedObservation result;
	const OdometryReading reading = readingOf(odometry);
	const auto* previous = last_wheel_reading_ ? &*last_wheel_reading_ : nullptr;
	if (!is_velocity && previous && secondsBetween(previous->t_ns, reading.t_ns) < options_.min_wheel_interval_s) return result;
	const auto sample = wheelSampleFrom(previous, reading, options_);
	last_wheel_reading_ = reading;
	if (!sample) return result;
	if (std::max(std::abs(sample->v_left_m_s), std::abs(sample->v_right_m_s)) > options_.max_wheel_speed_m_s)
		return rejection(Rejection::too_fast);
	result.sample = *sample;
	return result;
}
}  // namespace viwo
