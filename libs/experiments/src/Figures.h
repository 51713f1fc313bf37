#pragma once

#include <algorithm>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include <viwo/core/NumberText.h>

/** Figures of runs as they stand in tables. */
namespace viwo::experiments
{
/** Of a run that failed: worse than any other. */
constexpr double kFailed = std::numeric_limits<double>::infinity();
/** Of a run that has not been done. */
constexpr double kOpen = std::numeric_limits<double>::quiet_NaN();
/** Stands where runs have not been done. */
constexpr const char* kOpenMark = "...";

/** "fails" of one that failed, kOpenMark of an open one. */
std::string cell(double value, int decimals);

/** Indices of the smallest figures: of several where they print the same, of none where one is open or none is finite. */
std::set<size_t> smallest(const std::vector<double>& figures, int decimals);

/** Names of the sequences of rows, in their order. */
template <class Rows>
std::vector<std::string> sequencesOf(const Rows& rows)
{
	std::vector<std::string> names;
	for (const auto& row : rows)
		if (std::find(names.begin(), names.end(), row.sequence) == names.end()) names.push_back(row.sequence);
	return names;
}
}  // namespace viwo::experiments
