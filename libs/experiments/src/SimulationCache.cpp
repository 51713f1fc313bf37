#include <unistd.h>
#include <viwo/core/AtomicFile.h>
#include <viwo/experiments/SimulationCache.h>

#include <filesystem>
#include <memory>
#include <vector>

#include "FolderLock.h"
#include "TextFiles.h"

namespace viwo::experiments
{
namespace
{
namespace fs = std::filesystem;

constexpr const char* kContentFile = "/inputs.txt";
constexpr const char* kSizeFile = "/size.txt";

/** How many files the log has, images included, and how large they are: to notice that some are missing or were cut. */
std::string sizeOf(const std::string& folder)
{
	size_t files = 0;
	uintmax_t bytes = 0;
	for (const auto& entry : fs::recursive_directory_iterator(folder))
	{
		const std::string name = entry.path().filename().string();
		if (!entry.is_regular_file() || "/" + name == kContentFile || "/" + name == kSizeFile) continue;
		++files;
		bytes += entry.file_size();
	}
	return std::to_string(files) + " files, " + std::to_string(bytes) + " bytes\n";
}

bool isWhole(const std::string& folder, const LogRecipe& recipe)
{
	if (!holds(folder + kContentFile, recipe.content)) return false;
	if (fs::exists(folder + kSizeFile)) return holds(folder + kSizeFile, sizeOf(folder));
	return fs::exists(folder + "/log.rawlog") && fs::exists(folder + "/log_ground_truth.tum");
}

/** A folder that is being filled, beside the place that it will have, under a name that no other program's has. While it is, it is locked:
 * one without a lock was left behind by a program that was killed. */
class UnfinishedFolder
{
   public:
	explicit UnfinishedFolder(std::string final_path) : final_path_(std::move(final_path))
	{
		static int count = 0;
		path_ = final_path_ + kPart + std::to_string(getpid()) + "-" + std::to_string(++count);
	}
	const std::string& path() const { return path_; }

	void create()
	{
		fs::create_directories(fs::path(path_).parent_path());
		removeLeftovers();
		fs::create_directory(path_);
		lock_ = std::make_unique<FolderLock>(path_);
	}

	void finish()
	{
		fs::rename(path_, final_path_);
		lock_.reset();
	}

	void remove()
	{
		fs::remove_all(path_);
		lock_.reset();
	}

   private:
	static constexpr const char* kPart = ".part-";

	void removeLeftovers() const
	{
		std::vector<fs::path> found;
		for (const auto& entry : fs::directory_iterator(fs::path(path_).parent_path()))
			if (entry.path().string().rfind(final_path_ + kPart, 0) == 0) found.push_back(entry.path());
		for (const fs::path& folder : found)
			if (const FolderLock lock(folder.string()); !lock.taken()) fs::remove_all(folder);
	}

	std::string final_path_, path_;
	std::unique_ptr<FolderLock> lock_;
};
}  // namespace

SimulationCache::SimulationCache(std::string folder, std::string programs) : folder_(std::move(folder)), programs_(std::move(programs)) {}

std::string SimulationCache::folderOf(const LogRecipe& recipe) const
{
	return folder_ + "/" + recipe.name + "-" + hashOf(recipe.program + "\n" + recipe.content);
}

Job SimulationCache::job(const LogRecipe& recipe) const
{
	const std::string folder = folderOf(recipe);
	const auto making = std::make_shared<UnfinishedFolder>(folder);
	Job job;
	job.label = (recipe.program == "viwo-sim" ? "simulate " : "import ") + recipe.name;
	job.there = [=] { return recipe.cached && isWhole(folder, recipe); };
	job.prepare = [=] { making->create(); };
	job.command = {programs_ + "/" + recipe.program};
	if (recipe.made_of) job.command.push_back(rawlog(*recipe.made_of));
	job.command.insert(job.command.end(), recipe.arguments.begin(), recipe.arguments.end());
	if (recipe.same_images) job.command.insert(job.command.end(), {"--images-from", folderOf(*recipe.same_images) + "/log_Images"});
	job.command.insert(job.command.end(), {"-o", making->path() + "/log.rawlog"});
	job.log_stem = making->path() + "/program";
	job.cost_s = recipe.cost_s;
	job.succeeded = [=]
	{
		writeAtomically(making->path() + kSizeFile, sizeOf(making->path()));
		writeAtomically(making->path() + kContentFile, recipe.content);
		// Another measurement with the same cache may have been faster: its programs may be reading that one.
		if (recipe.cached && isWhole(folder, recipe)) return making->remove();
		fs::remove_all(folder);
		making->finish();
	};
	return job;
}
}  // namespace viwo::experiments
