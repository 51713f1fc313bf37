#include "Figures.h"

#include <viwo/core/NumberText.h>

#include <cmath>

namespace viwo::experiments
{
std::string cell(double value, int decimals)
{
	return std::isnan(value) ? kOpenMark : std::isinf(value) ? "fails" : fixed(value, decimals);
}

std::set<size_t> smallest(const std::vector<double>& figures, int decimals)
{
	std::set<size_t> indices;
	if (figures.empty() || std::any_of(figures.begin(), figures.end(), [](double f) { return std::isnan(f); })) return indices;
	const double least = *std::min_element(figures.begin(), figures.end());
	for (size_t i = 0; i < figures.size() && std::isfinite(least); ++i)
		if (fixed(figures[i], decimals) == fixed(least, decimals)) indices.insert(i);
	return indices;
}
}  // namespace viwo::experiments
