#include "RangeNoise.h"

#include <algorithm>
#include <cmath>

namespace viwo::gt
{
double rangeNoise_m(const std::vector<Scan>& scans)
{
	constexpr size_t kScans = 200;
	constexpr double kLeast_m = 0.005;
	std::vector<float> differences;
	const size_t stride = std::max<size_t>(1, scans.size() / kScans);
	for (size_t s = 0; s < scans.size(); s += stride)
	{
		const std::vector<float>& r = scans[s].ranges_m;
		// Along a straight wall, however slanted, 1/r is a sine of the angle: the middle one of three beams follows from its neighbours.
		const auto twice_cosine = static_cast<float>(2 * std::cos(scans[s].step_rad));
		for (size_t i = 1; i + 1 < r.size(); ++i)
			if (r[i - 1] > 0 && r[i] > 0 && r[i + 1] > 0)
				differences.push_back(std::abs(r[i] - twice_cosine / (1 / r[i - 1] + 1 / r[i + 1])));
	}
	if (differences.empty()) return kLeast_m;
	const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
	std::nth_element(differences.begin(), middle, differences.end());
	// Median of |x| of a normal variable is 0.6745 sigma; the difference has sqrt(1 + 2/4) the deviation of a range.
	return std::max(kLeast_m, static_cast<double>(*middle) / (0.6745 * std::sqrt(1.5)));
}
}  // namespace viwo::gt
