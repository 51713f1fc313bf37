#pragma once

#include <viwo/calibration/ImuNoiseRun.h>
#include <viwo/core/Svg.h>

#include <string>
#include <vector>

namespace viwo
{
/** What the plot's marks mean; the plot of both sensors says it itself. */
constexpr const char* kAllanMarks = "Filled: N, read at 1 s, and K, read at 3 s. Hollow: least of the fit. Shaded: 95 %.";

/** Panels with log-log axes, side by side. @param sensors by the first of their axes: 0 accelerometer, 3 gyroscope. */
std::string allanPlot(const ImuNoiseResult& result, const std::vector<size_t>& sensors, const SvgPalette& colours);
}  // namespace viwo
