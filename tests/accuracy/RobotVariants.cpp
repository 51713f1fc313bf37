#include "RobotVariants.h"

namespace viwo::experiments
{
namespace
{
using Words = std::vector<std::string>;

/** Speed and yaw rate vary all the time. */
SimulatedDrive standardRobot()
{
	return {"robot", "lobby", "lobby_free", {"lidar.enabled=false", "route.duration_s=20"}};
}

RobotVariant variant(const std::string& name, const std::string& short_name, const Words& rig, const Words& configuration = {})
{
	return {name, standardRobot().with(short_name, rig), configuration};
}

/** Wheels that skid in turns: as if they stood 5 % farther apart than they do, and noisier than those of two-wheeled robots. */
RobotVariant fourWheels()
{
	RobotVariant robot = variant("four wheels as joints of a ROS bag, skid steering", "four-wheels",
	                             {"wheels.track_error=0.05", "wheels.noise_per_speed_sqrtHz=0.03"},
	                             {"priors.track_relative=0.05", "noise.wheel_k_sqrtHz=0.04"});
	robot.four_wheels = true;
	return robot;
}
}  // namespace

LogRecipe RobotVariant::log(uint64_t seed) const
{
	LogRecipe simulated = drive.log(seed);
	if (!four_wheels) return simulated;
	LogRecipe imported;
	imported.name = drive.name + "-bag-s" + std::to_string(seed);
	imported.program = "viwo_four_wheel_log";
	imported.content = simulated.content;
	imported.made_of = std::make_shared<const LogRecipe>(std::move(simulated));
	return imported;
}

std::vector<RobotVariant> robotVariants(bool bags)
{
	// Poses in O: x y z (m), yaw pitch roll (deg); a camera's with optical axes, which look forward at -90 0 -90.
	std::vector<RobotVariant> robots = {
	    {"the robot of the defaults", standardRobot(), {}},
	    variant("camera at 5 Hz", "camera-5-hz", {"camera.rate_hz=5"}),
	    variant("camera at 20 Hz", "camera-20-hz", {"camera.rate_hz=20"}),
	    variant("camera at 60 Hz", "camera-60-hz", {"camera.rate_hz=60", "route.duration_s=10"}),
	    variant("IMU at 50 Hz", "imu-50-hz", {"imu.rate_hz=50", "vibration.frequency_max_hz=20"}),
	    variant("IMU at 1000 Hz", "imu-1000-hz", {"imu.rate_hz=1000"}),
	    variant("wheels at 5 Hz", "wheels-5-hz", {"wheels.rate_hz=5"}),
	    variant("wheels at 200 Hz", "wheels-200-hz", {"wheels.rate_hz=200"}),
	    variant("camera looking left", "camera-left", {"camera.pose=0 0.1 0.3 0 0 -90"}),
	    variant("camera looking backwards", "camera-backwards", {"camera.pose=-0.1 -0.06 0.3 90 0 -90"}),
	    variant("IMU on its side", "imu-on-its-side", {"imu.pose=-0.05 0.1 0.15 30 0 90"}),
	    variant("other labels, ticks instead of velocities", "labels",
	            {"camera.label=front_camera", "imu.label=xsens", "wheels.label=base"},
	            {"rawlog.cam_label=front_camera", "rawlog.imu_label=xsens", "rawlog.odometry_label=base",
	             "rawlog.odometry_source=ticks_absolute"}),
	    variant("colour images", "colour", {"camera.colour=true"}),
	    variant(
	        "fisheye lens of 130 deg", "fisheye",
	        {"camera.distortion=kannala_brandt", "camera.coefficients=-0.012 0.006 -0.004 0.001", "camera.fx_px=285", "camera.fy_px=285"}),
	    variant(
	        "a larger and faster robot", "large",
	        {"wheels.radius_m=0.1", "wheels.track_m=0.55", "wheels.ticks_per_revolution=1024", "camera.pose=0.3 0.1 0.8 -90 0 -90",
	         "imu.pose=-0.1 0.15 0.5 0 0 0", "route.speed_m_s=0.45", "route.acceleration_m_s2=0.5", "route.free_yaw_rate_mean_rad_s=0.27",
	         "route.free_yaw_rate_amplitudes_rad_s=0.36 0.21 0.12", "vibration.reference_speed_m_s=0.45"},
	        {"rawlog.track_m=0.55"}),
	};
	if (bags) robots.push_back(fourWheels());
	return robots;
}
}  // namespace viwo::experiments
