#pragma once

#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <viwo/core/Calibration.h>
#include <viwo/core/Error.h>
#include <viwo/core/ImuSample.h>
#include <viwo/core/Options.h>
#include <viwo/core/WheelSample.h>
#include <viwo/rawlog/EncoderTicks.h>
#include <viwo/rawlog/RawlogReader.h>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>

namespace viwo
{
/** Every convention by which a robot's observations become samples. */
struct AdapterOptions : Options<AdapterOptions>
{
	enum class OdometrySource
	{
		velocity,
		ticks_absolute,
		ticks_increment,
		pose
	};
	enum class VelocityMeaning
	{
		mean,
		instantaneous
	};

	std::string cam_label = "CAM";
	std::string imu_label = "IMU";
	std::string odometry_label = "ODOMETRY";
	OdometrySource odometry_source = OdometrySource::velocity;
	VelocityMeaning velocity_meaning = VelocityMeaning::mean;
	double track_m = 0.23;
	double wheel_radius_m = 0.035;
	double ticks_per_revolution = 2578.33;
	double metres_per_tick = 0;
	bool left_inverted = false;
	bool right_inverted = false;
	double left_scale = 1, right_scale = 1;
	double calibrated_track_m = 0;
	double camera_time_offset_s = 0;
	double wheel_time_offset_s = 0;
	double max_wheel_speed_m_s = 50;
	double min_wheel_interval_s = 0.005;
	double max_acc_m_s2 = 200;
	double max_rate_rad_s = 35;

	double metresPerTick() const;

	template <class Visitor>
	void visit(Visitor& v)
	{
		v("cam_label", cam_label, "label of the images");
		v("imu_label", imu_label, "label of the IMU");
		v("odometry_label", odometry_label, "label of the wheel odometry");
		v.choice("odometry_source", odometry_source, "what to use of an odometry observation",
		         std::vector<std::string>{"velocity", "ticks_absolute", "ticks_increment", "pose"});
		v.choice("velocity_meaning", velocity_meaning, "velocity over the past interval, or at the stamp",
		         std::vector<std::string>{"mean", "instantaneous"});
		v("track_m", track_m, "distance between the wheels, nominal", 1e-3, 100.0);
		v("wheel_radius_m", wheel_radius_m, "nominal; for ticks", 1e-4, 100.0);
		v("ticks_per_revolution", ticks_per_revolution, "for ticks", 1e-3, 1e9);
		v("metres_per_tick", metres_per_tick, "0: from wheel_radius_m and ticks_per_revolution", 0.0, 100.0);
		v("left_inverted", left_inverted, "left ticks count backwards");
		v("right_inverted", right_inverted, "right ticks count backwards");
		v("left_scale", left_scale, "true radius of the left wheel against nominal, where it was calibrated", 0.1, 10.0);
		v("right_scale", right_scale, "the same of the right wheel", 0.1, 10.0);
		v("calibrated_track_m", calibrated_track_m, "true distance between the wheels; 0: track_m, by which the robot computes", 0.0,
		  100.0);
		v("camera_time_offset_s", camera_time_offset_s, "t_IMU = t_CAM + this", -10.0, 10.0);
		v("wheel_time_offset_s", wheel_time_offset_s, "t_IMU = t_WHEEL + this", -10.0, 10.0);
		v("max_wheel_speed_m_s", max_wheel_speed_m_s, "faster samples are rejected (an encoder that was reset)", 0.01, 1e4);
		v("min_wheel_interval_s", min_wheel_interval_s,
		  "ticks or poses that come sooner are added to the next (stamps of reception come in bunches)", 0.0, 1.0);
		v("max_acc_m_s2", max_acc_m_s2, "an IMU sample with more is rejected (no sensor of a robot reads that)", 10.0, 1e5);
		v("max_rate_rad_s", max_rate_rad_s, "the same for its angular rates", 0.1, 1e4);
	}
};

/** An image that is decoded when asked for. */
class ImageRef
{
   public:
	ImageRef() = default;
	ImageRef(int64_t t_ns, mrpt::obs::CObservationImage::Ptr observation) : t_ns(t_ns), observation_(std::move(observation)) {}

	int64_t t_ns = 0;  //!< in the IMU's clock

	/** The image as 8-bit grey, of the size in its calibration; may be called from any thread, by one at a time.
	 *  @throws Error: missing or undecodable file, another size than that of the calibration.
	 */
	mrpt::img::CImage grey() const;

