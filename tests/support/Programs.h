#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace viwo::testing
{
/** All programs of viwo, by the names of their folders. */
inline std::vector<std::string> allPrograms()
{
	std::vector<std::string> names;
	for (const auto& entry : std::filesystem::directory_iterator(VIWO_SOURCE_DIR "/apps"))
		if (std::filesystem::exists(entry.path() / "main.cpp")) names.push_back(entry.path().filename().string());
	std::sort(names.begin(), names.end());
	return names;
}
}  // namespace viwo::testing
