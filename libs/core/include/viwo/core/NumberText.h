#pragma once

#include <cstddef>
#include <string>

namespace viwo
{
/** Fixed decimals; "-" for NaN. */
std::string fixed(double value, int decimals);

/** So many significant digits without zeros behind them, with an exponent where the number is large or small ("%g"). */
std::string significant(double value, int digits);

/** "1 image", "3 images". @param noun whose plural ends in s. */
std::string counted(size_t number, const std::string& noun);
}  // namespace viwo
