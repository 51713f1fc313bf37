#include "StreamStatistics.h"

#include <viwo/core/Error.h>
#include <viwo/importers/RosBagImporter.h>

namespace viwo
{
bool hasRosBagSupport()
{
	return false;
}

namespace
{
[[noreturn]] void refuse(const std::string& path)
{
	throw Error(
	    path +
	    ": this viwo was built without ROS bags; install librosbag-storage-dev, libroscpp-core-dev, libsensor-msgs-dev, libnav-msgs-dev "
	    "and libtf2-msgs-dev, and build it again");
}
}  // namespace

ImportResult importRosBags(const ImportJob&, const RosBagOptions& options)
{
	refuse(options.bags.empty() ? "ROS bags" : options.bags.front());
}

RecordingInfo inspectRosBag(const std::string& path, const std::function<bool(double)>&)
{
	refuse(path);
}
}  // namespace viwo
