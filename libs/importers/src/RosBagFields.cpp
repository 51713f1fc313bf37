#include "RosBagFields.h"

namespace viwo
{
std::map<std::string, std::string> rosBagFields(const std::string& header)
{
	std::map<std::string, std::string> fields;
	for (size_t at = 0; at < header.size();)
	{
		if (at + 4 > header.size()) return {};
		const size_t length = littleEndian(header.substr(at, 4)), equals = header.find('=', at + 4);
		if (length > header.size() - at - 4 || equals == std::string::npos || equals >= at + 4 + length) return {};
		fields[header.substr(at + 4, equals - at - 4)] = header.substr(equals + 1, at + 4 + length - equals - 1);
		at += 4 + length;
	}
	return fields;
}
}  // namespace viwo
