#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace viwo
{
/** Little-endian number in as many of the first bytes as there are, at most 8. */
inline uint64_t littleEndian(const std::string& bytes)
{
	uint64_t value = 0;
	for (size_t i = 0; i < bytes.size() && i < 8; ++i) value |= static_cast<uint64_t>(static_cast<unsigned char>(bytes[i])) << (8 * i);
	return value;
}

/** The fields of the header of a bag's record: uint32 length, then `name=value` each. Nothing where they are damaged. */
std::map<std::string, std::string> rosBagFields(const std::string& header);
}  // namespace viwo
