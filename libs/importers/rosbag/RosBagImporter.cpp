#include "RosBagImport.h"
#include "RosTopicTrial.h"

#include <viwo/core/Error.h>
#include <viwo/importers/RosBagImporter.h>

#include <memory>

namespace viwo
{
bool hasRosBagSupport()
{
	return true;
}

namespace
{
[[noreturn]] void refuseForNoTopic(const RosBagFile& bag, const RosTopicMap& map)
{
	if (map.notes.empty()) throw Error(bag.name() + ": no topic can become an observation; it has: " + namesOfTopics(bag.topics()));
	std::string reasons;
	for (const std::string& note : map.notes) reasons += (reasons.empty() ? "" : "; ") + note;
	throw Error(bag.name() + ": no topic can become an observation without a --map: " + reasons);
}

std::unique_ptr<RosBagImport> prepared(const RosBagFile& bag, const RosTopicMap& map, const ImportJob& job, const RosBagOptions& options)
try
{
	return std::make_unique<RosBagImport>(bag, map, job, options.record_time);
}
catch (const Error&)
{
	if (options.map_path.empty()) options.show_mapping(describeTopicMap(map));
	throw;
}
}  // namespace

ImportResult importRosBags(const ImportJob& job, const RosBagOptions& options)
{
	const RosBagFile bag(options.bags);
	const RosTopicMap map = options.map_path.empty() ? proposeTopicMap(bag) : readTopicMap(options.map_path, bag.topics());
	if (map.topics.empty()) refuseForNoTopic(bag, map);
	const std::unique_ptr<RosBagImport> import = prepared(bag, map, job, options);
	const std::string mapping = describeTopicMap(import->usedMap());
	options.show_mapping(mapping);
	ImportResult result = import->run();
	result.mapping = mapping;
	result.notes.insert(result.notes.begin(), map.notes.begin(), map.notes.end());
	return result;
}
}  // namespace viwo
