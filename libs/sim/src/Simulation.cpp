#include <viwo/core/Error.h>
#include <viwo/rawlog/RawlogWriter.h>
#include <viwo/sim/Simulation.h>

#include <algorithm>
#include <sstream>
#include <tuple>

#include "CameraRecorder.h"

namespace viwo::sim
{
namespace
{
/** Share of the work of rendering, for the progress. */
constexpr double kRenderingShare = 0.93;
constexpr const char* kExtension = ".rawlog";

std::string stemOf(const std::string& rawlog_path)
{
	const std::string extension = kExtension;
	if (rawlog_path.size() <= extension.size() ||
	    rawlog_path.compare(rawlog_path.size() - extension.size(), extension.size(), extension) != 0)
		throw Error(rawlog_path + ": the output must be named X.rawlog");
	return rawlog_path.substr(0, rawlog_path.size() - extension.size());
}
}  // namespace

/** Puts what the sensors give into the log in order of arrival. */
class Simulation::Recorder
{
   public:
	Recorder(const Simulation& simulation, const std::string& rawlog_path, const SimulationRunOptions& options)
	    : s_(simulation),
	      options_(options),
	      writer_(rawlog_path),
	      camera_(s_.motion_, s_.world_, s_.rig_, s_.seed_),
	      imu_(s_.motion_, s_.rig_.imu, s_.seed_),
	      wheels_(s_.motion_, s_.rig_.wheels, s_.seed_),
	      lidar_(s_.motion_, s_.world_, s_.rig_.lidar, s_.seed_),
	      nominal_(s_.rig_.nominalCalibration())
	{
		result_.rawlog = rawlog_path;
		result_.duration_s = s_.motion_.duration_s();
	}

	SimulationResult record()
	{
		if (options_.images) renderImages();
		scheduleArrivals();
		for (size_t i = 0; i < arrivals_.size(); ++i)
		{
			write(arrivals_[i]);
			if (i % 1000 == 0) reportWriting(static_cast<double>(i) / static_cast<double>(arrivals_.size()));
		}
		writer_.close();
		return result_;
	}

	const WheelModel& wheels() const { return wheels_; }

   private:
	enum class Source
	{
		imu,
		odometry,
		camera,
		lidar
	};
	struct Arrival
	{
		double t_s;
		Source source;
		int64_t index;
	};

	void renderImages()
	{
		if (!options_.images_from.empty())
		{
			result_.images = camera_.take(writer_.imagesFolder(), options_.images_from);
			return;
		}
		const auto report = [this](double part) { return !options_.progress || options_.progress(kRenderingShare * part); };
		result_.images = camera_.record(writer_.imagesFolder(), options_.threads, report);
		result_.interrupted = result_.images < camera_.count();
		if (result_.interrupted) result_.duration_s = camera_.time_s(result_.images);
	}

	void scheduleArrivals()
	{
		for (int64_t i = 0; i < result_.images; ++i)
			arrivals_.push_back({camera_.time_s(i) + 1e-3 * s_.rig_.camera.latency_ms, Source::camera, i});
		const auto& imu = imu_.samples();
		for (size_t i = 0; i < imu.size(); ++i) arrivals_.push_back({imu_.time_s(i), Source::imu, static_cast<int64_t>(i)});
		for (size_t i = 0; i < wheels_.readings().size(); ++i)
			arrivals_.push_back({wheels_.readings()[i].t_s, Source::odometry, static_cast<int64_t>(i)});
		if (s_.rig_.lidar.enabled)
			for (int64_t i = 0; i < lidar_.count(); ++i)
				arrivals_.push_back({lidar_.time_s(i) + 1e-3 * s_.rig_.lidar.latency_ms, Source::lidar, i});
		if (result_.interrupted)
			arrivals_.erase(
			    std::remove_if(arrivals_.begin(), arrivals_.end(), [this](const Arrival& a) { return a.t_s > result_.duration_s; }),
			    arrivals_.end());
		std::stable_sort(arrivals_.begin(), arrivals_.end(),
		                 [](const Arrival& a, const Arrival& b)
		                 { return std::tie(a.t_s, a.source, a.index) < std::tie(b.t_s, b.source, b.index); });
	}

