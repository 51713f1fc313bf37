#include "SimulationCache.h"

#include <viwo/core/AtomicFile.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace viwo::accuracy
{
namespace
{
namespace fs = std::filesystem;

constexpr const char* kContentFile = "/inputs.txt";

/** FNV-1a, 64 bit. */
std::string hashOf(const std::string& text)
{
	uint64_t hash = 0xcbf29ce484222325ULL;
	for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
	char word[20];
	std::snprintf(word, sizeof word, "%016llx", static_cast<unsigned long long>(hash));
	return word;
}

bool holds(const std::string& folder, const std::string& content)
{
	std::ifstream file(folder + kContentFile, std::ios::binary);
	return file && std::string(std::istreambuf_iterator<char>(file), {}) == content;
}

void writeContent(const std::string& folder, const std::string& content)
{
	AtomicFile file(folder + kContentFile);
	file.stream() << content;
	file.commit();
}
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
		if (recipe.cached && holds(folder, recipe.content)) return false;
		fs::remove_all(making);
		fs::remove_all(folder);
		fs::create_directories(making);
		return true;
	};
	job.command = {programs_ + "/" + recipe.program};
	job.command.insert(job.command.end(), recipe.arguments.begin(), recipe.arguments.end());
	if (recipe.same_images) job.command.insert(job.command.end(), {"--images-from", folderOf(*recipe.same_images) + "/log_Images"});
	job.command.insert(job.command.end(), {"-o", making + "/log.rawlog"});
	job.log_stem = making + "/program";
	job.succeeded = [recipe, folder, making]
	{
		writeContent(making, recipe.content);
		fs::rename(making, folder);
	};
	return job;
}
}  // namespace viwo::accuracy
