#pragma once

#include <string>

namespace viwo
{
/** Fixed decimals; "-" for NaN. */
std::string fixed(double value, int decimals);
}  // namespace viwo