	void write(const Arrival& arrival)
	{
		const auto i = static_cast<size_t>(arrival.index);
		switch (arrival.source)
		{
			case Source::imu:
				writer_.write(makeImu(imu_.samples()[i], nominal_.T_OB, s_.rig_.imu.label));
				result_.imu++;
				break;
			case Source::odometry:
				writeOdometry(wheels_.readings()[i]);
				break;
			case Source::camera:
				writer_.write(makeImage(camera_.stamp_ns(arrival.index), nominal_.camera, nominal_.T_OC, camera_.fileName(arrival.index),
				                        s_.rig_.camera.label));
				break;
			case Source::lidar:
				writeScan(lidar_.scan(arrival.index));
				break;
		}
	}

	void writeOdometry(const WheelReading& r)
	{
		const EncoderTicks ticks{static_cast<int32_t>(r.ticks_left), static_cast<int32_t>(r.ticks_right)};
		writer_.write(makeOdometry(r.t_ns, r.mean_twist, ticks, r.x_m, r.y_m, r.yaw_rad, s_.rig_.wheels.label));
		result_.odometry++;
	}

	void writeScan(const LidarScan& scan)
	{
		const LidarOptions& o = s_.rig_.lidar;
		writer_.write(makeScan(scan.t_ns, scan.ranges_m, o.aperture_deg * M_PI / 180, o.max_range_m, lidar_.T_OL(), o.label));
		result_.scans++;
	}

	/** Writing is not interrupted: it takes seconds, and a log without its end would waste the rendering. */
	void reportWriting(double part) const
	{
		const double before = options_.images ? kRenderingShare : 0;
		if (options_.progress) options_.progress(before + (1 - before) * part);
	}

	const Simulation& s_;
	const SimulationRunOptions& options_;
	RawlogWriter writer_;
	CameraRecorder camera_;
	ImuModel imu_;
	WheelModel wheels_;
	LidarModel lidar_;
	Calibration nominal_;
	std::vector<Arrival> arrivals_;
	SimulationResult result_;
};

Simulation::Simulation(World world, const Route& route, const Rig& rig, uint64_t seed)
    : world_(std::move(world)), route_(route), rig_(rig), seed_(seed), motion_(route, rig.floor, rig.vibration, seed)
{
}

Simulation::~Simulation() = default;

SimulationResult Simulation::run(const std::string& rawlog_path, const SimulationRunOptions& options)
{
	const std::string stem = stemOf(rawlog_path);
	Recorder recorder(*this, rawlog_path, options);
	SimulationResult result = recorder.record();

	const Trajectory whole_truth = motion_.groundTruth();
	Trajectory truth;
	for (const StampedPose& pose : whole_truth.poses())
		if (secondsBetween(motion_.epoch_ns(), pose.t_ns) <= result.duration_s) truth.push_back(pose);
	result.length_m = truth.length_m();
	result.ground_truth = stem + "_ground_truth.tum";
	truth.saveTum(result.ground_truth);

	std::ostringstream header;
	const WheelIntrinsics wheels = recorder.wheels().actual();
	header.precision(10);
	header << "Options of this simulated log, seed " << seed_ << ".\nTrue wheels: k_left " << wheels.k_left << ", k_right "
	       << wheels.k_right << ", track_m " << wheels.track_m << ".";
	std::vector<OptionsSection> sections = rig_.sections();
	sections.push_back({"route", &route_});
	result.configuration = stem + "_simulation.ini";
	saveOptions(result.configuration, sections, header.str());
	return result;
}
}  // namespace viwo::sim
