#include "ImuLog.h"

#include <viwo/core/Error.h>
#include <viwo/core/MrptPose.h>
#include <viwo/core/Time.h>
#include <viwo/rawlog/MrptTime.h>
#include <viwo/rawlog/ObservationAdapter.h>

#include <cmath>

namespace viwo
{
namespace
{
using namespace mrpt::obs;

/** Whether a robot's wheels turned between two readings. */
class WheelMotion
{
   public:
	/** @return the time over which they did. */
	std::optional<TimeSpan> add(const CObservationOdometry& now, double t_s)
	{
		const bool fast = now.hasVelocities && (std::hypot(now.velocityLocal.vx, now.velocityLocal.vy) > kSpeed_m_s ||
		                                        std::abs(now.velocityLocal.omega) > kRate_rad_s);
		bool moved = fast;
		double begin_s = t_s;
		if (before_)
		{
			begin_s = t_s_;
			const auto step = now.odometry - before_->odometry;
			moved = moved || std::hypot(step.x(), step.y()) > kStep_m || std::abs(step.phi()) > kTurn_rad;
			// One tick to and fro is a wheel at rest on the edge of a tick.
			moved = moved || (now.hasEncodersInfo && before_->hasEncodersInfo &&
			                  (std::abs(now.encoderLeftTicks - before_->encoderLeftTicks) > 1 ||
			                   std::abs(now.encoderRightTicks - before_->encoderRightTicks) > 1));
		}
		before_ = now;
		t_s_ = t_s;
		return moved ? std::optional(TimeSpan{begin_s, t_s}) : std::nullopt;
	}

   private:
	static constexpr double kSpeed_m_s = 2e-3, kRate_rad_s = 5e-3, kStep_m = 5e-4, kTurn_rad = 2e-3;
	std::optional<CObservationOdometry> before_;
	double t_s_ = 0;
};

std::string labelsOf(const RawlogCounts& counts, const std::string& class_name)
{
	std::string text;
	for (const auto& [key, sensor] : counts.sensors)
		if (key.second == class_name) text += (text.empty() ? "" : ", ") + key.first + " (" + std::to_string(sensor.read) + ")";
	return text;
}

class Reader
{
   public:
	Reader(const ImuNoiseOptions& options, const ImuNoiseHooks& hooks)
	    : options_(options),
	      hooks_(hooks),
	      where_(rawlogNames(options.rawlogs)),
	      reader_(options.rawlogs, readerOptions()),
	      adapter_(labels())
	{
	}

	ImuLog read()
	{
		uint64_t count = 0;
		while (const auto observation = reader_.next())
		{
			if ((++count & 0xfff) == 0) proceed();
			if (observation->sensorLabel == options_.imu_label && IS_CLASS(*observation, CObservationIMU))
				addImu(observation, static_cast<const CObservationIMU&>(*observation).sensorPose);
			else if (const auto* odometry = dynamic_cast<const CObservationOdometry*>(observation.get()))
				addOdometry(*odometry);
		}
		const auto counts = adapter_.counts().find(options_.imu_label);
		if (!started_) throw missing();
		if (counts != adapter_.counts().end()) log_.rejected = counts->second.rejected;
		log_.truncated = reader_.truncated();
		return std::move(log_);
	}

   private:
	RawlogReaderOptions readerOptions() const
	{
		RawlogReaderOptions r;
		r.allow_truncated = true;
		r.skip_missing_images = true;  // none is looked at
		return r;
	}
	AdapterOptions labels() const
	{
		AdapterOptions labels;
		labels.cam_label = labels.odometry_label = "";
		labels.imu_label = options_.imu_label;
		return labels;
	}

	void proceed()
	{
		if (hooks_.interrupted && hooks_.interrupted()) throw Error("interrupted: nothing was written");
		if (hooks_.progress) hooks_.progress(reader_.progress(), "reading");
	}

	bool wanted(double t_s) const { return t_s >= options_.from_s && t_s <= options_.to_s; }

	void addImu(const CObservation::Ptr& observation, const mrpt::poses::CPose3D& T_OB)
	{
		const int64_t t_ns = nanosecondsOf(observation->timestamp);
		if (!started_)
		{
			started_ = true;
			log_.start_ns = t_ns;
			log_.T_OB = fromMrpt(T_OB);
		}
		if (!wanted(secondsBetween(log_.start_ns, t_ns))) return;
		AdaptedObservation adapted;
		try
		{
			adapted = adapter_.convert(observation);
		}
		catch (const Error& e)
		{
			throw Error(where_ + ": " + e.what());
		}
		const auto* sample = std::get_if<ImuSample>(&adapted.sample);
		if (!sample) return;
		log_.record.t_ns.push_back(sample->t_ns);
		for (size_t k = 0; k < 3; ++k)
		{
			log_.record.axes[k].push_back(sample->acc_m_s2[static_cast<Eigen::Index>(k)]);
			log_.record.axes[k + 3].push_back(sample->gyro_rad_s[static_cast<Eigen::Index>(k)]);
		}
	}

	void addOdometry(const CObservationOdometry& odometry)
	{
		if (!started_) return;
		const double t_s = secondsBetween(log_.start_ns, nanosecondsOf(odometry.timestamp));
		const auto moved = wheels_[odometry.sensorLabel].add(odometry, t_s);
		if (!moved || !wanted(t_s)) return;
		if (!log_.driven.empty() && moved->begin_s <= log_.driven.back().end_s)
			log_.driven.back().end_s = std::max(log_.driven.back().end_s, moved->end_s);
		else
			log_.driven.push_back(*moved);
	}

	Error missing() const
	{
		const RawlogCounts& counts = reader_.counts();
		const std::string imus = labelsOf(counts, "CObservationIMU");
		if (counts.sensors.count({options_.imu_label, "CObservationIMU"}) != 0)
			return missingSensorError(where_, SensorKind::imu, labels(), counts);
		if (imus.empty()) return Error(where_ + ": no IMU (CObservationIMU) in it; labels here: " + counts.describe());
		return Error(where_ + ": no IMU (CObservationIMU) under label " + options_.imu_label + "; IMUs here: " + imus +
		             "; choose one with --imu-label");
	}

	const ImuNoiseOptions& options_;
	const ImuNoiseHooks& hooks_;
	std::string where_;
	RawlogReader reader_;
	ObservationAdapter adapter_;
	ImuLog log_;
	bool started_ = false;
	std::map<std::string, WheelMotion> wheels_;
};
}  // namespace

ImuLog readImuLog(const ImuNoiseOptions& options, const ImuNoiseHooks& hooks)
{
	return Reader(options, hooks).read();
}
}  // namespace viwo
