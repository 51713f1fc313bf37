#include "CalibrationCovariance.h"
#include "EstimatorImpl.h"
#include "ImuPreintegration.h"
#include "OnlineCalibration.h"
#include "Propagation.h"
#include "StateOrder.h"
#include "WheelPreintegration.h"
#include "WindowSolver.h"
#include "WindowUpdate.h"
#include "residuals/BlockAlgebra.h"

#include <viwo/core/Time.h>

#include <algorithm>
#include <cmath>

namespace viwo
{
namespace
{
/** Of the covariance of the wheels while the robot stands: they have no noise then, and what they say of the heading must outlast minutes.
 */
constexpr double kStandstillTrust = 1e-5;

/** How far offsets may move while intervals of a window last. */
constexpr double kOffsetMargin_s = 0.5;

/** Before the start only the rotation is known, from the gyro: enough to tell keyframes. */
void predictRotation(Frame& frame, const Frame& before)
{
	Pose3 T = poseFromBlock(before.pose.data());
	T.R = (T.R * frame.interval.imu->delta().gamma).normalized();
	poseToBlock(T, frame.pose.data());
}
}  // namespace

FrameEstimate Estimator::Impl::processFrame(const FeatureFrame& features)
{
	FrameEstimate out;
	out.t_ns = features.t_ns;
	out.status = status.now();
	if (last_asked_ns && features.t_ns <= *last_asked_ns) return out;
	last_asked_ns = features.t_ns;
	++counters.frames;
	out.features = static_cast<int>(features.features.size());
	if (options.mode == Mode::wheel)
		runOnWheelsAlone(out);
	else if (inShortImuHole(features.t_ns))
		passOverImuHole(out);
	else
		runOnWindow(features, out);
	out.status = status.now();
	out.t_ns = emittedStamp(features.t_ns);
	forgetSamplesBefore(features.t_ns);
	return out;
}

/** How far samples must reach for an interval up to a frame: it is cut at the estimate's offsets or at those of the other intervals. */
int64_t Estimator::Impl::imuNeeded(int64_t t_frame_ns) const
{
	return std::max(window.offsets().imuTime(t_frame_ns), intervals.offsets().imuTime(t_frame_ns));
}
int64_t Estimator::Impl::wheelsNeeded(int64_t t_frame_ns) const
{
	return std::max(window.offsets().wheelTime(t_frame_ns), intervals.offsets().wheelTime(t_frame_ns));
}

/** Stamps do not go back where an offset does. */
int64_t Estimator::Impl::emittedStamp(int64_t t_frame_ns)
{
	int64_t t_ns = window.offsets().imuTime(t_frame_ns);
	if (last_emitted_ns) t_ns = std::max(t_ns, *last_emitted_ns + 1);
	last_emitted_ns = t_ns;
	return t_ns;
}

void Estimator::Impl::runOnWindow(const FeatureFrame& features, FrameEstimate& out)
{
	Interval interval;
	{
		Stage stage(hook, "preintegrate");
		if (running) intervals.recut(window, imu, wheel_samples);
		if (last_frame_ns) interval = intervals.between(imu, wheel_samples, *last_frame_ns, features.t_ns);
	}
	if (last_frame_ns && !interval.imu) loseWindow("no IMU samples between two frames", running ? learnedBelief(window) : window.belief);
	last_frame_ns = features.t_ns;

	push(features, interval);
	if (running)
		track(out);
	else if (tryToStart(features.t_ns))
		report(out);
	else
		thinOutWaitingFrames(window);
	if (!running)
	{
		carryOnWithoutWindow(out);
		return;
	}
	slide();
}

void Estimator::Impl::slide()
{
	Stage stage(hook, "marginalize");
	const Fate fate = advanceWindow(window);
	if (fate != Fate::kept_growing && fate != Fate::kept_oldest_marginalized) return;
	++counters.keyframes;
	if ((!options.calibratesWheels() && !options.calibratesClocks()) || window.frames.size() < 3) return;
	const size_t kept = window.frames.size() - 2;
	const bool camera_tracks = !options.useCamera() || status.now() == Status::tracking;
	noteExcitation(window, *window.frames[kept - 1], *window.frames[kept], camera_tracks);
}

void Estimator::Impl::adoptCalibration()
{
	window.adoptMounting();
	slip_gate.setMounting(window.calibration.T_OB);
}

void Estimator::Impl::push(const FeatureFrame& features, const Interval& interval)
{
	auto frame = std::make_unique<Frame>();
	frame->id = next_frame_id++;
	frame->t_ns = features.t_ns;
	frame->pose[6] = 1;
	if (options.useCamera()) frame->features = features;
	if (!window.frames.empty()) frame->interval = interval;
	window.frames.push_back(std::move(frame));
	if (options.useCamera()) window.landmarks.add(window.latest());
	if (!window.latest().interval.imu) return;
	const Frame& before = *window.frames[window.frames.size() - 2];
	if (running)
		window.latest().setState(predict(before.state(), *window.latest().interval.imu, options.noise.gravity_m_s2));
	else
		predictRotation(window.latest(), before);
}

void Estimator::Impl::judgeWheels(FrameEstimate& out)
{
	Frame& latest = window.latest();
	const Frame& before = *window.frames[window.frames.size() - 2];
	const NavState previous = before.state();
	const auto slipping_s = slip_gate.judge(previous, velocity_sigma_m_s, latest.interval, window.wheelIntrinsics());
	out.slip = slipping_s.has_value();
	if (out.slip)
	{
		distrustWheels(window, *slipping_s);
		standstill_gate.reset();
	}
	latest.standing = standstill_gate.judge(latest.interval, previous.b_g, before.features, latest.features, fresh_track_sigma_rad);
	if (latest.standing && options.factors.standstill_factor) latest.interval.wheels->scaleCovariance(kStandstillTrust);
	if (latest.standing && !before.standing) ++counters.standstills;
	out.standing = latest.standing;
}

void Estimator::Impl::track(FrameEstimate& out)
{
	const Frame& latest = window.latest();
	if (status_before_hole) status.set(*status_before_hole, latest.t_ns, "the IMU is back");
	status_before_hole.reset();
	judgeWheels(out);
	{
		Stage stage(hook, "triangulate");
		window.landmarks.triangulate(window.T_BC_pose());
	}
	SolveReport solved;
	{
		Stage stage(hook, "optimize");
		solved = solveWindow(window, options.window.max_iterations);
	}
	if (!solved.usable || !plausible(latest.state()) || !plausible(window.offsets()))
	{
		loseWindow("the window diverged", nominalBelief(options, calibration));
		return;
	}
	adoptCalibration();
	window.landmarks.assess(window.T_BC_pose());
	updateStatus(latest.t_ns);
	intervals.relinearize(window);
	report(out);
}

void Estimator::Impl::report(FrameEstimate& out)
{
	Stage stage(hook, "covariance");
	const Frame& latest = window.latest();
	out.has_pose = true;
	out.state = latest.state();
	out.state.t_ns = window.offsets().imuTime(latest.t_ns);
	out.T_WO = out.state.T_WB * window.calibration.T_BO();
	out.landmarks = window.landmarks.countKnown(latest);
	if (!reckoning) reckoning.emplace(options, calibration.wheels);

	Eigen::Matrix<double, 15, 15> in_window;
	if (latestCovariance(window, in_window))
	{
		out.covariance =
		    gauge.covarianceOf(out.T_WO, vehicleCovariance(out.state.T_WB, window.calibration.T_BO(), in_window.topLeftCorner<6, 6>()));
		velocity_sigma_m_s = std::sqrt(in_window.diagonal().segment<3>(StateOrder::v).maxCoeff());
	}
	else
		out.covariance = reckoning->covariance();
	last_state = out.state;
	reckoning->reset(window.offsets().wheelTime(latest.t_ns), out.T_WO, out.covariance, {out.state.v_WB.norm(), 0});
}

void Estimator::Impl::updateStatus(int64_t t_ns)
{
	if (options.useCamera()) status.update(t_ns, window.landmarks.countKnown(window.latest()), window.landmarks.countSeen(window.latest()));
}

/** What neither the next interval nor the reckoning begins with. */
void Estimator::Impl::forgetSamplesBefore(int64_t t_ns)
{
	int64_t since_ns = last_frame_ns.value_or(t_ns);
	// Intervals may be cut anew, with other offsets.
	if (options.calibratesClocks() && !window.frames.empty()) since_ns = window.frames.front()->t_ns - nanoseconds(kOffsetMargin_s);
	const int64_t wheels_ns = window.offsets().wheelTime(since_ns);
	imu.dropBefore(window.offsets().imuTime(since_ns));
	wheel_samples.dropBefore(reckoning && options.useWheels() ? std::min(wheels_ns, reckoning->t_ns()) : wheels_ns);
}

Estimator::Estimator(const EstimatorOptions& options, const Calibration& calibration) : impl_(std::make_unique<Impl>(options, calibration))
{
}
Estimator::~Estimator() = default;

bool Estimator::addImu(const ImuSample& sample)
{
	return impl_->imu.add(sample);
}
bool Estimator::addWheels(const WheelSample& sample)
{
	return impl_->wheel_samples.add(sample);
}
int64_t Estimator::imuTimeOf(int64_t t_frame_ns) const
{
	return impl_->window.offsets().imuTime(t_frame_ns);
}
int64_t Estimator::imuNeededFor(int64_t t_frame_ns) const
{
	return impl_->imuNeeded(t_frame_ns);
}
int64_t Estimator::wheelsNeededFor(int64_t t_frame_ns) const
{
	return impl_->wheelsNeeded(t_frame_ns);
}
FrameEstimate Estimator::addFrame(const FeatureFrame& frame)
{
	return impl_->processFrame(frame);
}

Eigen::Quaterniond Estimator::predictCameraRotation(int64_t t_prev_ns, int64_t t_cur_ns) const
{
	const auto span = impl_->imu.span(imuTimeOf(t_prev_ns), imuTimeOf(t_cur_ns), impl_->options.window.reinitialize_after_gap_s);
	if (!span) return Eigen::Quaterniond::Identity();
	const Eigen::Quaterniond R_BC = impl_->window.T_BC_pose().R;
	const Eigen::Quaterniond R = turnOver(*span, impl_->last_state ? impl_->last_state->b_g : impl_->window.belief.b_g);
	return (R_BC.conjugate() * R * R_BC).normalized();
}

std::vector<NavState> Estimator::propagate(int64_t t_after_ns, int64_t t_until_ns) const
{
	if (!impl_->last_state || !impl_->options.useImu()) return {};
	const NavState& from = *impl_->last_state;
	const auto span =
	    impl_->imu.span(from.t_ns, std::min(t_until_ns, impl_->imu.latest_ns()), impl_->options.window.reinitialize_after_gap_s);
	if (!span) return {};
	std::vector<NavState> states = propagateOver(from, *span, impl_->options.noise.gravity_m_s2);
	states.erase(states.begin(), std::find_if(states.begin(), states.end(), [&](const NavState& s) { return s.t_ns > t_after_ns; }));
	return states;
}

Status Estimator::status() const
{
	return impl_->status.now();
}
const std::vector<StatusChange>& Estimator::statusChanges() const
{
	return impl_->status.changes();
}

const EstimatorCounters& Estimator::counters() const
{
	impl_->counters.slip_events = impl_->slip_gate.events();
	impl_->counters.imu_gaps = impl_->intervals.imuGaps();
	const bool wheels_alone = impl_->options.mode == Mode::wheel;
	impl_->counters.wheel_gaps = !wheels_alone ? impl_->intervals.wheelGaps() : impl_->reckoning ? impl_->reckoning->gaps() : 0;
	return impl_->counters;
}

std::vector<LandmarkPoint> Estimator::landmarks() const
{
	std::vector<LandmarkPoint> points;
	const Pose3 T_BC = impl_->window.T_BC_pose();
	for (const auto& [id, landmark] : impl_->window.landmarks.all())
	{
		if (!landmark.in_use) continue;
		const Pose3 T_WC = poseFromBlock(landmark.anchor().pose.data()) * T_BC;
		points.push_back(
		    {id, T_WC * Eigen::Vector3d(landmark.sightings.front().bearing_C / landmark.inverse_depth_1_m), landmark.deviation});
	}
	return points;
}

std::vector<KeyFrameView> Estimator::keyFrames() const
{
	std::vector<KeyFrameView> views;
	if (!impl_->running) return views;
	const Pose3 T_BC = impl_->window.T_BC_pose();
	for (const auto& frame : impl_->window.frames)
	{
		if (!frame->keyframe) continue;
		KeyFrameView view{frame->t_ns, poseFromBlock(frame->pose.data()) * T_BC, {}};
		for (const auto& [id, landmark] : impl_->window.landmarks.all())
			if (landmark.in_use && std::any_of(landmark.sightings.begin(), landmark.sightings.end(),
			                                   [&](const Sighting& sighting) { return sighting.frame == frame.get(); }))
				view.landmarks.push_back(id);
		views.push_back(std::move(view));
	}
	return views;
}

CalibrationEstimate Estimator::calibration() const
{
	const Window& w = impl_->window;
	return {w.T_BC_pose(), w.wheelIntrinsics(), w.T_BO_pose(), w.t_d_s, w.t_w_s, w.plane()[0], w.plane()[1], w.plane()[2]};
}

CalibrationDeviations Estimator::calibrationDeviations() const
{
	return viwo::calibrationDeviations(impl_->window, impl_->running);
}
const Calibration& Estimator::calibrationInUse() const
{
	return impl_->window.calibration;
}

void Estimator::setStageHook(StageHook hook)
{
	impl_->hook = std::move(hook);
}
}  // namespace viwo
