#include "ActionOdometry.h"

#include <cstring>

namespace viwo
{
namespace
{
/** Old recordings hold flags that nobody had set, and MRPT reads their bytes as they are: one that is neither 0 nor 1 says nothing. */
bool isSet(const bool& flag)
{
	unsigned char byte = 0;
	std::memcpy(&byte, &flag, 1);
	return byte == 1;
}
}  // namespace

mrpt::obs::CObservationOdometry::Ptr ActionOdometry::add(const mrpt::obs::CActionRobotMovement2D& action)
{
	pose_ = pose_ + action.rawOdometryIncrementReading;
	auto odometry = mrpt::obs::CObservationOdometry::Create();
	odometry->sensorLabel = label_;
	odometry->timestamp = action.timestamp;
	odometry->odometry = pose_;
	odometry->hasVelocities = isSet(action.hasVelocities);
	odometry->velocityLocal = action.velocityLocal;
	odometry->hasEncodersInfo = isSet(action.hasEncodersInfo);
	if (odometry->hasEncodersInfo)
	{
		ticks_.left = wrappingSum(ticks_.left, action.encoderLeftTicks);
		ticks_.right = wrappingSum(ticks_.right, action.encoderRightTicks);
		odometry->encoderLeftTicks = ticks_.left;
		odometry->encoderRightTicks = ticks_.right;
	}
	return odometry;
}
}  // namespace viwo
