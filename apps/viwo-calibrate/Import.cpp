#include <viwo/app/Program.h>
#include <viwo/core/MrptPose.h>
#include <viwo/importers/CalibrationFiles.h>

#include <cmath>
#include <cstdio>
#include <memory>

#include "Command.h"

namespace viwo::calibrate
{
namespace
{
struct Arguments
{
	CalibrationFiles files;
	std::vector<double> odom;
	std::string output;
};

void declare(CLI::App& command, Arguments& a)
{
	command.add_option("--kalibr", a.files.kalibr_camchain, "Kalibr's camchain-imucam.yaml (or camchain.yaml: the camera alone)")
	    ->type_name("FILE.yaml");
	command.add_option("--camera", a.files.kalibr_camera, "Which camera of the camchain")->capture_default_str();
	command.add_option("--imu", a.files.kalibr_imu, "Kalibr's imu.yaml: noise")->type_name("FILE.yaml");
	command.add_option("--ros", a.files.ros_camera_info, "YAML of ROS's camera_calibration: the camera alone")->type_name("FILE.yaml");
	command.add_option("--mrpt", a.files.mrpt_camera, "INI of MRPT's camera-calib: the camera alone")->type_name("FILE.ini");
	command.add_option("--odom", a.odom, "T_BO, the robot in the IMU's frame: x y z (m) yaw pitch roll (deg)")
	    ->expected(6)
	    ->check(app::finite());
	command.add_option("--cam-label", a.files.cam_label, "Label of the images in the rawlogs")
	    ->capture_default_str()
	    ->check(app::notEmpty());
	command.add_option("--imu-label", a.files.imu_label, "Label of the IMU in the rawlogs")->capture_default_str()->check(app::notEmpty());
	command.add_option("-o,--output", a.output, "The rig.ini")->type_name("FILE.ini")->required()->check(app::notEmpty());
}

void print(const std::string& path, const ImportedRig& imported)
{
	const RigFile& rig = imported.rig;
	std::printf("%s:", path.c_str());
	if (rig.camera)
		std::printf(" camera %s %.0fx%.0f, fx %.2f px, t_IMU = t_CAM %+.6f s", rig.camera->mounting.label.c_str(),
		            rig.camera->resolution_px[0], rig.camera->resolution_px[1], rig.camera->fx_px, rig.camera->time_offset_s);
	if (rig.imu)
		std::printf("%s IMU %s at %.4f %.4f %.4f m", rig.camera ? ";" : "", rig.imu->mounting.label.c_str(), rig.imu->mounting.x_m,
		            rig.imu->mounting.y_m, rig.imu->mounting.z_m);
	std::printf("\n");
	std::fflush(stdout);
	app::tellNotes(imported.warnings);
}

int importFiles(Arguments& a)
{
	constexpr double kDegree = M_PI / 180;
	const auto& t = a.odom;
	if (!t.empty()) a.files.T_BO = fromMrpt({t[0], t[1], t[2], t[3] * kDegree, t[4] * kDegree, t[5] * kDegree});
	if (a.files.kalibr_camchain.empty() && a.files.kalibr_imu.empty() && a.files.ros_camera_info.empty() && a.files.mrpt_camera.empty())
		throw app::UsageError("import: give one or more of --kalibr, --imu, --ros, --mrpt");
	const ImportedRig imported = importCalibration(a.files);
	imported.rig.save(a.output, "Calibration of a robot's sensors, made by viwo-calibrate " + app::version() +
	                                ". For viwo-odometry --rig, and rawlog-edit --camera-params LABEL,FILE and --sensors-pose FILE.");
	print(a.output, imported);
	return 0;
}
}  // namespace

Command addImport(CLI::App& cli)
{
	const auto arguments = std::make_shared<Arguments>();
	CLI::App* const command = cli.add_subcommand("import", "Calibration files of Kalibr, ROS or MRPT as a rig.ini");
	declare(*command, *arguments);
	command->footer(
	    "Examples:\n"
	    "  viwo-calibrate import --kalibr camchain-imucam.yaml --imu imu.yaml --odom 0 0.3 -0.1 90 -90 0 -o rig.ini\n"
	    "  viwo-calibrate import --ros left.yaml -o camera.ini\n"
	    "--odom of the first: an IMU with a camera's axes (x right, y down, z forward), 0.3 m above the robot's origin and 0.1 m ahead of "
	    "it.");
	return {command, [arguments] { return importFiles(*arguments); }};
}
}  // namespace viwo::calibrate
