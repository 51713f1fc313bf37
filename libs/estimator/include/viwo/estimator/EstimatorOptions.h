#pragma once

#include <viwo/core/ImuSample.h>
#include <viwo/core/Options.h>
#include <viwo/core/WheelSample.h>
#include <viwo/estimator/InitializerOptions.h>

#include <string>
#include <vector>

namespace viwo
{
/** What is fused: wheel = dead reckoning on wheels alone, wio = wheels + IMU, vio = camera + IMU, viwo = all three. */
enum class Mode
{
	wheel,
	wio,
	vio,
	viwo
};

inline const std::vector<std::string>& modeNames()
{
	static const std::vector<std::string> names{"wheel", "wio", "vio", "viwo"};
	return names;
}

/** One switch per factor, so that each can be ablated. Those that the mode has no sensor for are off whatever they say. */
struct FactorOptions : Options<FactorOptions>
{
	bool wheel_factor = true;
	bool plane_factor = true;
	bool plane_pairwise = false;
	bool wheels_in_initialization = true;
	bool slip_gate = true;
	bool standstill_factor = true;
	bool estimate_wheel_intrinsics = true;
	bool estimate_T_BC = true;
	bool estimate_T_BO = false;
	bool estimate_camera_time_offset = false;
	bool estimate_wheel_time_offset = false;

	template <class Visitor>
	void visit(Visitor& v)
	{
		v("wheel_factor", wheel_factor, "wheel preintegration between frames (paper Eq. 19)");
		v("plane_factor", plane_factor, "planar motion (paper Eq. 20, as a plane state)");
		v("plane_pairwise", plane_pairwise, "the paper's form: each frame against the oldest, instead of a plane state");
		v("wheels_in_initialization", wheels_in_initialization,
		  "start from wheels at once, and wheel rows in the alignment (paper Sec. 5)");
		v("slip_gate", slip_gate, "inflate a wheel factor that contradicts gyro or prediction");
		v("standstill_factor", standstill_factor, "zero-velocity factor when wheels and gyro are quiet");
		v("estimate_wheel_intrinsics", estimate_wheel_intrinsics, "left and right scale and track as states");
		v("estimate_T_BC", estimate_T_BC, "camera-IMU extrinsics as a state");
		v("estimate_T_BO", estimate_T_BO, "where the wheels sit against the IMU as a state, once the motion shows it (not its z)");
		v("estimate_camera_time_offset", estimate_camera_time_offset,
		  "t_IMU - t_CAM as a state, on top of camera_time_offset_s, once the motion shows it");
		v("estimate_wheel_time_offset", estimate_wheel_time_offset,
		  "t_IMU - t_WHEEL as a state, on top of wheel_time_offset_s, once the motion shows it");
	}
};

/** Measurement noise; densities as in Kalibr's imu.yaml. */
struct NoiseOptions : Options<NoiseOptions>
{
	ImuNoise imu;
	WheelNoise wheels;
	double pixel_sigma_px = 1;
	double start_pixel_sigma_px = 0.3;
	double gravity_m_s2 = 9.81;

