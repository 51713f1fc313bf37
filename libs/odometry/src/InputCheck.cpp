#include "InputCheck.h"

#include <mrpt/core/format.h>
#include <viwo/core/Error.h>
#include <viwo/core/Time.h>
#include <viwo/core/TimeText.h>
#include <viwo/rawlog/MrptTime.h>
#include <viwo/rawlog/RawlogReader.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "MountingCheck.h"

namespace viwo
{
namespace
{
/** Rates, mounting and clocks are judged by this much of the log, from where all sensors are there. */
constexpr double kLook_s = 3;

struct Sensor
{
	SensorKind kind;
	bool needed;
	std::string label;
	const char* class_name;
	double to_imu_clock_s;  //!< by the configuration
	uint64_t count = 0;
	int64_t first_ns = 0, last_ns = 0;

	void add(int64_t t_ns)
	{
		if (count++ == 0) first_ns = t_ns;
		last_ns = t_ns;
	}
	double rate_hz() const { return count < 2 ? 0 : static_cast<double>(count - 1) / secondsBetween(first_ns, last_ns); }
	bool missing() const { return needed && count == 0; }
};

/** Nothing for an empty or damaged log, which is told in its turn. */
std::optional<int64_t> firstStamp_ns(RawlogReader reader)
try
{
	const auto first = reader.next();
	return first ? std::optional(nanosecondsOf(first->timestamp)) : std::nullopt;
}
catch (const Error&)
{
	return std::nullopt;
}

/** The reader finds it, too, but not before it has come to the end of a log. */
void requireOrderOfTime(const std::vector<std::string>& rawlogs, const RawlogReaderOptions& options)
{
	for (size_t i = 1; i < rawlogs.size(); ++i)
	{
		const std::string &path = rawlogs[i], &path_before = rawlogs[i - 1];
		std::error_code ignored;
		const auto isFile = [&](const std::string& p) { return std::filesystem::is_regular_file(p, ignored); };
		if (!isFile(path) || !isFile(path_before)) continue;  // a pipe is read in its turn
		const auto first_ns = firstStamp_ns(RawlogReader(path, options)), before_ns = firstStamp_ns(RawlogReader(path_before, options));
		if (!first_ns || !before_ns || *first_ns >= *before_ns) continue;
		throw Error(path + mrpt::format(": begins %.3f s before ", secondsBetween(*first_ns, *before_ns)) + path_before +
		            "; give the rawlogs of one run in the order of their time");
	}
}

class Look
{
   public:
	Look(const OdometryRunOptions& options, const std::function<bool()>& interrupted)
	    : options_(options),
	      interrupted_(interrupted),
	      sensors_{sensor(SensorKind::camera), sensor(SensorKind::imu), sensor(SensorKind::odometry)},
	      mounting_(options.odometry)
	{
	}

	void look()
	{
		RawlogReaderOptions reader_options;
		for (const Sensor& s : sensors_)
			if (s.needed) reader_options.labels.push_back(s.label);
		reader_options.action_odometry_label = labels().odometry_label;
		reader_options.skip_missing_images = true;
		reader_options.rig = options_.rig;
		RawlogReader reader(options_.rawlogs, reader_options);
		requireOrderOfTime(options_.rawlogs, reader_options);
		const bool reached_end = !scan(reader);
		if (interrupted_ && interrupted_()) return;
		requireOneClock(reader.counts());
		if (reached_end && camera().missing()) requireImageFiles(reader.counts());
		for (const Sensor& s : sensors_)
			if (reached_end && s.missing()) throw missingSensor(s.kind, reader.counts());
		requireFastImu();
		withRawlog([&] { mounting_.judge(); });
	}

   private:
	std::string names() const { return rawlogNames(options_.rawlogs); }
	const AdapterOptions& labels() const { return options_.odometry.rawlog; }
	Sensor& camera() { return sensors_[0]; }
	Sensor& imu() { return sensors_[1]; }

	Error missingSensor(SensorKind kind, const RawlogCounts& counts) const
	{
		const EstimatorOptions& e = options_.odometry.estimator;
		const bool for_its_pose = (kind == SensorKind::camera && !e.useCamera()) || (kind == SensorKind::imu && !e.useImu());
		return Error(missingSensorError(names(), kind, labels(), counts).what() +
		             std::string(for_its_pose
		                             ? kind == SensorKind::imu ? " (--pose-frame B needs its pose)" : " (--pose-frame C needs its pose)"
		                             : ""));
	}

	/** The pose of the camera or IMU is needed, too, where it is to be written. */
	Sensor sensor(SensorKind kind) const
	{
		const EstimatorOptions& e = options_.odometry.estimator;
		switch (kind)
		{
			case SensorKind::camera:
				return {kind, e.useCamera() || options_.pose_frame == PoseFrame::C, labels().cam_label, "CObservationImage",
				        labels().camera_time_offset_s};
			case SensorKind::imu:
				return {kind, e.useImu() || options_.pose_frame == PoseFrame::B, labels().imu_label, "CObservationIMU", 0};
			case SensorKind::odometry:
				break;
		}
		return {kind, e.useWheels(), labels().odometry_label, "CObservationOdometry", labels().wheel_time_offset_s};
	}

