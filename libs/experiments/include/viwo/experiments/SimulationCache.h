#pragma once

#include <string>

#include <viwo/experiments/JobPool.h>
#include <viwo/experiments/Recipes.h>

namespace viwo::experiments
{
/** Where logs are made and kept: a folder each, named by what it was made from. One that is being made has another name, so that what is
 *  there under its own is whole, however the program ended the last time.
 */
class SimulationCache
{
   public:
	/** @param programs folder of viwo-sim and viwo-import. */
	SimulationCache(std::string folder, std::string programs);

	/** The job that makes the log, or does nothing where it is there. One with the images of another log must come after that. */
	Job job(const LogRecipe& recipe) const;

	std::string rawlog(const LogRecipe& recipe) const { return folderOf(recipe) + "/log.rawlog"; }
	std::string groundTruth(const LogRecipe& recipe) const { return folderOf(recipe) + "/log_ground_truth.tum"; }

   private:
	std::string folderOf(const LogRecipe& recipe) const;

	std::string folder_, programs_;
};
}  // namespace viwo::experiments
