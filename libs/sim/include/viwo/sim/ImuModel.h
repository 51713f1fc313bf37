#pragma once

#include <viwo/core/ImuSample.h>
#include <viwo/core/Options.h>
#include <viwo/sim/Motion.h>

#include <vector>

namespace viwo::sim
{
/** Section [imu] of a rig. Defaults: a consumer MEMS unit (Bosch BMI055 class) looking forward with a camera's axes. Zero switches an
 * effect off. */
struct ImuOptions : Options<ImuOptions>
{
	std::string label = "IMU";
	double rate_hz = 200;
	double phase_ms = 0;
	std::vector<double> pose = {0.10, 0.02, 0.30, -90, 0, -90};
	std::vector<double> pose_error = {0, 0, 0, 0, 0, 0};
	double gravity_m_s2 = 9.81;
	double acc_noise_m_s2_sqrtHz = 1.6e-3;
	double gyro_noise_rad_s_sqrtHz = 1.7e-4;
	double acc_walk_m_s3_sqrtHz = 2e-4;
	double gyro_walk_rad_s2_sqrtHz = 1e-5;
	double acc_start_bias_m_s2 = 0.05;
	double gyro_start_bias_rad_s = 0.004;
	double acc_scale_error = 0.002;
	double gyro_scale_error = 0.001;
	double axis_misalignment_deg = 0.05;
	double acc_resolution_m_s2 = 1.2e-3;
	double gyro_resolution_rad_s = 2.7e-4;
	double stamp_jitter_ms = 0;

	/** No error of any kind. */
	static ImuOptions perfect();

	template <class Visitor>
	void visit(Visitor& v)
	{
		v("label", label, "sensor label in the rawlog");
		v("rate_hz", rate_hz, "samples a second", 1.0, 10000.0);
		v("phase_ms", phase_ms, "time of the first sample", 0.0, 1000.0);
		v("pose", pose, "x y z (m) yaw pitch roll (deg) of B in O: published as sensorPose");
		v("pose_error", pose_error, "where it really sits: this displacement (m, deg) in its own frame on top");
		v("gravity_m_s2", gravity_m_s2, "local gravity", 9.7, 9.9);
		v("acc_noise_m_s2_sqrtHz", acc_noise_m_s2_sqrtHz, "white noise density (150 ug/sqrtHz = 1.5e-3)", 0.0, 1.0);
		v("gyro_noise_rad_s_sqrtHz", gyro_noise_rad_s_sqrtHz, "white noise density (0.01 deg/s/sqrtHz = 1.7e-4)", 0.0, 1.0);
		v("acc_walk_m_s3_sqrtHz", acc_walk_m_s3_sqrtHz, "random walk of the bias", 0.0, 1.0);
		v("gyro_walk_rad_s2_sqrtHz", gyro_walk_rad_s2_sqrtHz, "random walk of the bias", 0.0, 1.0);
		v("acc_start_bias_m_s2", acc_start_bias_m_s2, "each axis: uniform within +- this", 0.0, 5.0);
		v("gyro_start_bias_rad_s", gyro_start_bias_rad_s, "each axis: uniform within +- this", 0.0, 1.0);
		v("acc_scale_error", acc_scale_error, "each axis: uniform within +- this", 0.0, 0.2);
		v("gyro_scale_error", gyro_scale_error, "each axis: uniform within +- this", 0.0, 0.2);
		v("axis_misalignment_deg", axis_misalignment_deg, "non-orthogonality of the sensing axes: uniform within +- this", 0.0, 10.0);
		v("acc_resolution_m_s2", acc_resolution_m_s2, "quantisation step", 0.0, 1.0);
		v("gyro_resolution_rad_s", gyro_resolution_rad_s, "quantisation step", 0.0, 1.0);
		v("stamp_jitter_ms", stamp_jitter_ms, "stamps off by up to +- this (uniform), the data are not; below half the sample interval",
		  0.0, 100.0);
	}
};

/** An IMU carried along a motion: specific force and angular rate in B at rate_hz over the whole motion. */
class ImuModel
{
   public:
	/** @throws Error for inconsistent options. */
	ImuModel(const Motion& motion, const ImuOptions& options, uint64_t seed);

	/** Samples whose true times lie in [t_begin_s, t_end_s], in order of time. */
	std::vector<ImuSample> samples(double t_begin_s, double t_end_s) const;
	const std::vector<ImuSample>& samples() const { return samples_; }

	/** True time of a sample, whatever its stamp says. */
	double time_s(size_t index) const { return times_s_[index]; }

	/** True biases of the sample nearest to t_s: what is to be subtracted, scale and axis errors aside. */
	struct Bias
	{
		Eigen::Vector3d acc_m_s2 = Eigen::Vector3d::Zero(), gyro_rad_s = Eigen::Vector3d::Zero();
	};
	Bias biasAt(double t_s) const;

	/** Published pose of B in O, and the true one. */
	const Pose3& T_OB() const { return T_OB_; }
	const Pose3& T_OB_actual() const { return T_OB_actual_; }
	ImuNoise noise() const;

   private:
	ImuSample exactSample(const Motion& motion, double t_s) const;
	void simulate(const Motion& motion, uint64_t seed);

	ImuOptions options_;
	Pose3 T_OB_, T_OB_actual_;
	std::vector<ImuSample> samples_;
	std::vector<double> times_s_;
	std::vector<Bias> biases_;
};
}  // namespace viwo::sim