	template <class Visitor>
	void visit(Visitor& v)
	{
		v("acc_noise_m_s2_sqrtHz", imu.acc_noise_m_s2_sqrtHz, "accelerometer white noise density", 1e-8, 10.0);
		v("gyro_noise_rad_s_sqrtHz", imu.gyro_noise_rad_s_sqrtHz, "gyroscope white noise density", 1e-9, 10.0);
		v("acc_walk_m_s3_sqrtHz", imu.acc_walk_m_s3_sqrtHz, "accelerometer bias random walk", 1e-9, 10.0);
		v("gyro_walk_rad_s2_sqrtHz", imu.gyro_walk_rad_s2_sqrtHz, "gyroscope bias random walk", 1e-10, 10.0);
		v("wheel_s0_m_s_sqrtHz", wheels.s0_m_s_sqrtHz, "speed noise density of each wheel at rest", 1e-6, 10.0);
		v("wheel_k_sqrtHz", wheels.k_sqrtHz, "its growth with speed", 0.0, 10.0);
		v("wheel_lateral_m_s_sqrtHz", wheels.lateral_m_s_sqrtHz, "side slip", 1e-6, 10.0);
		v("wheel_vertical_m_s_sqrtHz", wheels.vertical_m_s_sqrtHz, "vertical motion", 1e-6, 10.0);
		v("wheel_tilt_rad_s_sqrtHz", wheels.tilt_rad_s_sqrtHz, "roll and pitch rates", 1e-6, 10.0);
		v("pixel_sigma_px", pixel_sigma_px, "of a tracked corner, with the error of its first sighting, which all others share", 0.01,
		  20.0);
		v("start_pixel_sigma_px", start_pixel_sigma_px, "of a corner from one image to the next: the vision start and standstill", 0.01,
		  20.0);
		v("gravity_m_s2", gravity_m_s2, "|g| where the robot drives", 9.7, 9.9);
	}
};

/** Standard deviations before any measurement, and of the floor. */
struct PriorOptions : Options<PriorOptions>
{
	double acc_bias_m_s2 = 0.1;
	double gyro_bias_rad_s = 0.01;
	double T_BC_rotation_deg = 1.0;
	double T_BC_translation_m = 0.01;
	double T_BO_rotation_deg = 1.0;
	double T_BO_translation_m = 0.02;
	double camera_clock_s = 0.02;
	double wheel_clock_s = 0.02;
	double wheel_scale = 0.01;
	double track_relative = 0.01;
	double velocity_m_s = 0.1;
	double inverse_depth_mean_1_m = 0.25;
	double inverse_depth_sigma_1_m = 5;
	double plane_tilt_deg = 1.0;
	double plane_factor_tilt_deg = 0.5;
	double plane_factor_height_m = 0.004;
	double plane_walk_tilt_deg_sqrtm = 0.05;
	double plane_walk_height_m_sqrtm = 0.001;
	double standstill_velocity_m_s = 1e-3;

	template <class Visitor>
	void visit(Visitor& v)
	{
		v("acc_bias_m_s2", acc_bias_m_s2, "accelerometer bias", 1e-6, 10.0);
		v("gyro_bias_rad_s", gyro_bias_rad_s, "gyroscope bias", 1e-7, 1.0);
		v("T_BC_rotation_deg", T_BC_rotation_deg, "camera-IMU rotation", 1e-4, 45.0);
		v("T_BC_translation_m", T_BC_translation_m, "camera-IMU lever arm", 1e-5, 1.0);
		v("T_BO_rotation_deg", T_BO_rotation_deg, "rotation of the wheels against the IMU, where it is estimated", 1e-4, 45.0);
		v("T_BO_translation_m", T_BO_translation_m, "their lever arm, likewise (x and y of O; z stays as it is)", 1e-5, 1.0);
		v("camera_clock_s", camera_clock_s, "camera clock against the IMU's, likewise", 1e-6, 0.2);
		v("wheel_clock_s", wheel_clock_s, "wheel clock against the IMU's, likewise", 1e-6, 0.2);
		v("wheel_scale", wheel_scale, "scale of each wheel, relative", 1e-6, 0.5);
		v("track_relative", track_relative, "track, relative", 1e-6, 0.5);
		v("velocity_m_s", velocity_m_s, "velocity at the start", 1e-4, 100.0);
		v("inverse_depth_mean_1_m", inverse_depth_mean_1_m, "of a landmark not yet triangulated", 1e-3, 10.0);
		v("inverse_depth_sigma_1_m", inverse_depth_sigma_1_m, "its deviation: wide, since a prior on depth would be one on scale", 1e-2,
		  100.0);
		v("plane_tilt_deg", plane_tilt_deg, "tilt of the floor against gravity at the start", 1e-3, 45.0);
		v("plane_factor_tilt_deg", plane_factor_tilt_deg, "roll and pitch of the robot on its floor, correlated over about a metre", 1e-3,
		  45.0);
		v("plane_factor_height_m", plane_factor_height_m, "height of the robot over its floor", 1e-5, 10.0);
		v("plane_walk_tilt_deg_sqrtm", plane_walk_tilt_deg_sqrtm, "change of the floor's tilt with the distance driven", 1e-6, 45.0);
		v("plane_walk_height_m_sqrtm", plane_walk_height_m_sqrtm, "change of the floor's height with the distance driven", 1e-7, 10.0);
		v("standstill_velocity_m_s", standstill_velocity_m_s, "velocity while standing", 1e-6, 1.0);
	}
};

/** The sliding window: its size, its solver, its gates. */
struct WindowOptions : Options<WindowOptions>
{
	int keyframes = 10;
	double keyframe_parallax_px = 10;
	int keyframe_min_tracked = 20;
	double max_interval_s = 3;
	int max_iterations = 6;
	double huber_px = 1.5;
	double outlier_px = 5;
	double slip_gate_sigma = 5;
	double slip_gate_window_s = 1;
	double start_after_s = 0.75;
	double max_imu_gap_s = 0.1;
	double max_wheel_gap_s = 0.3;
	double reinitialize_after_gap_s = 1.0;
	double dead_reckoning_after_s = 0.5;
	int tracking_min_landmarks = 20;
	double tracking_depth_deviation = 0.3;

