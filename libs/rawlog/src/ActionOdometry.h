#pragma once

#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <viwo/rawlog/EncoderTicks.h>

#include <string>

namespace viwo
{
/** Accumulates the increments of odometry actions into the absolute readings of CObservationOdometry. */
class ActionOdometry
{
   public:
	explicit ActionOdometry(std::string label) : label_(std::move(label)) {}

	mrpt::obs::CObservationOdometry::Ptr add(const mrpt::obs::CActionRobotMovement2D& action);

   private:
	std::string label_;
	mrpt::poses::CPose2D pose_;
	EncoderTicks ticks_;
};
}  // namespace viwo