	/** @return false at the end of the log; true when enough was seen, or when the log is damaged, which is told in its turn. */
	bool scan(RawlogReader& reader)
	{
		std::optional<int64_t> all_seen_ns;
		while (const auto observation = nextOf(reader))
		{
			const int64_t t_ns = nanosecondsOf(observation->timestamp);
			take(observation, t_ns);
			const bool all_seen = std::none_of(sensors_.begin(), sensors_.end(), [](const Sensor& s) { return s.missing(); });
			if (all_seen && !all_seen_ns) all_seen_ns = t_ns;
			if (all_seen && secondsBetween(*all_seen_ns, t_ns) > kLook_s) return true;
			if (interrupted_ && interrupted_()) return true;
		}
		return damaged_;
	}

	mrpt::obs::CObservation::Ptr nextOf(RawlogReader& reader)
	try
	{
		return reader.next();
	}
	catch (const Error&)
	{
		damaged_ = true;
		return nullptr;
	}

	template <class Check>
	void withRawlog(const Check& check) const
	try
	{
		check();
	}
	catch (const Error& e)
	{
		throw Error(names() + ": " + e.what());
	}

	void take(const mrpt::obs::CObservation::Ptr& observation, int64_t t_ns)
	{
		const auto image = std::dynamic_pointer_cast<mrpt::obs::CObservationImage>(observation);
		const auto imu = std::dynamic_pointer_cast<mrpt::obs::CObservationIMU>(observation);
		const auto odometry = std::dynamic_pointer_cast<mrpt::obs::CObservationOdometry>(observation);
		for (Sensor& s : sensors_)
			if (s.needed && observation->sensorLabel == s.label &&
			    (s.kind == SensorKind::camera ? image != nullptr
			     : s.kind == SensorKind::imu  ? imu != nullptr
			                                  : odometry != nullptr))
				s.add(t_ns);
		if (image && observation->sensorLabel == labels().cam_label && camera().needed) withRawlog([&] { mounting_.add(*image); });
		if (imu && observation->sensorLabel == labels().imu_label && options_.odometry.estimator.useImu()) mounting_.add(*imu);
	}

	/** Stamps as they come in the file: what is on another clock never gets as far as being delivered. */
	void requireOneClock(const RawlogCounts& counts) const
	{
		/** Sensors that start one after the other, and an image every few seconds, are none. */
		constexpr double kTolerance_s = 1;
		for (const Sensor& a : sensors_)
			for (const Sensor& b : sensors_)
			{
				const auto ca = counts.sensors.find({a.label, a.class_name}), cb = counts.sensors.find({b.label, b.class_name});
				if (!a.needed || !b.needed || ca == counts.sensors.end() || cb == counts.sensors.end()) continue;
				if (ca->second.read == ca->second.unstamped || cb->second.read == cb->second.unstamped) continue;
				const double apart_s = secondsBetween(ca->second.last_t_ns, cb->second.first_t_ns) + b.to_imu_clock_s - a.to_imu_clock_s;
				if (apart_s <= kTolerance_s) continue;
				throw Error(names() + ": " + a.label + " and " + b.label +
				            " are on different clocks, or were not recorded together: at the same place of the log " + a.label +
				            " has stamps up to " + formatSeconds(ca->second.last_t_ns) + " s, " + b.label + " from " +
				            formatSeconds(cb->second.first_t_ns) + " s; record them with one clock");
			}
	}

	/** Where there are images but none of their files, the reader's own message says where it looked. */
	void requireImageFiles(const RawlogCounts& counts) const
	{
		const auto sensor = counts.sensors.find({labels().cam_label, "CObservationImage"});
		if (sensor == counts.sensors.end() || sensor->second.missing_images == 0) return;
		RawlogReaderOptions reader_options;
		reader_options.labels = {labels().cam_label};
		RawlogReader reader(options_.rawlogs, reader_options);
		while (reader.next())
			;
	}

	void requireFastImu()
	{
		const EstimatorOptions& e = options_.odometry.estimator;
		if (!e.useCamera() || !e.useImu() || camera().count < 3 || imu().rate_hz() > camera().rate_hz()) return;
		const std::string rates = mrpt::format("the IMU has %.1f Hz, the camera %.1f Hz", imu().rate_hz(), camera().rate_hz());
		throw Error(names() + ": " + rates + " (labels " + labels().imu_label + ", " + labels().cam_label +
		            "): an IMU must be faster than the camera; record it at 100 Hz or more, or run --mode wheel");
	}

	const OdometryRunOptions& options_;
	const std::function<bool()>& interrupted_;
	std::array<Sensor, 3> sensors_;
	MountingCheck mounting_;
	bool damaged_ = false;
};

/** OpenCV would add a warning of its own to the tracker's message. */
void requireMask(const OdometryRunOptions& options)
{
	const std::string& mask = options.odometry.tracker.mask_path;
	std::error_code ignored;
	if (!options.odometry.estimator.useCamera() || mask.empty() || std::filesystem::is_regular_file(mask, ignored)) return;
	throw Error((options.config_path.empty() ? std::string() : options.config_path + ": ") + "[tracker] mask_path = " + mask +
	            ": no such file; give an image file, or leave it empty");
}
}  // namespace

void checkInput(const OdometryRunOptions& options, const std::function<bool()>& interrupted)
{
	requireMask(options);
	Look(options, interrupted).look();
}
}  // namespace viwo
