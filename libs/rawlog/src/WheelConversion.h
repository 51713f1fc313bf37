#pragma once

#include <viwo/rawlog/ObservationAdapter.h>

#include <optional>
#include <string>

namespace viwo
{
bool hasSource(const mrpt::obs::CObservationOdometry& odometry, AdapterOptions::OdometrySource source);

/** The values of odometry_source that this observation could serve. */
std::string describeSources(const mrpt::obs::CObservationOdometry& odometry);

/** Of what the source uses. */
bool isFinite(const mrpt::obs::CObservationOdometry& odometry, AdapterOptions::OdometrySource source);

/** Mean wheel speeds from `previous` to `current`; nothing where they take two readings and previous is null. */
std::optional<WheelSample> wheelSampleFrom(const OdometryReading* previous, const OdometryReading& current, const AdapterOptions& options);
}  // namespace viwo
