#include <viwo/core/Error.h>
#include <viwo/importers/CalibrationFiles.h>

#include "CameraFiles.h"
#include "ImuNoise.h"

namespace viwo
{
namespace
{
KalibrCamera cameraOf(const CalibrationFiles& files)
{
	const int given = !files.kalibr_camchain.empty() + !files.ros_camera_info.empty() + !files.mrpt_camera.empty();
	if (given > 1) throw Error("more than one file for the camera: give one of a Kalibr camchain, a ROS camera_info and an MRPT camera");
	if (!files.kalibr_camchain.empty()) return readKalibrCamera(files.kalibr_camchain, files.kalibr_camera);
	KalibrCamera camera;
	camera.model = files.ros_camera_info.empty() ? readMrptCamera(files.mrpt_camera) : readRosCameraInfo(files.ros_camera_info);
	return camera;
}

/** Where the IMU sits on the robot. */
Pose3 mountingOfImu(const CalibrationFiles& files, const std::optional<Pose3>& T_CB, std::vector<std::string>& warnings)
{
	if (files.T_BO) return files.T_BO->inverse();
	const Pose3 T_OC(forwardOpticalAxes(), Eigen::Vector3d::Zero());
	warnings.push_back(
	    T_CB ? "the pose of the sensors on the robot is not known: the camera is taken to look straight ahead from the robot's "
	           "origin; give --odom, or measure pose_x ... pose_roll"
	         : "the poses of the sensors on the robot are not known: correct pose_x ... pose_roll");
	return T_CB ? T_OC * *T_CB : Pose3();
}
}  // namespace

ImportedRig importCalibration(const CalibrationFiles& files)
{
	const bool has_camera = !files.kalibr_camchain.empty() || !files.ros_camera_info.empty() || !files.mrpt_camera.empty();
	if (!has_camera && files.kalibr_imu.empty()) throw Error("no calibration file was given");
	ImportedRig result;
	const KalibrCamera camera = has_camera ? cameraOf(files) : KalibrCamera();
	const Pose3 T_OB = mountingOfImu(files, camera.T_CB, result.warnings);
	if (has_camera)
	{
		RigCamera& rig = result.rig.camera.emplace();
		rig.mounting.label = files.cam_label;
		rig.setModel(camera.model);
		rig.mounting.setPose(camera.T_CB ? T_OB * camera.T_CB->inverse() : Pose3(forwardOpticalAxes(), Eigen::Vector3d::Zero()));
		rig.time_offset_s = camera.time_offset_s;
		if (!camera.T_CB && files.T_BO)
			result.warnings.push_back("the camera's pose is not in its file: correct pose_x ... pose_roll of [CAMERA_PARAMS]");
	}
	if (!files.kalibr_imu.empty() || camera.T_CB)
	{
		RigImu& rig = result.rig.imu.emplace();
		if (!files.kalibr_imu.empty()) rig = readKalibrImu(files.kalibr_imu, result.warnings);
		rig.mounting.label = files.imu_label;
		rig.mounting.setPose(T_OB);
	}
	return result;
}
}  // namespace viwo
