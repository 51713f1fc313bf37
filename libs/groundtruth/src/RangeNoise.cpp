#include "RangeNoise.h"

#include <viwo/core/Ranking.h>

#include <algorithm>
#include <cmath>

namespace viwo::gt
{
namespace
{
constexpr double kLeast_m = 0.005;
/** Beams lie on a surface with their neighbours within these shares of the range; in a scan of noise hardly any do so by chance. */
constexpr double kNear = 0.05, kNearNoisy = 0.1, kFewestNear = 0.2;
constexpr size_t kFewest = 15;  // triples of beams that tell of a single scan

/** Calls with the range of a beam and its distance from the line through its neighbours. */
template <class Visit>
void forEachTriple(const Scan& scan, const Visit& visit)
{
	const std::vector<float>& r = scan.ranges_m;
	// Along a straight wall, however slanted, 1/r is a sine of the angle: the middle one of three beams follows from its neighbours.
	const auto twice_cosine = static_cast<float>(2 * std::cos(scan.step_rad));
	for (size_t i = 1; i + 1 < r.size(); ++i)
		if (r[i - 1] > 0 && r[i] > 0 && r[i + 1] > 0) visit(r[i], std::abs(r[i] - twice_cosine / (1 / r[i - 1] + 1 / r[i + 1])));
}

bool isNoise(const Scan& scan, double noise_m)
{
	size_t triples = 0, near = 0;
	forEachTriple(scan,
	              [&](float range_m, float distance_m)
	              {
		              const auto r = static_cast<double>(range_m);
		              ++triples;
		              near += static_cast<double>(distance_m) < std::max(kNear * r, std::min(3 * noise_m, kNearNoisy * r));
	              });
	return triples >= kFewest && static_cast<double>(near) < kFewestNear * static_cast<double>(triples);
}
}  // namespace

double rangeNoise_m(const std::vector<Scan>& scans)
{
	constexpr size_t kScans = 200;
	std::vector<float> differences;
	const size_t stride = std::max<size_t>(1, scans.size() / kScans);
	for (size_t s = 0; s < scans.size(); s += stride)
		forEachTriple(scans[s], [&](float, float distance_m) { differences.push_back(distance_m); });
	if (differences.empty()) return kLeast_m;
	// Median of |x| of a normal variable is 0.6745 sigma; the difference has sqrt(1 + 2/4) the deviation of a range.
	return std::max(kLeast_m, static_cast<double>(upperMedian(differences)) / (0.6745 * std::sqrt(1.5)));
}

size_t blankNoise(std::vector<Scan>& scans, double noise_m)
{
	size_t count = 0;
	for (Scan& scan : scans)
	{
		if (!isNoise(scan, noise_m)) continue;
		std::fill(scan.ranges_m.begin(), scan.ranges_m.end(), 0.f);
		++count;
	}
	return count;
}
}  // namespace viwo::gt
