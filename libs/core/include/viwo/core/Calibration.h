#pragma once

#include <viwo/core/CameraModel.h>
#include <viwo/core/Pose3.h>
#include <viwo/core/WheelSample.h>

namespace viwo
{
/** Where the sensors sit on the robot and what they are. O is MRPT's vehicle frame: `sensorPose` of a rawlog is T_OB and T_OC. */
struct Calibration
{
	Pose3 T_OB;  //!< IMU body in O
	Pose3 T_OC;  //!< camera in O, optical axes
	CameraModel camera;
	WheelIntrinsics wheels;  //!< nominal; k_left = k_right = 1 unless calibrated

	Pose3 T_BO() const { return T_OB.inverse(); }
	Pose3 T_BC() const { return T_OB.inverse() * T_OC; }
};
}  // namespace viwo
