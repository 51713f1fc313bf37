#include "ActionOdometry.h"

namespace viwo
{
mrpt::obs::CObservationOdometry::Ptr ActionOdometry::add(const mrpt::obs::CActionRobotMovement2D& action)
{
	pose_ = pose_ + action.rawOdometryIncrementReading;
	auto odometry = mrpt::obs::CObservationOdometry::Create();
	odometry->sensorLabel = label_;
	odometry->timestamp = action.timestamp;
	odometry->odometry = pose_;
	odometry->hasVelocities = action.hasVelocities;
	odometry->velocityLocal = action.velocityLocal;
	odometry->hasEncodersInfo = action.hasEncodersInfo;
	if (action.hasEncodersInfo)
	{
		ticks_.left = wrappingSum(ticks_.left, action.encoderLeftTicks);
		ticks_.right = wrappingSum(ticks_.right, action.encoderRightTicks);
		odometry->encoderLeftTicks = ticks_.left;
		odometry->encoderRightTicks = ticks_.right;
	}
	return odometry;
}
}  // namespace viwo
