#include "OutputNames.h"

#include <algorithm>
#include <filesystem>

namespace viwo
{
namespace fs = std::filesystem;

namespace
{
/** X.old, or X.old2, ...: one that is not there yet. */
std::string nameAside(const std::string& path)
{
	std::error_code ignored;
	std::string name = path + ".old";
	for (int i = 2; fs::exists(fs::symlink_status(name, ignored)); ++i) name = path + ".old" + std::to_string(i);
	return name;
}
}  // namespace

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
		const std::string aside = nameAside(path);
		fs::rename(path, aside, error);
		notes.push_back(path + ": was there before, and is not of this recording; " +
		                (error ? "it cannot be renamed (" + error.message() + "): remove it" : "renamed to " + aside));
	}
	return notes;
}
}  // namespace viwo
