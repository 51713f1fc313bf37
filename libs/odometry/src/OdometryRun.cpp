#include <mrpt/core/format.h>
#include <viwo/core/Error.h>
#include <viwo/core/NumberText.h>
#include <viwo/core/Time.h>
#include <viwo/odometry/Odometry.h>
#include <viwo/odometry/OdometryRun.h>
#include <viwo/rawlog/MrptTime.h>
#include <viwo/rawlog/RawlogReader.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <map>
#include <optional>
#include <vector>

#include "GapLog.h"
#include "InputCheck.h"
#include "MinuteLog.h"
#include "ReplayClock.h"
#include "RunOutputs.h"
#include "RunSummary.h"

namespace viwo
{
namespace
{
using Clock = std::chrono::steady_clock;
/** Landmarks of the window are collected this often. */
constexpr int kFramesBetweenLandmarks = 5;

class Run
{
   public:
	Run(const OdometryRunOptions& options, const OdometryRunHooks& hooks)
	    : options_(options),
	      hooks_(hooks),
	      outputs_(options.output_dir, options.pose_frame),
	      reader_(options.rawlogs, readerOptions(options)),
	      odometry_(options.odometry, calibrationOf(options)),
	      begin_(Clock::now())
	{
		odometry_.setMinLoggingLevel(mrpt::system::LVL_WARN);
		odometry_.stopWhen([this] { return interrupted(); });
		odometry_.onFrame([this](const FrameEstimate& e) { take(e); });
		odometry_.onImuRate([this](const NavState& s) { outputs_.add(s, *odometry_.calibration(), odometry_.calibrationEstimate().T_BC); });
	}

	OdometryRunResult go()
	{
		// What was computed before an error is written like that of a whole run, and the error told afterwards.
		std::exception_ptr error;
		try
		{
			replay();
		}
		catch (const Error& e)
		{
			// Being asked to stop cuts the reading of a pipe short, which then looks like damage.
			result_.interrupted = interrupted();
			if (!result_.interrupted) error = std::make_exception_ptr(Error(withRawlog(e.what())));
		}
		catch (const std::exception&)
		{
			error = std::current_exception();
		}
		if (!error || result_.poses > 0) finish(error != nullptr);
		if (error) std::rethrow_exception(error);
		if (result_.poses == 0) throw Error(noPose());
		return result_;
	}

   private:
	static RawlogReaderOptions readerOptions(const OdometryRunOptions& options)
	{
		const AdapterOptions& labels = options.odometry.rawlog;
		RawlogReaderOptions r;
		const EstimatorOptions& e = options.odometry.estimator;
		r.labels = {labels.cam_label};  // gives the times of frames in every mode
		if (e.useImu()) r.labels.push_back(labels.imu_label);
		if (e.useWheels()) r.labels.push_back(labels.odometry_label);
		r.action_odometry_label = labels.odometry_label;
		r.allow_truncated = options.allow_truncated;
		r.rig = options.rig;
		return r;
	}

	static Calibration calibrationOf(const OdometryRunOptions& options)
	{
		const EstimatorOptions& e = options.odometry.estimator;
		return readCalibration(options.rawlogs, options.odometry.rawlog, e.useCamera() || options.pose_frame == PoseFrame::C,
		                       e.useImu() || options.pose_frame == PoseFrame::B, true, options.rig.get());
	}

	void replay()
	{
		while (!interrupted())
		{
			const auto observation = reader_.next();
			if (!observation) break;
			const int64_t t_ns = nanosecondsOf(observation->timestamp);
			if (!first_ns_) first_ns_ = t_ns;
			const double t_s = secondsBetween(*first_ns_, t_ns);
			read_s_ = std::max(read_s_, t_s);
			if (t_s < options_.from_s) continue;
			if (t_s > options_.to_s) break;
			if (const auto remark = clock_.waitFor(t_s - options_.from_s, [this] { return interrupted(); })) tell(t_s, *remark);
			if (const auto gap = gaps_.add(observation->sensorLabel, t_ns)) tell(*gap);
			last_ns_ = t_ns;
			odometry_.processObservation(observation);
		}
		odometry_.finish();
		if (first_ns_) gaps_.finish(last_ns_);
		result_.interrupted = interrupted();
	}

