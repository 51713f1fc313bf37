#pragma once

#include <viwo/core/CameraModel.h>
#include <viwo/core/Pose3.h>

#include <optional>
#include <string>

namespace viwo
{
struct KalibrCamera
{
	CameraModel model;
	std::optional<Pose3> T_CB;  //!< Kalibr's T_cam_imu; not of a camchain without an IMU
	double time_offset_s = 0;   //!< Kalibr's timeshift_cam_imu: t_IMU = t_CAM + this
};

/** One camera of Kalibr's camchain. @throws Error naming file, camera and key. */
KalibrCamera readKalibrCamera(const std::string& path, const std::string& camera);

/** What ROS's camera_calibration writes. @throws Error naming file and key. */
CameraModel readRosCameraInfo(const std::string& path);

/** The section [CAMERA_PARAMS] of MRPT's camera-calib. @throws Error naming the file. */
CameraModel readMrptCamera(const std::string& path);
}  // namespace viwo
