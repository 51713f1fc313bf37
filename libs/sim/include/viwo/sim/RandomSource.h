#pragma once

#include <cstdint>
#include <random>
#include <string_view>

namespace viwo::sim
{
/** The generator of one source of randomness, from the seed of the run and the source's name: sources do not disturb one another, so
 *  switching one off leaves the draws of all others as they are.
 */
inline std::mt19937_64 randomSource(uint64_t seed, std::string_view source_name)
{
	uint64_t hash = 0xcbf29ce484222325ULL;  // FNV-1a
	for (const char c : source_name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
	uint64_t z = hash + 0x9e3779b97f4a7c15ULL * (seed + 1);  // SplitMix64's finaliser, so that neighbouring seeds are unrelated
	z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
	z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
	return std::mt19937_64(z ^ (z >> 31));
}
}  // namespace viwo::sim
