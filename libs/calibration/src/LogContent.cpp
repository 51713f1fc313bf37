#include "LogContent.h"

#include <mrpt/img/CImage.h>
#include <viwo/core/Error.h>
#include <viwo/core/So3.h>
#include <viwo/core/Time.h>
#include <viwo/frontend/FeatureTracker.h>
#include <viwo/rawlog/MrptTime.h>
#include <viwo/rawlog/RawlogReader.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

namespace viwo
{
namespace
{
/** Of a run, while the images are followed; the rest is for the equations. */
constexpr double kTrackingShare = 0.5;

class LogReader
{
   public:
	LogReader(const CalibrationRunOptions& options, const CalibrationRunHooks& hooks)
	    : options_(options), hooks_(hooks), labels_(options.odometry.rawlog)
	{
		// Offsets are estimated: stamps stay what they are.
		raw_ = labels_;
		raw_.camera_time_offset_s = raw_.wheel_time_offset_s = 0;
	}

	BatchCalibrationInput read()
	{
		const Calibration calibration = readCalibration(options_.rawlogs, labels_, true, true, false, options_.start.get());
		in_.camera = calibration.camera;
		in_.start = {calibration.T_BO(), calibration.T_BC(), calibration.wheels, labels_.camera_time_offset_s, labels_.wheel_time_offset_s};
		findBegin();
		readSamples();
		followImages();
		return std::move(in_);
	}

   private:
	RawlogReader open(std::vector<std::string> labels) const
	{
		RawlogReaderOptions options;
		options.labels = std::move(labels);
		options.action_odometry_label = labels_.odometry_label;
		options.rig = options_.start;
		return RawlogReader(options_.rawlogs, options);
	}

	bool isPart() const { return options_.from_s > 0 || std::isfinite(options_.to_s); }

	void findBegin()
	{
		if (!isPart()) return;
		RawlogReader reader = open({labels_.cam_label, labels_.imu_label, labels_.odometry_label});
		if (const auto first = reader.next()) first_ns_ = nanosecondsOf(first->timestamp);
	}

	void readSamples()
	{
		RawlogReader reader = open({labels_.imu_label, labels_.odometry_label});
		ObservationAdapter adapter(raw_);
		while (const auto observation = next(reader))
		{
			const AdaptedObservation adapted = convert(adapter, observation);
			if (const auto* imu = std::get_if<ImuSample>(&adapted.sample)) in_.imu.push_back(*imu);
			if (const auto* wheels = std::get_if<WheelSample>(&adapted.sample)) in_.wheels.push_back(*wheels);
		}
		if (isPart() && (in_.imu.empty() || in_.wheels.empty())) throw nothingInPart();
		if (in_.wheels.empty()) throw missingSensorError(rawlogNames(options_.rawlogs), SensorKind::odometry, labels_, reader.counts());
	}

	void followImages()
	{
		RawlogReader reader = open({labels_.cam_label});
		ObservationAdapter adapter(raw_);
		FeatureTracker tracker(in_.camera, options_.odometry.tracker);
		while (const auto observation = next(reader))
		{
			const AdaptedObservation adapted = convert(adapter, observation);
			const auto* image = std::get_if<ImageRef>(&adapted.sample);
			if (!image) continue;
			const mrpt::img::CImage grey = image->grey();
			std::optional<Eigen::Quaterniond> R_Cprev_Ccur;
			if (!in_.frames.empty()) R_Cprev_Ccur = turnOfCamera(in_.frames.back().t_ns, image->t_ns);
			in_.frames.push_back(tracker.track(image->t_ns, grey.asCvMatRef(), R_Cprev_Ccur));
			if (hooks_.progress) hooks_.progress(kTrackingShare * reader.progress(), "following corners");
		}
		if (in_.frames.empty() && isPart()) throw nothingInPart();
	}

	Error nothingInPart() const
	{
		return Error(rawlogNames(options_.rawlogs) + ": camera, IMU and wheels are not all there between --from and --to");
	}

	/** Of the part in use. */
	mrpt::obs::CObservation::Ptr next(RawlogReader& reader) const
	{
		while (true)
		{
			if (hooks_.interrupted && hooks_.interrupted())
				throw Error(rawlogNames(options_.rawlogs) + ": interrupted, nothing was written");
			auto observation = reader.next();
			if (!observation || !isPart()) return observation;
			const double t_s = secondsBetween(first_ns_, nanosecondsOf(observation->timestamp));
			if (t_s > options_.to_s) return nullptr;
			if (t_s >= options_.from_s) return observation;
		}
	}

	AdaptedObservation convert(ObservationAdapter& adapter, const mrpt::obs::CObservation::Ptr& observation) const
	try
	{
		return adapter.convert(observation);
	}
	catch (const Error& e)
	{
		throw Error(rawlogNames(options_.rawlogs) + ": " + e.what());
	}

	/** By the gyroscope; nothing where it does not reach. */
	std::optional<Eigen::Quaterniond> turnOfCamera(int64_t from_ns, int64_t to_ns) const
	{
		const int64_t offset_ns = nanoseconds(in_.start.camera_offset_s);
		const auto before = [](int64_t t_ns, const ImuSample& s) { return t_ns < s.t_ns; };
		const auto begin = std::upper_bound(in_.imu.begin(), in_.imu.end(), from_ns + offset_ns, before);
		const auto end = std::upper_bound(begin, in_.imu.end(), to_ns + offset_ns, before);
		if (begin == in_.imu.begin() || end == in_.imu.end()) return std::nullopt;
		Eigen::Quaterniond R = Eigen::Quaterniond::Identity();
		int64_t t_ns = from_ns + offset_ns;
		for (auto s = begin; s <= end; ++s)
		{
			const int64_t until_ns = std::min(s->t_ns, to_ns + offset_ns);
			R = R * so3::expQuaternion(0.5 * ((s - 1)->gyro_rad_s + s->gyro_rad_s) * secondsBetween(t_ns, until_ns));
			t_ns = until_ns;
		}
		const Eigen::Quaterniond& R_BC = in_.start.T_BC.R;
		return (R_BC.conjugate() * R * R_BC).normalized();
	}

	const CalibrationRunOptions& options_;
	const CalibrationRunHooks& hooks_;
	const AdapterOptions& labels_;
	AdapterOptions raw_;
	BatchCalibrationInput in_;
	int64_t first_ns_ = 0;  //!< where only a part is wanted
};
}  // namespace

BatchCalibrationInput readLog(const CalibrationRunOptions& options, const CalibrationRunHooks& hooks)
{
	return LogReader(options, hooks).read();
}
}  // namespace viwo
