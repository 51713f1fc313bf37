#include <viwo/core/NumberText.h>

#include <cmath>
#include <cstdio>

namespace viwo
{
std::string fixed(double value, int decimals)
{
	if (std::isnan(value)) return "-";
	char text[64];
	std::snprintf(text, sizeof text, "%.*f", decimals, value);
	return text;
}

std::string counted(size_t number, const std::string& noun)
{
	return std::to_string(number) + " " + noun + (number == 1 ? "" : "s");
}
}  // namespace viwo
