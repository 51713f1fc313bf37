#pragma once

#include <viwo/calibration/ImuNoiseRun.h>

#include <string>

namespace viwo
{
/** A table of the axes with deviations, and what goes into the rig; lines for a terminal. */
std::string describeImuNoise(const ImuNoiseResult& result);

/** What the header of the rig says of its origin. */
std::string imuNoiseOrigin(const ImuNoiseResult& result, const std::string& program);

/** @name Written to a temporary name and renamed; each throws Error when it cannot be written. */ /** @{ */

/** Allan deviations of accelerometer and gyroscope with their 95 % intervals, the fitted curves, and the points that are read. */
void saveImuNoiseSvg(const std::string& path, const ImuNoiseResult& result);
/** One page: picture, tables, warnings; light or dark as the reader's screen. */
void saveImuNoiseHtml(const std::string& path, const ImuNoiseResult& result);
void saveImuNoiseJson(const std::string& path, const ImuNoiseResult& result);
/** The points: axis, tau_s, deviation, low, high, fitted, used. */
void saveImuNoiseCsv(const std::string& path, const ImuNoiseResult& result);
/** @} */
}  // namespace viwo
