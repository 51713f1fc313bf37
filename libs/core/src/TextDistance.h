#pragma once

#include <string>
#include <vector>

namespace viwo
{
std::string lowered(std::string text);

/** " (did you mean 'x'?)" for the nearest of the candidates, or "" where none is near. */
std::string suggestion(const std::string& word, const std::vector<std::string>& candidates);
}  // namespace viwo
