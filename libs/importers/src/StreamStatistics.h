#pragma once

#include <viwo/importers/RecordingInfo.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace viwo
{
/** Gathers stamps by sensor. */
class StreamStatistics
{
   public:
	/** The next stamp of a sensor, in the order of arrival. @return its entry. */
	StreamInfo& add(const std::string& name, const std::string& type, SensorRole role, int64_t t_ns);

	/** All sensors, by name. */
	std::vector<StreamInfo> finish();

   private:
	struct Stream
	{
		StreamInfo info;
		std::vector<int64_t> stamps_ns;
	};
	std::map<std::pair<std::string, std::string>, Stream> streams_;
};

/** inspectRecording() of a ROS 1 bag. */
RecordingInfo inspectRosBag(const std::string& path, const std::function<bool(double)>& proceed);
}  // namespace viwo
