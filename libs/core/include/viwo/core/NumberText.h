#pragma once

#include <cstddef>
#include <string>

namespace viwo
{
/** Fixed decimals; "-" for NaN. */
std::string fixed(double value, int decimals);

/** "1 image", "3 images". @param noun whose plural ends in s. */
std::string counted(size_t number, const std::string& noun);
}  // namespace viwo
