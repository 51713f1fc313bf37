#include "ImageFolder.h"

#include <algorithm>
#include <filesystem>
#include <vector>

namespace fs = std::filesystem;

namespace viwo
{
namespace
{
constexpr const char* kSuffix = "_Images";

bool isFile(const fs::path& path)
{
	std::error_code ignored;
	return fs::is_regular_file(path, ignored);
}

bool isFolder(const fs::path& path)
{
	std::error_code ignored;
	return fs::is_directory(path, ignored);
}

bool endsWith(const std::string& text, const std::string& end)
{
	return text.size() > end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/** Sorted, so that the choice does not depend on the file system. */
std::vector<fs::path> imageFoldersIn(const fs::path& folder)
{
	std::vector<fs::path> found;
	std::error_code ignored;
	for (const auto& entry : fs::directory_iterator(folder, ignored))
	{
		const std::string name = entry.path().filename().string();
		if ((endsWith(name, kSuffix) || name == "Images") && isFolder(entry.path())) found.push_back(entry.path());
	}
	std::sort(found.begin(), found.end());
	return found;
}

/** Length of the rawlog's name that the folder's name shares, where the latter is its beginning: run_cut.rawlog and run_Images. */
size_t sharedName(const fs::path& folder, const std::string& rawlog_stem)
{
	const std::string name = folder.filename().string();
	if (!endsWith(name, kSuffix)) return 0;
	const std::string stem = name.substr(0, name.size() - std::string(kSuffix).size());
	return rawlog_stem.compare(0, stem.size(), stem) == 0 ? stem.size() : 0;
}
}  // namespace

std::string ImageFolder::choose(const std::string& name, std::string& reason) const
{
	// A rawlog that comes through standard input has its images where the program was started.
	const fs::path rawlog = fs::absolute(rawlog_path_ == "/dev/stdin" ? "stdin.rawlog" : rawlog_path_);
	const std::string stem = rawlog.stem().string();
	for (const char* suffix : {kSuffix, "_images", "_IMAGES"})
	{
		const fs::path own = rawlog.parent_path() / (stem + suffix);
		if (!isFolder(own)) continue;
		if (isFile(own / name)) return own.string();
		reason = "it is not in " + own.string() + "; copy it there";
		return {};
	}

	// A rawlog cut from another one: its images are in the folder of the original.
	std::vector<fs::path> holders;
	for (const auto& folder : imageFoldersIn(rawlog.parent_path()))
		if (isFile(folder / name)) holders.push_back(folder);
	std::stable_sort(holders.begin(), holders.end(),
	                 [&](const auto& a, const auto& b) { return sharedName(a, stem) > sharedName(b, stem); });
	const std::string remedy =
	    "copy or link the image folder of the original rawlog to " + (rawlog.parent_path() / (stem + kSuffix)).string();
	if (holders.empty())
	{
		reason = "there is no image folder with it beside the rawlog; " + remedy;
		return {};
	}
	if (holders.size() > 1 && sharedName(holders[0], stem) == sharedName(holders[1], stem))
	{
		reason = "both " + holders[0].string() + " and " + holders[1].string() + " have a file of that name; " + remedy;
		return {};
	}
	return holders[0].string();
}

std::string ImageFolder::find(const std::string& name, std::string& reason)
{
	// An absolute name counts where it exists; else the file was moved here along with its rawlog.
	const bool is_absolute = fs::path(name).is_absolute();
	if (is_absolute && isFile(name)) return name;
	const std::string local_name = is_absolute ? fs::path(name).filename().string() : name;
	if (folder_.empty()) folder_ = choose(local_name, reason);
	if (folder_.empty()) return {};
	const fs::path file = fs::path(folder_) / local_name;
	if (isFile(file)) return file.string();
	reason = "it is not in " + folder_ + "; copy it there";
	return {};
}
}  // namespace viwo
