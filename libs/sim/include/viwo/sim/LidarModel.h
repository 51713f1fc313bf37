#pragma once

#include <viwo/core/Options.h>
#include <viwo/sim/Motion.h>
#include <viwo/sim/World.h>

#include <array>
#include <optional>
#include <random>
#include <vector>

namespace viwo::sim
{
/** Section [lidar] of a rig. Defaults: a SICK LMS100. Zero switches an effect off. */
struct LidarOptions : Options<LidarOptions>
{
	bool enabled = true;
	std::string label = "LMS100";
	double rate_hz = 25;
	double phase_ms = 7;
	double latency_ms = 45;
	std::vector<double> pose = {0.10, 0, 0.20, 0, 0, 0};
	std::vector<double> pose_error = {0, 0, 0, 0, 0, 0};
	int beams = 541;
	double aperture_deg = 270;
	double max_range_m = 20;
	double sweep_ms = 30;
	double noise_mm = 12;
	double systematic_error_mm = 30;
	double resolution_mm = 1;
	double beam_width_deg = 0.86;
	double glass_dropout = 0.7;
	double dark_range_m = 18;

	/** Exact ranges of an ideal scanner; the motion during the sweep remains. */
	static LidarOptions perfect();

	template <class Visitor>
	void visit(Visitor& v)
	{
		v("enabled", enabled, "false: no scans");
		v("label", label, "sensor label in the rawlog");
		v("rate_hz", rate_hz, "scans a second", 0.1, 200.0);
		v("phase_ms", phase_ms, "time of the first scan", 0.0, 1000.0);
		v("latency_ms", latency_ms, "delay of the arrival in the log after the stamp", 0.0, 400.0);
		v("pose", pose, "x y z (m) yaw pitch roll (deg) of L in O: published as sensorPose");
		v("pose_error", pose_error, "where it really sits: this displacement (m, deg) in its own frame on top");
		v("beams", beams, "beams of a scan", 2, 10000);
		v("aperture_deg", aperture_deg, "angle between the first (right) and the last (left) beam", 1.0, 360.0);
		v("max_range_m", max_range_m, "largest range", 0.1, 1000.0);
		v("sweep_ms", sweep_ms, "time from the first to the last beam, the stamp is that of the first; 0: all at once", 0.0, 1000.0);
		v("noise_mm", noise_mm, "standard deviation of each range", 0.0, 1000.0);
		v("systematic_error_mm", systematic_error_mm, "bound of an error that depends smoothly on range and incidence", 0.0, 1000.0);
		v("resolution_mm", resolution_mm, "quantisation step", 0.0, 1000.0);
		v("beam_width_deg", beam_width_deg, "a beam this wide mixes the ranges on both sides of an edge; 0: no mixed pixels", 0.0, 5.0);
		v("glass_dropout", glass_dropout, "probability that a glass surface sends no echo", 0.0, 1.0);
		v("dark_range_m", dark_range_m,
		  "range at which a surface of 10 % reflectivity, met head-on, is just seen; 0: darkness does not matter", 0.0, 1000.0);
	}
};

/** One sweep. */
struct LidarScan
{
	int64_t t_ns = 0;             //!< of the first beam
	std::vector<float> ranges_m;  //!< from right to left; 0: no echo
};

/** A planar scanner carried along a motion through a world. Each beam is cast from where the scanner is at the beam's own time.
 *  Scans are to be made in order: noise is drawn from one stream.
 */
class LidarModel
{
   public:
	/** `motion` and `world` must outlive the model. @throws Error for inconsistent options. */
	LidarModel(const Motion& motion, const World& world, const LidarOptions& options, uint64_t seed);

	/** Start of scan i, s. */
	double time_s(int64_t i) const { return 1e-3 * options_.phase_ms + static_cast<double>(i) / options_.rate_hz; }
	/** Number of scans that end within the motion. */
	int64_t count() const;

	LidarScan scan(int64_t i);

	/** Angle of a beam from L's x axis, rad. */
	double beamAngle_rad(int beam) const;
	const Pose3& T_OL() const { return T_OL_; }
	const LidarOptions& options() const { return options_; }

   private:
	std::vector<Pose3> beamPoses(double begin_s) const;
	/** What the whole beam brings back, m; 0: no echo. */
	double echo_m(const std::vector<std::optional<Hit>>& hits, size_t beam);
	double systematicError_m(const Hit& hit) const;

	const Motion& motion_;
	const World& world_;
	LidarOptions options_;
	Pose3 T_OL_, T_OL_actual_;
	std::mt19937_64 noise_generator_, echo_generator_;
	std::normal_distribution<double> normal_;
	std::array<double, 2> systematic_phase_rad_;
};
}  // namespace viwo::sim
