#include "OutputNames.h"

#include <algorithm>
#include <filesystem>

namespace viwo
{
namespace fs = std::filesystem;

std::string besideRawlog(const std::string& rawlog_path, const std::string& ending)
{
	fs::path path(rawlog_path);
	return path.replace_filename(path.stem().string() + ending).string();
}

std::vector<std::string> putAsideOthers(const std::string& rawlog_path, const std::vector<std::string>& written)
{
	std::vector<std::string> notes;
	for (const char* ending : {kGroundTruthEnding, kGpsEnding, kStampsEnding})
	{
		const std::string path = besideRawlog(rawlog_path, ending);
		std::error_code error;
		if (std::find(written.begin(), written.end(), path) != written.end() || !fs::is_regular_file(path, error)) continue;
		fs::rename(path, path + ".old", error);
		notes.push_back(path + ": was there before, and is not of this recording; " +
		                (error ? "it cannot be renamed (" + error.message() + "): remove it" : "renamed to " + path + ".old"));
	}
	return notes;
}
}  // namespace viwo
