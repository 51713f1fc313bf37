#include "TextDistance.h"

#include <algorithm>
#include <cctype>
#include <numeric>

namespace viwo
{
namespace
{
size_t editDistance(const std::string& a, const std::string& b)
{
	std::vector<size_t> row(b.size() + 1);
	std::iota(row.begin(), row.end(), size_t{0});
	for (size_t i = 1; i <= a.size(); i++)
	{
		size_t diagonal = row[0];
		row[0] = i;
		for (size_t j = 1; j <= b.size(); j++)
		{
			const size_t substitution = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
			diagonal = row[j];
			row[j] = std::min({row[j] + 1, row[j - 1] + 1, substitution});
		}
	}
	return row.back();
}
}  // namespace

std::string lowered(std::string text)
{
	for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
	return text;
}

std::string suggestion(const std::string& word, const std::vector<std::string>& candidates)
{
	const std::string* best = nullptr;
	size_t best_distance = std::max<size_t>(2, word.size() / 2) + 1;
	for (const auto& candidate : candidates)
	{
		const size_t d = editDistance(lowered(word), lowered(candidate));
		if (d >= best_distance) continue;
		best_distance = d;
		best = &candidate;
	}
	return best ? " (did you mean '" + *best + "'?)" : "";
}
}  // namespace viwo
