#include "InputCheck.h"

#include <viwo/core/Error.h>
#include <viwo/core/Time.h>
#include <viwo/rawlog/MrptTime.h>
#include <viwo/rawlog/RawlogReader.h>

#include <cstdio>

namespace viwo
{
namespace
{
/** Rates are measured over this part of the log. */
constexpr double kLook_s = 3;

struct Sensor
{
	SensorKind kind;
	bool needed;
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

class Look
{
   public:
	explicit Look(const OdometryRunOptions& options)
	    : options_(options),
	      camera_{SensorKind::camera, options.odometry.estimator.useCamera()},
	      imu_{SensorKind::imu, options.odometry.estimator.useImu()},
	      odometry_{SensorKind::odometry, options.odometry.estimator.useWheels()}
	{
	}

	void look()
	{
		RawlogReaderOptions reader_options;
		reader_options.labels = {labels().cam_label, labels().imu_label, labels().odometry_label};
		reader_options.action_odometry_label = labels().odometry_label;
		reader_options.skip_missing_images = true;
		RawlogReader reader(options_.rawlog, reader_options);
		const bool reached_end = !scan(reader);
		if (reached_end && camera_.missing()) requireImageFiles(reader.counts());
		for (const Sensor* s : {&camera_, &imu_, &odometry_})
			if (reached_end && s->missing()) throw missingSensorError(options_.rawlog, s->kind, labels(), reader.counts());
		requireFastImu();
	}

   private:
	const AdapterOptions& labels() const { return options_.odometry.rawlog; }

	/** @return false at the end of the log; true when enough was seen, or when the log is damaged, which is told in its turn. */
	bool scan(RawlogReader& reader)
	try
	{
		std::optional<int64_t> first_ns;
		while (const auto observation = reader.next())
		{
			const int64_t t_ns = nanosecondsOf(observation->timestamp);
			if (!first_ns) first_ns = t_ns;
			take(observation, t_ns);
			const bool all_seen = !camera_.missing() && !imu_.missing() && !odometry_.missing();
			if (all_seen && secondsBetween(*first_ns, t_ns) > kLook_s) return true;
		}
		return false;
	}
	catch (const Error&)
	{
		return true;
	}

	void take(const mrpt::obs::CObservation::Ptr& observation, int64_t t_ns)
	{
		const std::string& label = observation->sensorLabel;
		if (label == labels().cam_label && std::dynamic_pointer_cast<mrpt::obs::CObservationImage>(observation)) camera_.add(t_ns);
		if (label == labels().imu_label && std::dynamic_pointer_cast<mrpt::obs::CObservationIMU>(observation)) imu_.add(t_ns);
		if (label == labels().odometry_label && std::dynamic_pointer_cast<mrpt::obs::CObservationOdometry>(observation))
			odometry_.add(t_ns);
	}

	/** Where there are images but none of their files, the reader's own message says where it looked. */
	void requireImageFiles(const RawlogCounts& counts) const
	{
		const auto sensor = counts.sensors.find({labels().cam_label, "CObservationImage"});
		if (sensor == counts.sensors.end() || sensor->second.missing_images == 0) return;
		RawlogReaderOptions reader_options;
		reader_options.labels = {labels().cam_label};
		RawlogReader reader(options_.rawlog, reader_options);
		while (reader.next())
			;
	}

	void requireFastImu() const
	{
		if (!camera_.needed || !imu_.needed || camera_.count < 3 || imu_.rate_hz() > camera_.rate_hz()) return;
		char rates[96];
		std::snprintf(rates, sizeof rates, "the IMU has %.1f Hz, the camera %.1f Hz", imu_.rate_hz(), camera_.rate_hz());
		throw Error(options_.rawlog + ": " + rates + " (labels " + labels().imu_label + ", " + labels().cam_label +
		            "): an IMU must be faster than the camera; record it at 100 Hz or more, or run --mode wheel");
	}

	const OdometryRunOptions& options_;
	Sensor camera_, imu_, odometry_;
};
}  // namespace

void checkInput(const OdometryRunOptions& options)
{
	Look(options).look();
}
}  // namespace viwo
