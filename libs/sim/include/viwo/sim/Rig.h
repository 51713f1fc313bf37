#pragma once

#include <viwo/core/Calibration.h>
#include <viwo/core/Options.h>
#include <viwo/sim/Disturbances.h>
#include <viwo/sim/ImageEffects.h>
#include <viwo/sim/ImuModel.h>
#include <viwo/sim/LidarModel.h>
#include <viwo/sim/Renderer.h>
#include <viwo/sim/Route.h>
#include <viwo/sim/WheelModel.h>

#include <string>
#include <vector>

namespace viwo::sim
{
/** Section [camera] of a rig. Defaults: one eye of a MYNT EYE D1000-IR-120, global shutter, 105 deg horizontally. */
struct CameraOptions : Options<CameraOptions>
{
	enum class Format
	{
		jpg,
		png
	};
	std::string label = "CAM";
	double rate_hz = 10;
	double phase_ms = 20;
	double latency_ms = 30;
	std::vector<double> pose = {0.10, 0.06, 0.30, -90, 0, -90};
	std::vector<double> pose_error = {0.002, -0.002, 0.002, 0.2, -0.2, 0.2};
	int width_px = 640;
	int height_px = 480;
	double fx_px = 338, fy_px = 338, cx_px = 321.4, cy_px = 237.8;
	CameraModel::Distortion distortion = CameraModel::Distortion::plumb_bob;
	std::vector<double> coefficients = {-0.28, 0.07, 2e-4, -1e-4, 0};
	double exposure_ms = 10;
	std::vector<double> exposure_steps;
	double black_from_s = 0;
	double black_to_s = 0;
	double time_offset_ms = 0;
	Format format = Format::jpg;
	int jpeg_quality = 92;
	bool colour = false;

	/** @throws Error for an unusable list of coefficients. */
	CameraModel model() const;

	template <class Visitor>
	void visit(Visitor& v)
	{
		v("label", label, "sensor label in the rawlog");
		v("rate_hz", rate_hz, "images a second", 0.1, 200.0);
		v("phase_ms", phase_ms, "middle of the first exposure", 0.0, 1000.0);
		v("latency_ms", latency_ms, "delay of the arrival in the log after the stamp", 0.0, 400.0);
		v("pose", pose, "x y z (m) yaw pitch roll (deg) of C (optical axes) in O: published as cameraPose");
		v("pose_error", pose_error, "where it really sits: this displacement (m, deg) in its own frame on top");
		v("width_px", width_px, "", 16, 8192);
		v("height_px", height_px, "", 16, 8192);
		v("fx_px", fx_px, "", 1.0, 1e5);
		v("fy_px", fy_px, "", 1.0, 1e5);
		v("cx_px", cx_px, "pixel centres are at whole numbers", 0.0, 1e5);
		v("cy_px", cy_px, "", 0.0, 1e5);
		v.choice("distortion", distortion, "none | plumb_bob (k1 k2 p1 p2 k3) | kannala_brandt (k1 k2 k3 k4)",
		         std::vector<std::string>{"none", "plumb_bob", "kannala_brandt"});
		v("coefficients", coefficients, "of the distortion");
		v("exposure_ms", exposure_ms, "shutter time; stamps are at its middle", 0.0, 1000.0);
		v("exposure_steps", exposure_steps, "changes of the brightness, two numbers each: time (s), factor from then on");
		v("black_from_s", black_from_s, "images are black from here ...", 0.0, 1e6);
		v("black_to_s", black_to_s, "... to here", 0.0, 1e6);
		v("time_offset_ms", time_offset_ms, "t_d: IMU time = camera time + this", -1000.0, 1000.0);
		v.choice("format", format, "image files: jpg | png", std::vector<std::string>{"jpg", "png"});
		v("jpeg_quality", jpeg_quality, "", 10, 100);
		v("colour", colour, "image files of three channels (grey surfaces in warm light) instead of one");
	}
};

/** The robot: all sections of a rig file. */
struct Rig
{
	FloorOptions floor;
	VibrationOptions vibration;
	ImuOptions imu;
	WheelOptions wheels;
	CameraOptions camera;
	RendererOptions renderer;
	ImageEffectsOptions image_effects;
	LidarOptions lidar;

	/** For loadOptions() and saveOptions(): [floor], [vibration], [imu], [wheels], [camera], [renderer], [image_effects], [lidar]. */
	std::vector<OptionsSection> sections();

	/** What the robot's maker says: published poses, nominal wheels. @throws Error for an unusable pose or camera. */
	Calibration nominalCalibration() const;

	/** What is true: displaced poses, true wheels of the seed. */
	Calibration actualCalibration(const Motion& motion, uint64_t seed) const;
};

/** Rig and route of a run, from their files and "section.key=value" words that overrule them. One file may serve as both.
 *  @throws Error naming file, section and key; for an overruling word that names no option.
 */
void loadRun(const std::string& rig_ini, const std::string& route_ini, const std::vector<std::string>& overrides, Rig& rig, Route& route);
}  // namespace viwo::sim
