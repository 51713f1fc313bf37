#pragma once

#include <cmath>

namespace viwo
{
constexpr double kDegree = M_PI / 180;  //!< in radians

inline double square(double x)
{
	return x * x;
}
}  // namespace viwo
