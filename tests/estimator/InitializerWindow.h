#pragma once

#include <viwo/sfm/StructureFromMotion.h>

#include <random>
#include <vector>

#include "Initializer.h"
#include "PlanarDrive.h"
#include "PointScene.h"
#include "SampleBuffer.h"

namespace viwo::test
{
struct WindowNoise
{
	double bearing_rad = 0;
	bool sensors = false;  //!< IMU and wheels with the noise of their default densities
	uint64_t seed = 1;
};

/** Eleven frames at 10 Hz of a drive through a hall of points, with IMU at 200 Hz, wheels at 20 Hz out of step with the images. */
struct InitializerWindow
{
	PlanarDrive drive;
	Calibration calibration;
	std::vector<Pose3> T_WC;
	std::vector<FeatureFrame> frames;
	std::vector<ImuPreintegration> imu;
	std::vector<WheelPreintegration> wheels;
	SfmResult sfm;

	static constexpr int64_t kFrame_ns = 100'000'000, kImu_ns = 5'000'000, kWheel_ns = 50'000'000, kWheelPhase_ns = 17'000'000;
	static constexpr int kFrames = 11;

	InitializerWindow(const PlanarDrive& drive_, const Pose3& T_OC, const WindowNoise& noise = {}) : drive(drive_)
	{
		calibration.T_OB = drive.T_OB;
		calibration.T_OC = T_OC;
		observe(noise);
		sense(noise);
	}

	void observe(const WindowNoise& noise)
	{
		static const PointScene hall({-5, -5, 0}, {5, 5, 2}, 600, 1.0, 11);
		SfmOptions options;
		if (noise.bearing_rad > 0) options.sigma_rad = noise.bearing_rad;
		for (int k = 0; k < kFrames; ++k)
		{
			T_WC.push_back(drive.T_WO(0.1 * k) * calibration.T_OC);
			frames.push_back(hall.observe(k * kFrame_ns, T_WC.back(), {noise.bearing_rad, 0, noise.seed}));
		}
		sfm = StructureFromMotion(options).reconstruct(frames);
	}

	void sense(const WindowNoise& noise)
	{
		std::mt19937_64 generator(noise.seed + 7);
		std::normal_distribution<double> normal(0, 1);
		const auto draw = [&] { return noise.sensors ? normal(generator) : 0.0; };
		const ImuNoise imu_noise;
		const WheelNoise wheel_noise;
		ImuBuffer imu_samples;
		for (int64_t t_ns = -kImu_ns; t_ns <= kFrames * kFrame_ns; t_ns += kImu_ns)
		{
			ImuSample s = drive.imu(t_ns);
			const double root_rate = std::sqrt(1e9 / static_cast<double>(kImu_ns));
			s.acc_m_s2 += imu_noise.acc_noise_m_s2_sqrtHz * root_rate * Eigen::Vector3d(draw(), draw(), draw());
			s.gyro_rad_s += imu_noise.gyro_noise_rad_s_sqrtHz * root_rate * Eigen::Vector3d(draw(), draw(), draw());
			imu_samples.add(s);
		}
		WheelBuffer wheel_samples;
		for (int64_t t_ns = -kWheelPhase_ns; t_ns <= (kFrames + 1) * kFrame_ns; t_ns += kWheel_ns)
		{
			WheelSample s = drive.wheel(t_ns, kWheel_ns);
			const double root_rate = std::sqrt(1e9 / static_cast<double>(kWheel_ns));
			s.v_left_m_s += draw() * root_rate * std::hypot(wheel_noise.s0_m_s_sqrtHz, wheel_noise.k_sqrtHz * s.v_left_m_s);
			s.v_right_m_s += draw() * root_rate * std::hypot(wheel_noise.s0_m_s_sqrtHz, wheel_noise.k_sqrtHz * s.v_right_m_s);
			wheel_samples.add(s);
		}
		for (int k = 0; k + 1 < kFrames; ++k)
		{
			imu.emplace_back(imu_noise, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
			imu.back().integrate(imu_samples.span(k * kFrame_ns, (k + 1) * kFrame_ns, 0.1).value());
			wheels.emplace_back(wheel_noise, WheelIntrinsics());
			const std::vector<WheelSegment> segments = wheel_samples.segments(k * kFrame_ns, (k + 1) * kFrame_ns, 0.2).value();
			for (const WheelSegment& segment : segments) wheels.back().integrate(segment);
		}
	}

	double trueScale() const
	{
		const auto r = static_cast<size_t>(sfm.reference);
		return (T_WC.back().p - T_WC[r].p).norm() / (sfm.T_c0_ck.back().p - sfm.T_c0_ck[r].p).norm();
	}
	Eigen::Vector3d trueUp_c0() const { return T_WC.front().R.conjugate() * Eigen::Vector3d::UnitZ(); }
	Eigen::Vector3d trueVelocity_B(int k) const { return drive.T_WB(0.1 * k).R.conjugate() * drive.v_WB(0.1 * k); }
};

struct InitializerErrors
{
	double scale = 0, gyro_rad_s = 0, up_rad = 0, velocity_m_s = 0;
};

inline InitializerErrors errorsOf(const InitializerResult& result, const InitializerWindow& w)
{
	InitializerErrors e;
	e.scale = std::abs(result.alignment.scale / w.trueScale() - 1);
	e.gyro_rad_s = (result.gyro.b_g - w.drive.b_g).norm();
	const Eigen::Vector3d up = w.trueUp_c0();
	e.up_rad = std::atan2(up.cross(result.alignment.up_c0).norm(), up.dot(result.alignment.up_c0));
	for (size_t k = 0; k < result.alignment.v_B.size(); ++k)
		e.velocity_m_s = std::max(e.velocity_m_s, (result.alignment.v_B[k] - w.trueVelocity_B(static_cast<int>(k))).norm());
	return e;
}
}  // namespace viwo::test
