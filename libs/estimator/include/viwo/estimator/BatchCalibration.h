#pragma once

#include <viwo/core/Calibration.h>
#include <viwo/core/FeatureFrame.h>
#include <viwo/core/ImuSample.h>
#include <viwo/core/Options.h>
#include <viwo/core/Trajectory.h>
#include <viwo/core/WheelSample.h>
#include <viwo/estimator/EstimatorOptions.h>

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

namespace viwo
{
/** Section [calibration]: what is known beforehand, each as a standard deviation. */
struct BatchCalibrationOptions : Options<BatchCalibrationOptions>
{
	double wheel_scale = 0.03;
	double track_relative = 0.04;
	double rotation_deg = 1.5;
	double lever_m = 0.03;
	double time_offset_s = 0.03;
	double acc_scale = 0.0012;
	double gyro_scale = 0.0006;
	double imu_misalignment_deg = 0.03;
	double floor_tilt_deg = 0.3;
	double floor_height_m = 0.003;
	double floor_patch_m = 1;
	double reference_position_m = 0.02;
	double reference_rotation_deg = 0.5;
	double reference_time_s = 0.1;
	double keyframe_period_s = 0.2;
	double standing_period_s = 1;
	double slip_share = 0.1;
	int max_rounds = 8;

	template <class Visitor>
	void visit(Visitor& v)
	{
		v("wheel_scale", wheel_scale, "of the start: scale of each wheel", 1e-6, 0.5);
		v("track_relative", track_relative, "of the start: track, relative", 1e-6, 0.5);
		v("rotation_deg", rotation_deg, "of the start: how IMU and camera are turned, each axis", 1e-4, 20.0);
		v("lever_m", lever_m, "of the start: where IMU and camera sit, each axis", 1e-5, 1.0);
		v("time_offset_s", time_offset_s, "of the start: both clocks against the IMU's", 1e-6, 0.2);
		v("acc_scale", acc_scale, "scale of each axis of the accelerometer: without a reference, the wheels' scale is no better known", 0.0,
		  0.1);
		v("gyro_scale", gyro_scale, "scale of each axis of the gyroscope", 0.0, 0.1);
		v("imu_misalignment_deg", imu_misalignment_deg, "of each sensing axis of both", 0.0, 5.0);
		v("floor_tilt_deg", floor_tilt_deg, "slope of the floor's unevenness", 1e-3, 45.0);
		v("floor_height_m", floor_height_m, "and its height", 1e-5, 1.0);
		v("floor_patch_m", floor_patch_m, "distance over which both stay what they are", 1e-2, 100.0);
		v("reference_position_m", reference_position_m, "of each pose of the reference", 1e-5, 10.0);
		v("reference_rotation_deg", reference_rotation_deg, "of each pose of the reference", 1e-4, 45.0);
		v("reference_time_s", reference_time_s, "of the reference's clock against the IMU's", 1e-6, 1.0);
		v("keyframe_period_s", keyframe_period_s, "between two images in use", 0.02, 2.0);
		v("standing_period_s", standing_period_s, "the same while the robot stands", 0.02, 3.0);
		v("slip_share", slip_share, "wheels that contradict camera and IMU for more than this share of the log: nothing is given", 0.0,
		  1.0);
		v("max_rounds", max_rounds, "times that the samples are cut anew at the clock offsets found so far", 2, 50);
	}
};

/** Where the sensors sit, how large the wheels are, and how the clocks go. */
struct SensorRig
{
	Pose3 T_BO, T_BC;
	WheelIntrinsics wheels;
	double camera_offset_s = 0;  //!< t_d: t_IMU = t_CAM + t_d
	double wheel_offset_s = 0;   //!< t_w: t_IMU = t_WHEEL + t_w
};

/** The order of everything that is estimated of a rig. Lever arms (m): T_OB.p, and R_OB T_BC.p, which is from the IMU to the camera along
 * the robot's axes: on a plane the vertical parts of both, and nothing else of them, are hidden. Rotations (rad): right perturbations of
 * T_BO, and of T_BC turned into the robot's axes. */
struct RigOrder
{
	enum : int
	{
		left_scale = 0,
		right_scale = 1,
		track = 2,
		imu_lever = 3,
		imu_rotation = 6,
		camera_lever = 9,
		camera_rotation = 12,
		camera_offset = 15,
		wheel_offset = 16,
		size = 17
	};
	/** "left_scale", "imu_x", "camera_yaw", ... */
	static const std::vector<std::string>& names();
};
using RigVector = Eigen::Matrix<double, RigOrder::size, 1>;

/** a [-] b in RigOrder. */
RigVector rigDifference(const SensorRig& a, const SensorRig& b);
/** b [+] difference. */
SensorRig rigPlus(const SensorRig& b, const RigVector& difference);
/** What a drive has recorded, and what is thought of the rig. */
struct BatchCalibrationInput
{
	std::vector<FeatureFrame> frames;  //!< stamps of the camera's clock
	std::vector<ImuSample> imu;
	std::vector<WheelSample> wheels;  //!< stamps of the wheels' clock, nominal radii
	CameraModel camera;
	SensorRig start;
	Trajectory reference;  //!< T_RO with R any frame at rest; empty: none
};

/** Residuals of one kind at one frame: of the images (px), of the interval that ends there (wheels: mm and mrad). */
struct CalibrationMisfit
{
	double t_s = 0;  //!< since the first frame
	double image_px = 0, wheel_forward_mm = 0, wheel_sideways_mm = 0, wheel_yaw_mrad = 0;
};
/** Residuals of the whole drive. */
struct CalibrationQuality
{
	std::vector<CalibrationMisfit> frames;
	double image_px = 0;  //!< root mean square, and so on
	double wheel_forward_mm = 0, wheel_sideways_mm = 0, wheel_yaw_mrad = 0;
	double reference_mm = 0;  //!< 0 without a reference
};
/** What was found, how sure it is, and how well it explains the drive. */
struct BatchCalibrationResult
{
	std::string problem;  //!< empty, or what is wrong and the remedy; then the rest is not to be used
	SensorRig rig;
	RigVector deviations = RigVector::Zero(), prior_deviations = RigVector::Zero();
	Eigen::Matrix<bool, RigOrder::size, 1> observed = Eigen::Matrix<bool, RigOrder::size, 1>::Constant(false);
	/** With the start's rig, all else at its best, and with the one that was found. */
	CalibrationQuality before, after;
	std::vector<std::string> notes;  //!< what makes the result doubtful, a sentence each
	double pixel_sigma_px = 0;       //!< as the residuals say
	double wheel_noise_ratio = 1;    //!< of the wheels' noise to the configured one
	double slip_s = 0;
	int keyframes = 0, landmarks = 0, rounds = 0;
};

/** Estimates the rig from a whole log at once: poses, velocities and biases of all key frames, landmarks, the floor, sensitivities of the
 *  IMU's axes within their tolerance, and the rig, by least squares (Niu et al. Eq. 15 over all frames). The deviations are those of the
 *  normal equations, with noise of images and wheels as their own residuals tell it. Deterministic; throws nothing.
 *  @param progress fraction done and what is going on; false stops it. May be empty.
 */
BatchCalibrationResult calibrateInBatch(const BatchCalibrationInput& input, const BatchCalibrationOptions& options,
                                        const EstimatorOptions& estimator,
                                        const std::function<bool(double fraction, const std::string& note)>& progress = {});
}  // namespace viwo
