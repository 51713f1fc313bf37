#include "TextFiles.h"

#include <mrpt/core/format.h>
#include <viwo/core/Error.h>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace viwo::experiments
{
std::string readFile(const std::string& path)
{
	std::ifstream file(path, std::ios::binary);
	if (!file) throw Error(path + ": cannot be read");
	return {std::istreambuf_iterator<char>(file), {}};
}

bool holds(const std::string& path, const std::string& content)
{
	return std::filesystem::exists(path) && readFile(path) == content;
}

void createFolder(const std::string& path)
{
	std::error_code error;
	std::filesystem::create_directories(path, error);
	if (error || !std::filesystem::is_directory(path))
		throw Error(path + ": cannot create this folder: " + (error ? error.message() : "it is a file") + "; give another");
}

std::string hashOf(const std::string& content)
{
	uint64_t hash = 0xcbf29ce484222325ULL;
	for (const char c : content) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
	return mrpt::format("%016llx", static_cast<unsigned long long>(hash));
}
}  // namespace viwo::experiments