	bool interrupted() const { return hooks_.interrupted && hooks_.interrupted(); }

	void take(const FrameEstimate& e)
	{
		++result_.frames;
		last_frame_ns_ = e.t_ns;
		outputs_.add(e, *odometry_.calibration(), odometry_.calibrationEstimate().T_BC);
		result_.poses = outputs_.poses();
		minutes_.addFrame(secondsBetween(odometry_.firstFrame_ns(), e.t_ns));
		if (result_.frames % kFramesBetweenLandmarks == 0) collectLandmarks();
		if (hooks_.log)
			for (const auto changes = odometry_.statusChanges(); told_ < changes.size(); ++told_) tell(changes[told_]);
		if (hooks_.progress) hooks_.progress(reader_.progress(), note(e));
	}

	void collectLandmarks()
	{
		outputs_.add(odometry_.landmarks(), options_.odometry.estimator.window.tracking_depth_deviation);
		outputs_.add(odometry_.keyFrames());
	}

	void tell(double t_s, const std::string& what) const
	{
		if (hooks_.log) hooks_.log(mrpt::format("%8.2f s  ", t_s) + what);
	}

	void tell(const StatusChange& c) const
	{
		tell(secondsBetween(odometry_.firstFrame_ns(), c.t_ns), std::string(toString(c.from)) + " -> " + toString(c.to) + ": " + c.cause);
	}

	void tell(const GapLog::Gap& gap) const
	{
		tell(secondsBetween(result_.frames > 0 ? odometry_.firstFrame_ns() : *first_ns_, gap.begin_ns),
		     mrpt::format("gap of %.2f s in ", gap.duration_s) + gap.label);
	}

	/** The message with the name of the rawlog, unless it stands there already. */
	std::string withRawlog(const std::string& message) const
	{
		const auto named = [&](const std::string& path) { return message.find(path) != std::string::npos; };
		const bool is_named = std::any_of(options_.rawlogs.begin(), options_.rawlogs.end(), named);
		return is_named ? message : rawlogNames(options_.rawlogs) + ": " + message;
	}

	/** Observations that could not be used, e.g. "IMU: 3 not_finite, 1 late; ODOMETRY: 2 duplicate_stamp"; empty if all could. */
	std::string leftOut() const
	{
		std::map<std::string, std::string> reasons;  // by label
		const auto add = [&](const std::string& label, uint64_t count, const std::string& reason)
		{
			if (count > 0) reasons[label] += (reasons[label].empty() ? ": " : ", ") + std::to_string(count) + " " + reason;
		};
		const std::vector<std::string> used = readerOptions(options_).labels;
		for (const auto& [key, sensor] : reader_.counts().sensors)
		{
			if (std::find(used.begin(), used.end(), key.first) == used.end()) continue;
			add(key.first, sensor.late, "late");
			add(key.first, sensor.unstamped, "unstamped");
			add(key.first, sensor.stamp_jumps, "stamp_jump");
		}
		for (const auto& [label, counts] : odometry_.observationCounts())
			for (const auto& [reason, count] : counts.rejected) add(label, count, reason);
		std::string text;
		for (const auto& [label, list] : reasons) text.append(text.empty() ? "" : "; ").append(label).append(list);
		return text;
	}

	/** Time, speed of the replay, status, features, position and its deviation, the robot's speed; and, by the log's clock, the lag. */
	std::string note(const FrameEstimate& e) const
	{
		std::string line =
		    mrpt::format("%.1f s at %.1f x, %s, %d features, x %.2f y %.2f m, sigma %.3f m, %.2f m/s",
		                 secondsBetween(odometry_.firstFrame_ns(), e.t_ns), clock_.speed(), toString(e.status), e.features, e.T_WO.p.x(),
		                 e.T_WO.p.y(), std::sqrt(e.covariance(0, 0) + e.covariance(1, 1)), e.state.v_WB.norm());
		if (options_.replay_speed > 0) line += mrpt::format(", lag %.1f s", clock_.lag_s());
		return line;
	}

