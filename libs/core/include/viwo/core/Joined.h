#pragma once

#include <string>

namespace viwo
{
/** "a, b, c" of strings in any container. */
template <class Words>
std::string joined(const Words& words)
{
	std::string text;
	for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
	return text;
}
}  // namespace viwo
