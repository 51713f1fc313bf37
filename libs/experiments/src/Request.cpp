#include <viwo/core/Error.h>
#include <viwo/core/SharedFiles.h>
#include <viwo/experiments/Request.h>
#include <viwo/sim/Motion.h>
#include <viwo/sim/Rig.h>
#include <viwo/sim/Sequence.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace viwo::experiments
{
namespace
{
std::vector<std::string> words(const std::string& text)
{
	std::vector<std::string> list;
	std::istringstream in(text);
	for (std::string word; std::getline(in, word, ',');) list.push_back(word);
	return list;
}

uint64_t seedOf(const std::string& word, const std::string& text)
{
	const bool digits =
	    !word.empty() && word.size() < 10 && std::all_of(word.begin(), word.end(), [](char c) { return c >= '0' && c <= '9'; });
	if (!digits) throw Error("seeds '" + text + "': expected numbers and ranges, e.g. 1-5 or 1,2,7");
	return std::stoull(word);
}

}  // namespace

SimulatedDrive sequenceDrive(const std::string& sequence)
{
	const sim::Sequence files = sim::Sequence::load(findShare("sequences/" + sequence + ".ini"));
	SimulatedDrive drive;
	drive.name = sequence;
	drive.world = files.world;
	drive.route = files.route;
	drive.rig = files.rig;
	return drive;
}

std::vector<uint64_t> parseSeeds(const std::string& text)
{
	std::vector<uint64_t> seeds;
	for (const std::string& word : words(text))
	{
		const size_t dash = word.find('-');
		const uint64_t first = seedOf(word.substr(0, dash), text),
		               last = dash == std::string::npos ? first : seedOf(word.substr(dash + 1), text);
		if (last < first || last - first > 999) throw Error("seeds '" + text + "': a range goes up, over 1000 seeds at most");
		for (uint64_t seed = first; seed <= last; ++seed)
			if (std::find(seeds.begin(), seeds.end(), seed) == seeds.end()) seeds.push_back(seed);
	}
	if (seeds.empty()) throw Error("seeds: none given; e.g. 1-5");
	return seeds;
}

std::vector<std::string> parseSequences(const std::string& text)
{
	const std::vector<std::string> wanted = words(text);
	for (const std::string& word : wanted) paperSequence(word);
	std::vector<std::string> sequences;
	for (const PaperSequence& sequence : paperSequences())
		if (wanted.empty() || std::find(wanted.begin(), wanted.end(), sequence.name) != wanted.end()) sequences.push_back(sequence.name);
	return sequences;
}

std::set<int> parseTables(const std::string& text)
{
	std::set<int> tables;
	if (text == "none") return tables;
	for (const std::string& word : words(text))
	{
		if (word != "1" && word != "2" && word != "3")
			throw Error("tables '" + text + "': expected 1, 2 and 3, separated by commas, or none");
		tables.insert(word[0] - '0');
	}
	if (tables.empty()) throw Error("tables: none given; e.g. 1,2,3");
	return tables;
}

LogRecipe sequenceLog(const std::string& sequence, uint64_t seed)
{
	LogRecipe recipe = sequenceDrive(sequence).log(seed);
	recipe.cost_s = kRenderingCost * sequenceDuration_s(sequence);
	return recipe;
}

double sequenceDuration_s(const std::string& sequence)
{
	const SimulatedDrive drive = sequenceDrive(sequence);
	sim::Rig rig;
	sim::Route route;
	sim::loadRun(drive.rigPath(), drive.routePath(), {}, rig, route);
	return sim::Motion(route).duration_s();
}

double median(std::vector<double> values)
{
	const bool number = std::none_of(values.begin(), values.end(), [](double v) { return std::isnan(v); });
	if (values.empty() || !number) return std::numeric_limits<double>::quiet_NaN();
	std::sort(values.begin(), values.end());
	const size_t n = values.size();
	return n % 2 == 1 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
}
}  // namespace viwo::experiments
