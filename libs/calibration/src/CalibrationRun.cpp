#include <viwo/calibration/CalibrationRun.h>
#include <viwo/core/Error.h>
#include <viwo/core/Scalars.h>
#include <viwo/core/Time.h>
#include <viwo/rawlog/RawlogReader.h>

#include <chrono>

#include "LogContent.h"

namespace viwo
{
namespace
{
struct RowText
{
	const char* what;
	const char* unit;
	double factor;
};

/** In RigOrder. */
constexpr RowText kRows[RigOrder::size] = {{"left wheel, true over nominal radius", "", 1},
                                           {"right wheel, true over nominal radius", "", 1},
                                           {"track", "mm", 1e3},
                                           {"IMU on the robot, x (forward)", "mm", 1e3},
                                           {"IMU on the robot, y (left)", "mm", 1e3},
                                           {"IMU on the robot, z (up)", "mm", 1e3},
                                           {"IMU turned about x (roll), from the start", "deg", 1 / kDegree},
                                           {"IMU turned about y (pitch), from the start", "deg", 1 / kDegree},
                                           {"IMU turned about z (yaw), from the start", "deg", 1 / kDegree},
                                           {"camera from IMU, x (forward)", "mm", 1e3},
                                           {"camera from IMU, y (left)", "mm", 1e3},
                                           {"camera from IMU, z (up)", "mm", 1e3},
                                           {"camera turned against the IMU about x (roll), from the start", "deg", 1 / kDegree},
                                           {"camera turned against the IMU about y (pitch), from the start", "deg", 1 / kDegree},
                                           {"camera turned against the IMU about z (yaw), from the start", "deg", 1 / kDegree},
                                           {"clock, t_IMU = t_CAM +", "ms", 1e3},
                                           {"clock, t_IMU = t_WHEEL +", "ms", 1e3}};

/** A rig's figures as its file tells them; turns are against `origin`. */
RigVector figuresOf(const SensorRig& rig, const SensorRig& origin)
{
	const RigVector moved = rigDifference(rig, origin);
	const Pose3 T_OB = rig.T_BO.inverse();
	RigVector v;
	// The IMU turns on the robot the other way round than the robot at the IMU.
	v << rig.wheels.k_left, rig.wheels.k_right, rig.wheels.track_m, T_OB.p, -moved.segment<3>(RigOrder::imu_rotation), T_OB.R * rig.T_BC.p,
	    moved.segment<3>(RigOrder::camera_rotation), rig.camera_offset_s, rig.wheel_offset_s;
	return v;
}

std::vector<CalibrationRow> rowsOf(const BatchCalibrationResult& batch, const SensorRig& start)
{
	const RigVector before = figuresOf(start, start), after = figuresOf(batch.rig, start);
	std::vector<CalibrationRow> rows;
	for (int i = 0; i < RigOrder::size; ++i)
	{
		const RowText& text = kRows[i];
		rows.push_back({RigOrder::names()[static_cast<size_t>(i)], text.what, text.unit, text.factor * before[i], text.factor * after[i],
		                text.factor * batch.deviations[i], batch.observed[i]});
	}
	return rows;
}

/** Labels and noise are those of the start, or of the configuration. */
RigFile rigOf(const CalibrationRunOptions& options, const SensorRig& found, const CameraModel& camera)
{
	RigFile rig = options.start ? *options.start : RigFile();
	const AdapterOptions& labels = options.odometry.rawlog;
	const Pose3 T_OB = found.T_BO.inverse();
	if (!rig.camera) rig.camera = RigCamera();
	rig.camera->mounting.label = labels.cam_label;
	rig.camera->setModel(camera);
	rig.camera->mounting.setPose(T_OB * found.T_BC);
	rig.camera->time_offset_s = found.camera_offset_s;
	if (!rig.imu) rig.imu = RigImu();
	rig.imu->mounting.label = labels.imu_label;
	rig.imu->mounting.setPose(T_OB);
	if (!rig.wheels) rig.wheels = RigWheels();
	rig.wheels->mounting.label = labels.odometry_label;
	rig.wheels->left_scale = found.wheels.k_left;
	rig.wheels->right_scale = found.wheels.k_right;
	rig.wheels->calibrated_track_m = found.wheels.track_m;
	rig.wheels->time_offset_s = found.wheel_offset_s;
	return rig;
}
}  // namespace

std::vector<OptionsSection> CalibrationRunOptions::sections()
{
	std::vector<OptionsSection> all = odometry.sections();
	all.push_back({"calibration", &calibration});
	return all;
}

CalibrationRunResult runCalibration(const CalibrationRunOptions& options, const CalibrationRunHooks& hooks)
{
	const auto begin = std::chrono::steady_clock::now();
	CalibrationRunResult result;
	result.rawlogs = rawlogNames(options.rawlogs);
	result.reference = options.reference;
	result.from_s = options.from_s;
	Trajectory reference;
	if (!options.reference.empty()) reference = Trajectory::loadTum(options.reference);
	BatchCalibrationInput input = readLog(options, hooks);
	input.reference = std::move(reference);
	result.start = input.start;
	if (!input.frames.empty()) result.duration_s = secondsBetween(input.frames.front().t_ns, input.frames.back().t_ns);
	const auto progress = [&](double fraction, const std::string& note)
	{
		if (hooks.progress) hooks.progress(0.5 + 0.5 * fraction, note);
		return !(hooks.interrupted && hooks.interrupted());
	};
	result.batch = calibrateInBatch(input, options.calibration, options.odometry.estimator, progress);
	const bool interrupted = hooks.interrupted && hooks.interrupted();
	if (!result.batch.problem.empty())
		throw Error(result.rawlogs + ": " + result.batch.problem + (interrupted ? ", nothing was written" : ""));
	result.rows = rowsOf(result.batch, result.start);
	result.rig = rigOf(options, result.batch.rig, input.camera);
	result.wall_time_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
	return result;
}
}  // namespace viwo
