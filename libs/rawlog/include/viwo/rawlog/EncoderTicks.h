#pragma once

#include <cstdint>

namespace viwo
{
/** Counts of the two wheels' encoders since any start; as registers of 32 bits they wrap around. */
struct EncoderTicks
{
	int32_t left = 0;
	int32_t right = 0;
};

inline int32_t wrappingSum(int32_t a, int32_t b)
{
	return static_cast<int32_t>(static_cast<uint32_t>(a) + static_cast<uint32_t>(b));
}
inline int32_t wrappingDifference(int32_t a, int32_t b)
{
	return static_cast<int32_t>(static_cast<uint32_t>(a) - static_cast<uint32_t>(b));
}
}  // namespace viwo
