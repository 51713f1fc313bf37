#pragma once

#include <viwo/calibration/ImuNoiseRun.h>
#include <viwo/core/Svg.h>

#include <string>

namespace viwo
{
/** Two panels with log-log axes: accelerometer and gyroscope. */
std::string allanPlot(const ImuNoiseResult& result, const SvgPalette& colours);
}  // namespace viwo
