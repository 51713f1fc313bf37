#pragma once

#include "RunProgram.h"

#include <viwo/core/Pose3.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include <cmath>
#include <cstdio>
#include <string>

/** Small sequences in the layouts of EuRoC and KITTI: two seconds on a circle. */
namespace viwo::testing
{
constexpr double kSpeed_m_s = 0.5, kYawRate_rad_s = 0.4;
constexpr long long kStart_ns = 1500000000000000000;

template <class... Numbers>
std::string format(const char* pattern, Numbers... numbers)
{
	char text[512];
	std::snprintf(text, sizeof text, pattern, numbers...);
	return text;
}

inline void writeImage(const TempFolder& folder, const std::string& name, int shade, int width = 64, int height = 48)
{
	write(folder, name, "");
	cv::imwrite(folder.file(name), cv::Mat(height, width, CV_8U, cv::Scalar(shade)));
}

inline std::string yamlPose(const Pose3& T)
{
	const Eigen::Matrix3d R = T.R.toRotationMatrix();
	std::string text = "T_BS:\n  cols: 4\n  rows: 4\n  data: [";
	for (int i = 0; i < 3; ++i) text += format("%.15g, %.15g, %.15g, %.15g,\n         ", R(i, 0), R(i, 1), R(i, 2), T.p[i]);
	return text + "0.0, 0.0, 0.0, 1.0]\n";
}

/** Poses of the sensors in the body; O is below and behind the body. */
struct SmallRig
{
	Pose3 T_BC{Eigen::Quaterniond(Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX())) * forwardOpticalAxes(),
	           Eigen::Vector3d(0.05, 0.02, 0.01)};
	Pose3 T_BO{Eigen::Quaterniond(Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitZ())), Eigen::Vector3d(-0.2, 0, -0.3)};
};

/** mav0/ with cam0 (10 Hz), imu0 (100 Hz), odom0 (20 Hz), ground truth (50 Hz): B on a circle. */
inline void writeEuroc(const TempFolder& folder, bool with_odometry = true)
{
	const SmallRig rig;
	const std::string head = "%YAML:1.0\n# comment\nsensor_type: x\n";
	write(folder, "mav0/cam0/sensor.yaml",
	      head + yamlPose(rig.T_BC) +
	          "camera_model: pinhole\nresolution: [64, 48]\nintrinsics: [50.5, 51.5, 31, 23] #fu\ndistortion_model: radial-tangential\n"
	          "distortion_coefficients: [-0.28, 0.07, 2e-4, 1.7e-05]\n");
	write(folder, "mav0/imu0/sensor.yaml",
	      head + yamlPose({}) +
	          "gyroscope_noise_density: 1.7e-04\ngyroscope_random_walk: 1.9e-05\naccelerometer_noise_density: "
	          "2e-3\naccelerometer_random_walk: 3e-3\n");
	std::string cam = "#timestamp [ns],filename\n", imu = "#timestamp\n", odom = "#timestamp\n", truth = "#timestamp\n";
	for (int i = 0; i <= 20; ++i)
	{
		const long long t = kStart_ns + i * 100000000LL + 123;
		writeImage(folder, format("mav0/cam0/data/%lld.png", t), 10 * i);
		cam += format("%lld,%lld.png\n", t, t);
	}
	for (int i = 0; i <= 200; ++i)
		imu += format("%lld,%g,%g,%g,%g,%g,%g\n", kStart_ns + i * 10000000LL, 0.1, 0.2, kYawRate_rad_s, 1.0, 2.0, 9.8 + i);
	for (int i = 0; i <= 40; ++i) odom += format("%lld, %g, %g\r\n", kStart_ns + i * 50000000LL, kSpeed_m_s, kYawRate_rad_s);
	for (int i = 0; i <= 100; ++i)
	{
		const double yaw = kYawRate_rad_s * 0.02 * i, r = kSpeed_m_s / kYawRate_rad_s;
		truth += format("%lld,%.9f,%.9f,0.3,%.12f,0,0,%.12f,0,0,0,0,0,0,0,0,0\n", kStart_ns + i * 20000000LL, r * std::sin(yaw),
		                r * (1 - std::cos(yaw)), std::cos(yaw / 2), std::sin(yaw / 2));
	}
	write(folder, "mav0/cam0/data.csv", cam);
	write(folder, "mav0/imu0/data.csv", imu);
	write(folder, "mav0/state_groundtruth_estimate0/data.csv", truth);
	if (!with_odometry) return;
	write(folder, "mav0/odom0/data.csv", odom);
	write(folder, "mav0/odom0/sensor.yaml", head + yamlPose(rig.T_BO));
}

inline std::string kittiStamp(double t_s)
{
	return format("2011-09-26 14:05:%012.9f\n", 35.5 + t_s);
}

/** image_00 (10 Hz) and oxts (50 Hz), calibration; image 3 and packet 7 are absent. I drives a circle on level ground. */
inline void writeKitti(const TempFolder& folder)
{
	write(folder, "calib_cam_to_cam.txt",
	      "calib_time: 09-Jan-2012 13:57:47\nS_00: 64 48\nK_00: 50 0 31 0 51 23 0 0 1\nD_00: -0.37 0.2 0.002 0.001 -0.07\nR_00: 1 0 0 0 1 "
	      "0 0 0 1\nT_00: 0 0 0\n"
	      "S_rect_00: 60 40\nR_rect_00: 0 -1 0 1 0 0 0 0 1\nP_rect_00: 45 0 30 0 0 46 20 0 0 0 1 0\n");
	write(folder, "calib_velo_to_cam.txt", "R: 0 -1 0 0 0 -1 1 0 0\nT: 0.1 0.2 0.3\n");
	write(folder, "calib_imu_to_velo.txt", "R: 1 0 0 0 1 0 0 0 1\nT: -0.8 0.3 -0.8\n");
	std::string stamps;
	for (int i = 0; i <= 20; ++i)
	{
		if (i != 3) writeImage(folder, format("image_00/data/%010d.png", i), 10 * i);
		stamps += kittiStamp(0.1 * i);
	}
	write(folder, "image_00/timestamps.txt", stamps);
	stamps.clear();
	const double degrees_per_m = 180 / M_PI / 6378137;
	for (int i = 0; i <= 100; ++i)
	{
		const double yaw = kYawRate_rad_s * 0.02 * i, r = kSpeed_m_s / kYawRate_rad_s;
		// At the equator Mercator's scale is one.
		const double lat = degrees_per_m * r * (1 - std::cos(yaw)), lon = 8 + degrees_per_m * r * std::sin(yaw);
		if (i != 7)
			write(folder, format("oxts/data/%010d.txt", i),
			      format("%.15f %.15f 100 0 0 %.9f 0 0 %.9f 0 0 0.1 0.2 9.81 0.1 0.2 9.81 0.01 0.02 %.9f 0.01 0.02 0.3 0 0 4 8 4 4 0\n",
			             lat, lon, yaw, kSpeed_m_s, kYawRate_rad_s));
		stamps += kittiStamp(0.02 * i);
	}
	write(folder, "oxts/timestamps.txt", stamps);
}
}  // namespace viwo::testing
