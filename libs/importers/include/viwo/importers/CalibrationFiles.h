#pragma once

#include <viwo/rawlog/RigFile.h>

#include <optional>
#include <string>
#include <vector>

namespace viwo
{
/** Calibration files of other programs that together make a rig; those whose name is empty are not there. */
struct CalibrationFiles
{
	std::string kalibr_camchain;         //!< Kalibr's camchain.yaml, or camchain-imucam.yaml with the IMU
	std::string kalibr_camera = "cam0";  //!< which of its cameras
	std::string kalibr_imu;              //!< Kalibr's imu.yaml
	std::string ros_camera_info;         //!< as camera_calibration writes it
	std::string mrpt_camera;             //!< INI of MRPT's camera-calib
	/** The robot in the IMU's frame, without which the camera is taken to look ahead from the robot's origin. */
	std::optional<Pose3> T_BO;
	std::string cam_label = "CAM", imu_label = "IMU";
};

/** A rig made of files of other programs. */
struct ImportedRig
{
	RigFile rig;
	/** One line each: what was assumed, noise that no IMU has. */
	std::vector<std::string> warnings;
};

/** Kalibr's conventions are those of its documentation: T_cam_imu = T_CB takes points from the IMU's frame to the camera's, and
 *  t_imu = t_cam + timeshift_cam_imu.
 *  @throws Error naming file and key: unreadable files, cameras that are not pinhole, two files that both give the camera, none at all.
 */
ImportedRig importCalibration(const CalibrationFiles& files);
}  // namespace viwo
