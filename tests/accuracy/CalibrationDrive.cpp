#include "CalibrationDrive.h"

#include <viwo/core/Scalars.h>
#include <viwo/rawlog/RigFile.h>
#include <viwo/sim/Motion.h>
#include <viwo/sim/Rig.h>

#include <filesystem>
#include <random>

namespace viwo::accuracy
{
namespace
{
struct Simulated
{
	sim::Rig rig;
	sim::Route route;
};

Simulated load(const SimulatedDrive& drive)
{
	Simulated s;
	sim::loadRun(drive.rigPath(), drive.routePath(), drive.overrides, s.rig, s.route);
	return s;
}
}  // namespace

SimulatedDrive calibrationDrive()
{
	return {"calibration", "lobby", "calibration", {"lidar.enabled=false", "camera.time_offset_ms=12", "wheels.clock_offset_ms=-8"}};
}

SensorRig trueRig(const SimulatedDrive& drive, uint64_t seed)
{
	const Simulated s = load(drive);
	const Calibration c = s.rig.actualCalibration(sim::Motion(s.route), seed);
	return {c.T_BO(), c.T_BC(), c.wheels, 1e-3 * s.rig.camera.time_offset_ms, 1e-3 * s.rig.wheels.clock_offset_ms};
}

SensorRig wrongRig(const SensorRig& truth, uint64_t seed)
{
	std::mt19937_64 generator(seed);
	const auto either = [&](double size) { return (generator() & 1) != 0 ? size : -size; };
	constexpr double kScale = 0.02, kTrack = 0.03, kLever_m = 0.02, kTurn_rad = kDegree, kOffset_s = 0.02;
	RigVector d;
	d[RigOrder::left_scale] = d[RigOrder::right_scale] = either(kScale);
	d[RigOrder::track] = either(kTrack * truth.wheels.track_m);
	for (int axis = 0; axis < 3; ++axis)
	{
		d[RigOrder::imu_lever + axis] = axis == 2 ? 0 : either(kLever_m);
		d[RigOrder::imu_rotation + axis] = either(kTurn_rad);
		d[RigOrder::camera_lever + axis] = either(kLever_m);
		d[RigOrder::camera_rotation + axis] = either(kTurn_rad);
	}
	d[RigOrder::camera_offset] = either(kOffset_s);
	d[RigOrder::wheel_offset] = either(kOffset_s);
	return rigPlus(truth, d);
}

std::string saveRig(const Settings& settings, const SimulatedDrive& drive, const SensorRig& rig, const std::string& name)
{
	const Simulated s = load(drive);
	const Pose3 T_OB = rig.T_BO.inverse();
	RigFile file{RigCamera(), RigImu(), RigWheels()};
	file.camera->setModel(s.rig.camera.model());
	file.camera->mounting.setPose(T_OB * rig.T_BC);
	file.camera->time_offset_s = rig.camera_offset_s;
	file.imu->mounting.setPose(T_OB);
	file.wheels->left_scale = rig.wheels.k_left;
	file.wheels->right_scale = rig.wheels.k_right;
	file.wheels->calibrated_track_m = rig.wheels.track_m;
	file.wheels->time_offset_s = rig.wheel_offset_s;
	std::filesystem::create_directories(settings.folder + "/rigs");
	const std::string path = settings.folder + "/rigs/" + name + ".ini";
	file.save(path, "A rig for the drive " + drive.name);
	return path;
}

SensorRig loadRig(const std::string& path)
{
	const RigFile file = RigFile::load(path);
	if (!file.camera || !file.imu || !file.wheels) throw Error(path + ": not a whole rig");
	const Pose3 T_BO = file.imu->mounting.pose().inverse();
	const RigWheels& w = *file.wheels;
	return {T_BO,
	        T_BO * file.camera->mounting.pose(),
	        {w.left_scale, w.right_scale, w.calibrated_track_m},
	        file.camera->time_offset_s,
	        w.time_offset_s};
}
}  // namespace viwo::accuracy
