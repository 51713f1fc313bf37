#pragma once

#include <viwo/estimator/Estimator.h>
#include <viwo/evaluation/TrajectoryErrors.h>
#include <viwo/sim/ImuModel.h>
#include <viwo/sim/Motion.h>
#include <viwo/sim/SyntheticTracks.h>
#include <viwo/sim/WheelModel.h>

#include <functional>
#include <iostream>
#include <string>
#include <vector>

namespace viwo::test
{
/** What a robot's sensors say on a drive through a room of points: no image, no file. */
struct DriveSetup
{
	sim::Route route;
	sim::FloorOptions floor;
	sim::VibrationOptions vibration;
	sim::ImuOptions imu;
	sim::WheelOptions wheels;
	sim::TrackOptions tracks;
	Eigen::Vector3d room_min{-4, -3, 0}, room_max{6, 4, 2.6};
	size_t room_points = 600;
	uint64_t seed = 1;

	explicit DriveSetup(const std::string& segments, uint64_t run_seed = 1) : seed(run_seed)
	{
		route.segments = segments;
		tracks.max_features = 60;
	}

	static DriveSetup perfect(const std::string& segments)
	{
		DriveSetup s(segments);
		s.floor = sim::FloorOptions::flat();
		s.vibration = sim::VibrationOptions::off();
		s.imu = sim::ImuOptions::perfect();
		s.wheels = sim::WheelOptions::perfect();
		s.tracks.pixel_noise_px = 0;
		return s;
	}
};

/** Readings of a drive; a test may take away or change any of them before they are fed. */
struct Drive
{
	explicit Drive(const DriveSetup& setup)
	    : motion(setup.route, setup.floor, setup.vibration, setup.seed),
	      imu_model(motion, setup.imu, setup.seed),
	      wheel_model(motion, setup.wheels, setup.seed),
	      imu(imu_model.samples()),
	      wheels(wheel_model.samples(0, motion.duration_s()))
	{
		calibration.T_OB = imu_model.T_OB();
		calibration.T_OC = Pose3(forwardOpticalAxes(), Eigen::Vector3d(0.1, 0, 0.3));
		calibration.camera = CameraModel(640, 480, 250, 250, 319.5, 239.5);
		calibration.wheels = wheel_model.nominal();
		const auto points = sim::randomRoomPoints(setup.room_min, setup.room_max, setup.room_points, 7);
		frames = sim::makeFeatureFrames(motion, calibration, points, setup.tracks, setup.seed);
	}

	double secondsOf(int64_t t_ns) const { return secondsBetween(motion.epoch_ns(), t_ns); }

	/** Takes away what was measured in [from_s, to_s). */
	template <class Sample>
	void silence(std::vector<Sample>& samples, double from_s, double to_s) const
	{
		std::vector<Sample> kept;
		for (const Sample& s : samples)
			if (secondsOf(s.t_ns) < from_s || secondsOf(s.t_ns) >= to_s) kept.push_back(s);
		samples = kept;
	}
	void blacken(double from_s, double to_s)
	{
		for (FeatureFrame& f : frames)
			if (secondsOf(f.t_ns) >= from_s && secondsOf(f.t_ns) < to_s) f.features.clear();
	}

	sim::Motion motion;
	sim::ImuModel imu_model;
	sim::WheelModel wheel_model;
	Calibration calibration;
	std::vector<ImuSample> imu;
	std::vector<WheelSample> wheels;
	std::vector<FeatureFrame> frames;
};

struct DriveResult
{
	std::vector<FrameEstimate> estimates;
	Trajectory trajectory;
	std::vector<StatusChange> changes;
	EstimatorCounters counters;
	Status status = Status::waiting;
	CalibrationEstimate calibration;
	CalibrationDeviations deviations;
	size_t frames_without_pose = 0;
	double first_pose_s = -1;  //!< after the first frame

	bool finite() const
	{
		for (const FrameEstimate& e : estimates)
			if (!e.T_WO.p.allFinite() || !e.T_WO.R.coeffs().allFinite() || !e.covariance.allFinite() || !e.state.v_WB.allFinite() ||
			    !e.state.b_a.allFinite() || !e.state.b_g.allFinite())
				return false;
		return true;
	}
	/** Largest distance between neighbouring poses, m. */
	double largestStep_m() const
	{
		double largest = 0;
		for (size_t i = 1; i < trajectory.size(); ++i)
			largest = std::max(largest, (trajectory.poses()[i].T.p - trajectory.poses()[i - 1].T.p).norm());
		return largest;
	}
};

/** Feeds a drive: a frame waits for samples that reach up to it, at most 0.3 s, as in the odometry module.
 *  @param each called after every frame.
 */
inline DriveResult runDrive(const Drive& drive, const EstimatorOptions& options,
                            const std::function<void(const Estimator&, const FrameEstimate&)>& each = nullptr)
{
	constexpr int64_t kWait_ns = 300'000'000;
	Estimator estimator(options, drive.calibration);
	DriveResult result;
	size_t i = 0, w = 0;
	for (const FeatureFrame& frame : drive.frames)
	{
		const auto due = [](const auto& samples, size_t next, int64_t t_ns)
		{ return next < samples.size() && (next == 0 || samples[next - 1].t_ns < t_ns) && samples[next].t_ns <= t_ns + kWait_ns; };
		while (due(drive.imu, i, estimator.imuNeededFor(frame.t_ns))) estimator.addImu(drive.imu[i++]);
		while (due(drive.wheels, w, estimator.wheelsNeededFor(frame.t_ns))) estimator.addWheels(drive.wheels[w++]);
		const FrameEstimate estimate = estimator.addFrame(frame);
		result.estimates.push_back(estimate);
		if (estimate.has_pose && (result.trajectory.empty() || estimate.t_ns > result.trajectory.poses().back().t_ns))
			result.trajectory.push_back({estimate.t_ns, estimate.T_WO});
		if (!estimate.has_pose) ++result.frames_without_pose;
		if (estimate.has_pose && result.first_pose_s < 0) result.first_pose_s = secondsBetween(drive.frames.front().t_ns, frame.t_ns);
		if (each) each(estimator, estimate);
	}
	result.changes = estimator.statusChanges();
	result.counters = estimator.counters();
	result.status = estimator.status();
	result.calibration = estimator.calibration();
	result.deviations = estimator.calibrationDeviations();
	return result;
}

inline DriveResult runDrive(const DriveSetup& setup, const EstimatorOptions& options)
{
	return runDrive(Drive(setup), options);
}

inline EstimatorOptions optionsOf(Mode mode)
{
	EstimatorOptions options;
	options.mode = mode;
	return options;
}

/** After alignment with the exact trajectory. */
inline TrajectoryErrors errorsOf(const Drive& drive, const DriveResult& result)
{
	return evaluate(drive.motion.groundTruth(), result.trajectory, EvaluationOptions());
}

inline void measured(const std::string& what, double value, const std::string& unit)
{
	std::cout << "[measured] " << what << ": " << value << " " << unit << "\n";
}

/** Seeds of a repeated run: instrumented builds, five to ten times slower, take the first two. */
inline int seedsOf(int seeds)
{
#if defined(__SANITIZE_ADDRESS__)
	return std::min(seeds, 2);
#else
	return seeds;
#endif
}
}  // namespace viwo::test
