#include "ActionOdometry.h"

namespace viwo
{
namespace
{
/** As an encoder's register: wraps around instead of overflowing. */
int32_t wrappingSum(int32_t a, int32_t b)
{
	return static_cast<int32_t>(static_cast<uint32_t>(a) + static_cast<uint32_t>(b));
}
}  // namespace

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
		left_ticks_ = wrappingSum(left_ticks_, action.encoderLeftTicks);
		right_ticks_ = wrappingSum(right_ticks_, action.encoderRightTicks);
		odometry->encoderLeftTicks = left_ticks_;
		odometry->encoderRightTicks = right_ticks_;
	}
	return odometry;
}
}  // namespace viwo
