#include <mrpt/core/format.h>
#include <viwo/core/NumberText.h>

#include <cmath>

namespace viwo
{
std::string fixed(double value, int decimals)
{
	if (std::isnan(value)) return "-";
	return mrpt::format("%.*f", decimals, value);
}

std::string significant(double value, int digits)
{
	return mrpt::format("%.*g", digits, value);
}

std::string counted(size_t number, const std::string& noun)
{
	return std::to_string(number) + " " + noun + (number == 1 ? "" : "s");
}
}  // namespace viwo
