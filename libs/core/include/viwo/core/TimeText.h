#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace viwo
{
/** Nanoseconds of a decimal number of seconds ("1403715273.262142976", "1.4e9", "-3"), exact: a double would round to 240 ns at Unix epoch.
 *  Digits beyond the ninth decimal are rounded. Nothing for any other text, or beyond the 292 years of int64_t.
 */
std::optional<int64_t> parseSeconds(std::string_view text);

/** Seconds with 9 decimals. */
std::string formatSeconds(int64_t t_ns);
}  // namespace viwo
