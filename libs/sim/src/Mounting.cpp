#include <viwo/core/Error.h>
#include <viwo/core/MountingPose.h>
#include <viwo/sim/Mounting.h>

#include <string>

namespace viwo::sim
{
Pose3 mountingPose(const std::vector<double>& pose, const char* key)
{
	if (pose.size() != 6)
		throw Error(std::string(key) + ": expected six numbers, x y z in metres and yaw pitch roll in degrees, found " +
		            std::to_string(pose.size()));
	return viwo::mountingPose({pose[0], pose[1], pose[2]}, {pose[3], pose[4], pose[5]});
}

Mounting::Mounting(const std::vector<double>& pose, const std::vector<double>& error, const char* section)
    : nominal(mountingPose(pose, (std::string("[") + section + "] pose").c_str())),
      actual(nominal * mountingPose(error, (std::string("[") + section + "] pose_error").c_str()))
{
}
}  // namespace viwo::sim
