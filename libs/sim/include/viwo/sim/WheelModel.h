#pragma once

#include <viwo/core/Options.h>
#include <viwo/core/WheelSample.h>
#include <viwo/sim/Motion.h>

#include <vector>

namespace viwo::sim
{
/** Section [wheels] of a rig. Defaults: a TurtleBot2 whose true wheels differ from the nominal ones. Zero switches an effect off. */
struct WheelOptions : Options<WheelOptions>
{
	std::string label = "ODOMETRY";
	double rate_hz = 20;
	double phase_ms = 0;
	double radius_m = 0.035;
	double track_m = 0.23;
	double ticks_per_revolution = 2578.33;
	bool tick_quantisation = true;
	double radius_error = 0.01;
	double left_right_difference = 0.004;
	double track_error = 0.01;
	double radius_deviation = 0;
	double left_right_deviation = 0;
	double track_deviation = 0;
	double noise_m_s_sqrtHz = 3e-4;
	double noise_per_speed_sqrtHz = 0.01;
	std::vector<double> slips;
	std::vector<double> silences;
	double stamp_jitter_ms = 0;
	double clock_offset_ms = 0;

	/** True wheels as the nominal ones, and no noise; readings are exact reals as far as velocities go. */
	static WheelOptions perfect();

	template <class Visitor>
	void visit(Visitor& v)
	{
		v("label", label, "sensor label in the rawlog");
		v("rate_hz", rate_hz, "readings a second", 1.0, 1000.0);
		v("phase_ms", phase_ms, "time of the first reading", 0.0, 1000.0);
		v("radius_m", radius_m, "nominal radius of the wheels", 1e-3, 1.0);
		v("track_m", track_m, "nominal distance between the wheels", 1e-2, 5.0);
		v("ticks_per_revolution", ticks_per_revolution, "encoder ticks in one turn of a wheel", 1.0, 1e7);
		v("tick_quantisation", tick_quantisation, "false: speeds are computed from real-valued ticks");
		v("radius_error", radius_error, "both true radii are larger than nominal by this fraction", -0.2, 0.2);
		v("left_right_difference", left_right_difference, "the right true radius is larger than the left one by this fraction", -0.2, 0.2);
		v("track_error", track_error, "the true track is larger than nominal by this fraction", -0.2, 0.2);
		v("radius_deviation", radius_deviation, "standard deviation of a further radius_error, drawn from the seed", 0.0, 0.1);
		v("left_right_deviation", left_right_deviation, "standard deviation of a further left_right_difference, drawn from the seed", 0.0,
		  0.1);
		v("track_deviation", track_deviation, "standard deviation of a further track_error, drawn from the seed", 0.0, 0.1);
		v("noise_m_s_sqrtHz", noise_m_s_sqrtHz, "white speed noise of each turning wheel: density sqrt(this^2 + (noise_per_speed |v|)^2)",
		  0.0, 1.0);
		v("noise_per_speed_sqrtHz", noise_per_speed_sqrtHz, "its growth with speed, (m/s)/(m/s)/sqrt(Hz)", 0.0, 1.0);
		v("slips", slips,
		  "slip bursts, four numbers each: begin (s), duration (s), fraction that the wheel turns too much, wheel (0 left, 1 right)");
		v("silences", silences, "intervals without readings, two numbers each: begin (s), duration (s)");
		v("stamp_jitter_ms", stamp_jitter_ms, "stamps off by up to +- this (uniform), the data are not", 0.0, 100.0);
		v("clock_offset_ms", clock_offset_ms, "t_w: IMU time = wheel time + this", -1000.0, 1000.0);
	}
};

/** What the base publishes at one time. */
struct WheelReading
{
	int64_t t_ns = 0;
	double t_s = 0;                           //!< true time since the motion's start
	int64_t ticks_left = 0, ticks_right = 0;  //!< absolute
	WheelTwist mean_twist;                    //!< since the reading before, by nominal radius and track
	double x_m = 0, y_m = 0, yaw_rad = 0;     //!< dead-reckoned from the readings, nominal radius and track, from (0,0,0)
};

/** Two driven wheels with encoders that carry the robot along a motion. */
class WheelModel
{
   public:
	/** @throws Error for inconsistent options. */
	WheelModel(const Motion& motion, const WheelOptions& options, uint64_t seed);

	const std::vector<WheelReading>& readings() const { return readings_; }

	/** Speeds whose true times lie in [t_begin_s, t_end_s], from nominal radius. */
	std::vector<WheelSample> samples(double t_begin_s, double t_end_s) const;

	WheelIntrinsics nominal() const { return {1, 1, options_.track_m}; }
	/** What an estimator is to find out. */
	WheelIntrinsics actual() const { return actual_; }

   private:
	void simulate(const Motion& motion, uint64_t seed);
	/** Distance (m) over which each wheel turns between two times, slip included. */
	WheelSpeeds travel(const Motion& motion, double begin_s, double end_s) const;
	WheelSpeeds slipFactor(double t_s) const;
	bool silent(double t_s) const;

	WheelOptions options_;
	WheelIntrinsics actual_;
	std::vector<WheelReading> readings_;
};
}  // namespace viwo::sim