	template <class Visitor>
	void visit(Visitor& v)
	{
		v("keyframes", keyframes, "in the window, beside the latest frame", 3, 40);
		v("keyframe_parallax_px", keyframe_parallax_px, "mean parallax, rotation removed, that makes a keyframe (at 460 px focal length)",
		  0.5, 500.0);
		v("keyframe_min_tracked", keyframe_min_tracked, "fewer tracks than this make a keyframe", 0, 1000);
		v("max_interval_s", max_interval_s, "longest preintegration interval while standing", 0.2, 60.0);
		v("max_iterations", max_iterations, "of the solver for one frame", 1, 100);
		v("huber_px", huber_px, "reprojection error where the Huber loss turns linear", 0.1, 100.0);
		v("outlier_px", outlier_px, "mean reprojection error above which a landmark is thrown out", 0.5, 100.0);
		v("slip_gate_sigma", slip_gate_sigma, "wheel against gyro and prediction", 2.0, 100.0);
		v("slip_gate_window_s", slip_gate_window_s, "longest time over which they are compared", 0.05, 10.0);
		v("start_after_s", start_after_s, "data gathered before the first pose when starting from wheels", 0.1, 10.0);
		v("max_imu_gap_s", max_imu_gap_s, "longest hole in the IMU stream that is interpolated", 0.001, 10.0);
		v("max_wheel_gap_s", max_wheel_gap_s, "longest hole in the wheel stream that is bridged", 0.001, 10.0);
		v("reinitialize_after_gap_s", reinitialize_after_gap_s, "a longer hole in the IMU stream starts anew, in the same world frame", 0.1,
		  1000.0);
		v("dead_reckoning_after_s", dead_reckoning_after_s, "without enough landmarks before the status says so", 0.0, 1000.0);
		v("tracking_min_landmarks", tracking_min_landmarks, "landmarks of known depth for status tracking", 1, 1000);
		v("tracking_depth_deviation", tracking_depth_deviation, "relative deviation of inverse depth that counts as known", 0.01, 1.0);
	}
};
/** All options of the estimator, in their sections. */
struct EstimatorOptions
{
	Mode mode = Mode::viwo;
	FactorOptions factors;
	NoiseOptions noise;
	PriorOptions priors;
	WindowOptions window;
	InitializerOptions initializer;

	bool useCamera() const { return mode == Mode::vio || mode == Mode::viwo; }
	bool useImu() const { return mode != Mode::wheel; }
	bool useWheels() const { return mode != Mode::vio; }
	bool useWheelFactor() const { return useWheels() && factors.wheel_factor; }
	bool usePlaneFactor() const { return useWheels() && factors.plane_factor; }

	bool freeMounting() const { return useImu() && useWheelFactor() && factors.estimate_T_BO; }
	bool freeCameraOffset() const { return useCamera() && factors.estimate_camera_time_offset; }
	bool freeWheelOffset() const { return useImu() && useWheelFactor() && factors.estimate_wheel_time_offset; }
	/** Whether wheel factors act on T_BO and on the offsets. */
	bool calibratesWheels() const { return useWheelFactor() && (freeMounting() || freeCameraOffset() || freeWheelOffset()); }
	bool calibratesClocks() const { return freeCameraOffset() || freeWheelOffset(); }
};
}  // namespace viwo