	void finish(bool failed)
	{
		collectLandmarks();
		result_.largest_lag_s = clock_.largestLag_s();
		result_.wall_time_s = std::chrono::duration<double>(Clock::now() - begin_).count();
		result_.duration_s = result_.frames > 0 ? secondsBetween(odometry_.firstFrame_ns(), last_frame_ns_) : 0;
		result_.path_length_m = outputs_.pathLength_m();
		result_.wheel_travel_m = odometry_.wheelTravel_m();
		result_.doubt = doubt();
		result_.final_status = failed ? "failed" : toString(odometry_.status());
		result_.summary_path = options_.output_dir + "/summary.json";
		if (const std::string left_out = leftOut(); !left_out.empty())
			result_.left_out =
			    rawlogNames(options_.rawlogs) + ": observations were left out (" + left_out + "); the results are of the rest";
		outputs_.commit();
		OdometryOptions effective = options_.odometry;
		saveOptions(options_.output_dir + "/config.ini", effective.sections(),
		            "Effective configuration of viwo-odometry " VIWO_VERSION ", --mode " +
		                modeNames()[static_cast<size_t>(effective.estimator.mode)]);
		writeSummary(result_.summary_path, options_, result_, odometry_, outputs_, reader_.counts(), minutes_, gaps_);
	}

	/** Wrong mounting, intrinsics or wheel settings may give a trajectory that is at one with itself; only the wheels tell. */
	std::string doubt() const
	{
		constexpr double kFactor = 1.25, kSlack_m = 0.5;
		const double path_m = result_.path_length_m, wheels_m = result_.wheel_travel_m;
		const bool judged = options_.odometry.estimator.useWheels() && options_.pose_frame == PoseFrame::O && wheels_m > 0;
		if (!judged || (path_m <= kFactor * wheels_m + kSlack_m && wheels_m <= kFactor * path_m + kSlack_m)) return {};
		return rawlogNames(options_.rawlogs) +
		       mrpt::format(
		           ": the path is %.1f m, but the wheels rolled %.1f m: the result cannot be trusted; check sensorPose and cameraPose, the "
		           "camera's calibration, and the wheels' settings",
		           path_m, wheels_m);
	}

	std::string noPose() const
	{
		const std::string where = rawlogNames(options_.rawlogs) + ": no pose: ";
		if (result_.interrupted) return where + "interrupted before the first";
		if (const std::string left_out = leftOut(); !left_out.empty()) return where + "too much had to be left out (" + left_out + ")";
		if (result_.frames == 0) return where + noFrame();
		return where + "the estimator is still " + toString(odometry_.status()) + " after " +
		       counted(static_cast<size_t>(result_.frames), "frame") +
		       (options_.odometry.estimator.mode == Mode::vio ? "; mode vio needs motion with parallax and acceleration"
		                                                      : "; see summary.json");
	}

	std::string noFrame() const
	{
		if (options_.from_s <= 0 && !std::isfinite(options_.to_s))
			return "no frame was processed; in the log: " + reader_.counts().describe();
		if (options_.from_s > read_s_)
			return mrpt::format("--from %g s is behind the end of the log, which has %.1f s", options_.from_s, read_s_);
		if (read_s_ > options_.to_s)
			return mrpt::format("no frame between --from %g and --to %g s of the log", options_.from_s, options_.to_s);
		return mrpt::format("no frame behind --from %g s of the log, which has %.1f s", options_.from_s, read_s_);
	}

	const OdometryRunOptions& options_;
	const OdometryRunHooks& hooks_;
	RunOutputs outputs_;
	RawlogReader reader_;
	Odometry odometry_;
	Clock::time_point begin_;
	OdometryRunResult result_;
	MinuteLog minutes_;
	GapLog gaps_{options_.odometry};
	ReplayClock clock_{options_.replay_speed};
	std::optional<int64_t> first_ns_;
	double read_s_ = 0;  //!< of the log, used or not
	int64_t last_ns_ = 0, last_frame_ns_ = 0;
	size_t told_ = 0;
};
}  // namespace

OdometryRunResult runOdometry(const OdometryRunOptions& options, const OdometryRunHooks& hooks)
{
	checkInput(options, hooks.interrupted);
	Run run(options, hooks);
	return run.go();
}
}  // namespace viwo
