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
}  // namespace viwo
