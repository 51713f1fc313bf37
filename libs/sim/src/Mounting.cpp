#include <viwo/core/Error.h>
#include <viwo/sim/Mounting.h>

#include <string>

namespace viwo::sim
{
Pose3 mountingPose(const std::vector<double>& pose, const char* key)
{
	if (pose.size() != 6)
		throw Error(std::string(key) + ": expected six numbers, x y z in metres and yaw pitch roll in degrees, found " +
		            std::to_string(pose.size()));
	const double deg = M_PI / 180;
	const Eigen::Quaterniond R = Eigen::AngleAxisd(pose[3] * deg, Eigen::Vector3d::UnitZ()) *
	                             Eigen::AngleAxisd(pose[4] * deg, Eigen::Vector3d::UnitY()) *
	                             Eigen::AngleAxisd(pose[5] * deg, Eigen::Vector3d::UnitX());
	return {R.normalized(), Eigen::Vector3d(pose[0], pose[1], pose[2])};
}

Mounting::Mounting(const std::vector<double>& pose, const std::vector<double>& error, const char* section)
    : nominal(mountingPose(pose, (std::string("[") + section + "] pose").c_str())),
      actual(nominal * mountingPose(error, (std::string("[") + section + "] pose_error").c_str()))
{
}
}  // namespace viwo::sim
