#pragma once

#include <viwo/experiments/Paper.h>
#include <viwo/experiments/Recipes.h>

#include <cstdint>
#include <set>
#include <string>
#include <vector>

namespace viwo::experiments
{
/** What is to be measured. */
struct Request
{
	std::vector<std::string> sequences;  //!< names of files of share/viwo/sequences, which are the paper's
	std::vector<uint64_t> seeds = {1, 2, 3, 4, 5};
	std::set<int> tables = {1, 2, 3};
	bool ablations = false;
	std::vector<std::string> error_budget;  //!< sequences of which each source of error is switched off and on
};

/** "1-3,7" -> 1 2 3 7. @throws Error that quotes what cannot be read. */
std::vector<uint64_t> parseSeeds(const std::string& text);

/** "seq01,seq05", in the paper's order; empty: all six. @throws Error for a name that is none of them. */
std::vector<std::string> parseSequences(const std::string& text);

/** "1,3", or "none". @throws Error for a table that is not 1, 2 or 3. */
std::set<int> parseTables(const std::string& text);

/** Seconds of computing a second of a log: for the time that is left, which takes the machine's own pace into account. */
constexpr double kRenderingCost = 0.3, kVisionCost = 0.12, kWheelCost = 0.002;

/** The drive of a sequence. */
SimulatedDrive sequenceDrive(const std::string& sequence);

/** Its log. */
LogRecipe sequenceLog(const std::string& sequence, uint64_t seed);

/** How long the sequence is driven, s. */
double sequenceDuration_s(const std::string& sequence);

/** The median; of an even number, the mean of the middle two. NaN of nothing, and of figures of which one is NaN. */
double median(std::vector<double> values);
}  // namespace viwo::experiments
