#include <viwo/core/AtomicFile.h>
#include <viwo/experiments/SimulationCache.h>

#include <filesystem>

#include "TextFiles.h"

namespace viwo::experiments
{
namespace
{
namespace fs = std::filesystem;

constexpr const char* kContentFile = "/inputs.txt";
}  // namespace

SimulationCache::SimulationCache(std::string folder, std::string programs) : folder_(std::move(folder)), programs_(std::move(programs)) {}

std::string SimulationCache::folderOf(const LogRecipe& recipe) const
{
	return folder_ + "/" + recipe.name + "-" + hashOf(recipe.program + "\n" + recipe.content);
}

Job SimulationCache::job(const LogRecipe& recipe) const
{
	const std::string folder = folderOf(recipe), making = folder + ".part";
	Job job;
	job.label = (recipe.program == "viwo-sim" ? "simulate " : "import ") + recipe.name;
	job.prepare = [recipe, folder, making]
	{
		if (recipe.cached && holds(folder + kContentFile, recipe.content)) return false;
		fs::remove_all(making);
		fs::remove_all(folder);
		fs::create_directories(making);
		return true;
	};
	job.command = {programs_ + "/" + recipe.program};
	if (recipe.made_of) job.command.push_back(rawlog(*recipe.made_of));
	job.command.insert(job.command.end(), recipe.arguments.begin(), recipe.arguments.end());
	if (recipe.same_images) job.command.insert(job.command.end(), {"--images-from", folderOf(*recipe.same_images) + "/log_Images"});
	job.command.insert(job.command.end(), {"-o", making + "/log.rawlog"});
	job.log_stem = making + "/program";
	job.cost_s = recipe.cost_s;
	job.succeeded = [recipe, folder, making]
	{
		writeAtomically(making + kContentFile, recipe.content);
		fs::rename(making, folder);
	};
	return job;
}
}  // namespace viwo::experiments
