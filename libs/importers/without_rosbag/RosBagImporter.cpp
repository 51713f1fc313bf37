#include <viwo/core/Error.h>
#include <viwo/importers/RosBagImporter.h>

namespace viwo
{
bool hasRosBagSupport()
{
	return false;
}

ImportResult importRosBags(const ImportJob&, const RosBagOptions& options)
{
	throw Error((options.bags.empty() ? std::string("ROS bags") : options.bags.front()) +
	            ": this viwo was built without ROS bags; install librosbag-storage-dev, libroscpp-core-dev, libsensor-msgs-dev, libnav-msgs-dev and "
	            "libtf2-msgs-dev, and build it again");
}
}  // namespace viwo
