#include "RangeNoise.h"

#include <algorithm>

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
		for (size_t i = 1; i + 1 < r.size(); ++i)
			if (r[i - 1] > 0 && r[i] > 0 && r[i + 1] > 0) differences.push_back(std::abs(r[i - 1] - 2 * r[i] + r[i + 1]));
	}
	if (differences.empty()) return kLeast_m;
	const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
	std::nth_element(differences.begin(), middle, differences.end());
	// Median of |x| of a normal variable is 0.6745 sigma; a second difference has sqrt(6) the deviation of a range.
	return std::max(kLeast_m, static_cast<double>(*middle) / (0.6745 * std::sqrt(6.0)));
}
}  // namespace viwo::gt