	const mrpt::obs::CObservationImage::Ptr& observation() const { return observation_; }

   private:
	mrpt::obs::CObservationImage::Ptr observation_;
};

/** Why an observation gave no sample. */
enum class Rejection
{
	not_finite,
	duplicate_stamp,
	stamp_backwards,
	missing_data,  //!< IMU without acceleration or rates, odometry without the configured source
	too_fast,      //!< wheel speed beyond max_wheel_speed_m_s
	out_of_range,  //!< IMU sample beyond max_acc_m_s2 or max_rate_rad_s
	stamp_jump     //!< see StampGate
};
const char* nameOf(Rejection reason);

/** Of one observation: a sample, or a rejection, or neither (another label, or the first encoder reading, which only starts an interval).
 */
struct AdaptedObservation
{
	std::variant<std::monostate, ImuSample, WheelSample, ImageRef> sample;
	std::optional<Rejection> rejected;
};

/** What an odometry observation says, ticks made absolute. */
struct OdometryReading
{
	int64_t t_ns = 0;
	WheelTwist twist;
	EncoderTicks ticks;
	double x_m = 0, y_m = 0, yaw_rad = 0;
};

/** Accepted and rejected observations of one label. */
struct RejectionCounts
{
	uint64_t accepted = 0;
	std::map<std::string, uint64_t> rejected;  //!< by nameOf(reason)
};

/** Turns MRPT's observations, given in the order of time, into samples. */
class ObservationAdapter
{
   public:
	explicit ObservationAdapter(const AdapterOptions& options = {}) : options_(options) {}

	/** @throws Error for what cannot be skipped: the first IMU observations have no rates, the first odometry lacks the configured source,
	 *  an observation under a configured label is of another class.
	 */
	AdaptedObservation convert(const mrpt::obs::CObservation::Ptr& observation);

	/** Counts an observation that is not to be converted at all. */
	void reject(const std::string& label, Rejection reason) { counts_[label].rejected[nameOf(reason)]++; }

	/** By label. */
	const std::map<std::string, RejectionCounts>& counts() const { return counts_; }

	const AdapterOptions& options() const { return options_; }

   private:
	AdaptedObservation convertImu(const mrpt::obs::CObservationIMU& imu);
	AdaptedObservation convertOdometry(const mrpt::obs::CObservationOdometry& odometry);
	OdometryReading readingOf(const mrpt::obs::CObservationOdometry& odometry);
	AdaptedObservation convertImage(const mrpt::obs::CObservationImage::Ptr& image);
	std::optional<Rejection> checkStamp(const std::optional<int64_t>& last_t_ns, int64_t t_ns) const;

	AdapterOptions options_;
	std::map<std::string, RejectionCounts> counts_;
	std::optional<int64_t> last_image_t_ns_, last_imu_t_ns_;
	std::optional<int64_t> last_odometry_t_ns_;
	std::optional<OdometryReading> last_wheel_reading_;  //!< where the interval of the next WheelSample begins
	EncoderTicks summed_increments_;
};

/** Calibration from observations; the wheels' from the options.
 *  @param image, imu one observation each; null where that sensor is not used, and its part stays as by default.
 *  @throws Error: no calibration, focal length 0, pose not finite.
 */
Calibration calibrationFrom(const AdapterOptions& options, const mrpt::obs::CObservationImage* image,
                            const mrpt::obs::CObservationIMU* imu);

/** The same from the first observations in the rawlogs of a run, or from a rig that counts instead.
 *  @throws Error, also where there is no observation under a label that is needed (it lists those there are).
 */
Calibration readCalibration(const std::vector<std::string>& rawlog_paths, const AdapterOptions& options, bool needs_camera, bool needs_imu,
                            bool allow_truncated = false, const RigFile* rig = nullptr);
Calibration readCalibration(const std::string& rawlog_path, const AdapterOptions& options, bool needs_camera, bool needs_imu,
                            bool allow_truncated = false);

enum class SensorKind
{
	camera,
	imu,
	odometry
};

/** "run.rawlog: no image (CObservationImage) under label CAM; labels here: ...", or that all there are have no stamp. */
Error missingSensorError(const std::string& rawlog_path, SensorKind kind, const AdapterOptions& options, const RawlogCounts& counts);
}  // namespace viwo
