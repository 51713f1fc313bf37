#include "RosBagImport.h"

#include <viwo/core/Error.h>
#include <viwo/importers/RosBagImporter.h>

namespace viwo
{
bool hasRosBagSupport()
{
	return true;
}

ImportResult importRosBags(const ImportJob& job, const RosBagOptions& options)
{
	const RosBagFile bag(options.bags);
	const RosTopicMap map = options.map_path.empty() ? proposeTopicMap(bag.topics()) : readTopicMap(options.map_path, bag.topics());
	if (map.topics.empty()) throw Error(bag.name() + ": no topic can become an observation; it has: " + namesOfTopics(bag.topics()));
	RosBagImport import(bag, map, job, options.record_time);
	ImportResult result = import.run();
	result.mapping = describeTopicMap(import.usedMap());
	result.notes.insert(result.notes.begin(), map.notes.begin(), map.notes.end());
	return result;
}
}  // namespace viwo
