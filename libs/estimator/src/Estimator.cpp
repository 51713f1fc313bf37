#include <viwo/core/So3.h>
#include <viwo/core/Time.h>
#include <viwo/estimator/Estimator.h>

#include "ImuPreintegration.h"
#include "IntervalFactory.h"
#include "SampleBuffer.h"
#include "StateOrder.h"
#include "StatusLog.h"
#include "VisionStart.h"
#include "WheelGates.h"
#include "WheelOdometry.h"
#include "WheelPreintegration.h"
#include "WheelStart.h"
#include "Window.h"
#include "WindowSolver.h"
#include "WindowUpdate.h"
#include "residuals/BlockAlgebra.h"
#include "residuals/LinearPrior.h"

#include <algorithm>
#include <optional>

namespace viwo
{
namespace
{
// States beyond these are no robot's: the window has diverged.
constexpr double kMaxSpeed_m_s = 60;
constexpr double kMaxAccBias_m_s2 = 3;
constexpr double kMaxGyroBias_rad_s = 0.5;
/** The first solve starts far from the optimum. */
constexpr int kStartIterations = 30;
/** Of the covariance of the wheels while the robot stands: they have no noise then, and what they say of the heading must outlast minutes. */
constexpr double kStandstillTrust = 1e-5;
/** Vision is tried at this spacing: a reconstruction that fails is not cheap. */
constexpr double kVisionStartPeriod_s = 0.3;

bool plausible(const NavState& s)
{
	const bool finite = s.T_WB.p.allFinite() && s.T_WB.R.coeffs().allFinite() && s.v_WB.allFinite() && s.b_a.allFinite() && s.b_g.allFinite();
	return finite && s.v_WB.norm() < kMaxSpeed_m_s && s.b_a.norm() < kMaxAccBias_m_s2 && s.b_g.norm() < kMaxGyroBias_rad_s;
}

/** Before the start only the rotation is known, from the gyro: enough to tell keyframes. */
void predictRotation(Frame& frame, const Frame& before)
{
	Pose3 T = poseFromBlock(before.pose.data());
	T.R = (T.R * frame.interval.imu->delta().gamma).normalized();
	poseToBlock(T, frame.pose.data());
}

/** One step of strapdown integration from sample a to sample b, rates and forces held at their mean. */
NavState propagateStep(const NavState& s, const ImuSample& a, const ImuSample& b, double gravity_m_s2)
{
	const double dt_s = secondsBetween(a.t_ns, b.t_ns);
	const Eigen::Vector3d w = 0.5 * (a.gyro_rad_s + b.gyro_rad_s) - s.b_g;
	const Eigen::Vector3d f = 0.5 * (a.acc_m_s2 + b.acc_m_s2) - s.b_a;
	NavState next = s;
	next.t_ns = b.t_ns;
	const Eigen::Vector3d acc_W = s.T_WB.R * so3::expQuaternion(0.5 * w * dt_s) * f - Eigen::Vector3d(0, 0, gravity_m_s2);
	next.T_WB.p += s.v_WB * dt_s + 0.5 * acc_W * dt_s * dt_s;
	next.v_WB += acc_W * dt_s;
	next.T_WB.R = (s.T_WB.R * so3::expQuaternion(w * dt_s)).normalized();
	return next;
}
}  // namespace

struct Estimator::Impl
{
	EstimatorOptions options;
	Calibration calibration;
	ImuBuffer imu;
	WheelBuffer wheel_samples;
	Window window;
	IntervalFactory intervals;
	SlipGate slip_gate;
	StandstillGate standstill_gate;
	WheelOdometry wheel_odometry;
	StatusLog status;
	double fresh_track_sigma_rad;  //!< noise of a corner between two images: no drift in it yet
	EstimatorCounters counters;
	StageHook hook;

	bool running = false;
	int64_t next_frame_id = 0;
	std::optional<int64_t> last_frame_ns;  //!< of any frame
	std::optional<int64_t> last_vision_try_ns;
	std::optional<NavState> last_state;	 //!< of the last frame with a pose
	Pose3 T_WO_last;  //!< O when it was last known; a new start continues there
	int64_t t_last_known_ns = 0;
	double velocity_sigma_m_s = 0;	 //!< of that state, along its worst axis
	bool ever_started = false;

	Impl(const EstimatorOptions& o, const Calibration& c)
		: options(o), calibration(c), window(o, c), intervals(o, c.wheels), slip_gate(o, c), wheel_odometry(o, c.wheels), status(o.window),
		  fresh_track_sigma_rad(o.noise.start_pixel_sigma_px / std::max(1.0, c.camera.meanFocal_px()))
	{
	}

	struct Stage
	{
		const StageHook& hook;
		const char* name;
		Stage(const StageHook& h, const char* n) : hook(h), name(n)
		{
			if (hook) hook(name, true);
		}
		~Stage()
		{
			if (hook) hook(name, false);
		}
	};

	FrameEstimate processFrame(const FeatureFrame& features);
	FrameEstimate deadReckonOnWheels(int64_t t_ns);
	bool tryToStart(int64_t t_ns);
	void track(FrameEstimate& out);
	void push(const FeatureFrame& features, const Interval& interval);
	void predictLatest();
	void restart(int64_t t_ns, const std::string& cause);
	Pose3 startPose(int64_t t_ns) const;
	void report(FrameEstimate& out);
	void updateStatus(int64_t t_ns);
	bool visionDue(int64_t t_ns);
};

FrameEstimate Estimator::Impl::processFrame(const FeatureFrame& features)
{
	FrameEstimate out;
	out.t_ns = features.t_ns;
	out.status = status.now();
	if (last_frame_ns && features.t_ns <= *last_frame_ns) return out;
	++counters.frames;
	if (options.mode == Mode::wheel) return deadReckonOnWheels(features.t_ns);
	// A hole in the IMU stream, and not yet one that ends the window: the next frame bridges it.
	if (running && imu.latest_ns() < features.t_ns && secondsBetween(*last_frame_ns, features.t_ns) <= options.window.reinitialize_after_gap_s) return out;

	out.features = static_cast<int>(features.features.size());
	Interval interval;
	{
		Stage stage(hook, "preintegrate");
		if (last_frame_ns) interval = intervals.between(imu, wheel_samples, *last_frame_ns, features.t_ns);
	}
	if (last_frame_ns && !interval.imu) restart(features.t_ns, "no IMU samples between two frames");
	last_frame_ns = features.t_ns;

	push(features, interval);
	if (running)
	{
		predictLatest();
		track(out);
	}
	else if (tryToStart(features.t_ns))
		report(out);
	else
		thinOutWaitingFrames(window);

	if (running)
	{
		Stage stage(hook, "marginalize");
		const Fate fate = advanceWindow(window);
		if (fate == Fate::kept_growing || fate == Fate::kept_oldest_marginalized) ++counters.keyframes;
	}
	out.status = status.now();
	imu.dropBefore(features.t_ns);
	if (running || !ever_started) wheel_samples.dropBefore(features.t_ns);
	return out;
}

FrameEstimate Estimator::Impl::deadReckonOnWheels(int64_t t_ns)
{
	FrameEstimate out;
	out.t_ns = t_ns;
	if (!last_frame_ns)
	{
		if (!wheel_samples.covers(t_ns)) return out;
		wheel_odometry.reset(Pose3());
		status.set(Status::from_wheels, t_ns, "wheels alone");
		t_last_known_ns = t_ns;
	}
	last_frame_ns = t_ns;
	// From the last pose that is known: over a hole in the stream the wheels' next samples say how far it went.
	const auto segments = wheel_samples.segments(t_last_known_ns, t_ns, options.window.max_wheel_gap_s);
	if (segments)
	{
		WheelPreintegration interval(options.noise.wheels, calibration.wheels);
		for (const WheelSegment& s : *segments) interval.integrate(s);
		wheel_odometry.add(interval);
	}
	else if (t_ns > t_last_known_ns)
		++counters.wheel_gaps;
	if (segments || wheel_samples.covers(t_ns)) t_last_known_ns = t_ns;
	wheel_samples.dropBefore(t_last_known_ns);
	out.has_pose = true;
	out.status = status.now();
	out.T_WO = wheel_odometry.T_WO();
	out.covariance = wheel_odometry.covariance();
	out.state.t_ns = t_ns;
	out.state.T_WB = out.T_WO * calibration.T_OB;
	last_state = out.state;
	return out;
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
	if (!running && window.latest().interval.imu) predictRotation(window.latest(), *window.frames[window.frames.size() - 2]);
}

void Estimator::Impl::predictLatest()
{
	const Frame& before = *window.frames[window.frames.size() - 2];
	Frame& latest = window.latest();
	const NavState s = before.state();
	const ImuDelta d = latest.interval.imu->corrected(s.b_a, s.b_g);
	const double dt_s = latest.interval.imu->dt_s();
	const Eigen::Vector3d g_up(0, 0, options.noise.gravity_m_s2);
	NavState predicted = s;
	predicted.T_WB.p = s.T_WB.p + s.v_WB * dt_s - 0.5 * g_up * dt_s * dt_s + s.T_WB.R * d.alpha;
	predicted.v_WB = s.v_WB - g_up * dt_s + s.T_WB.R * d.beta;
	predicted.T_WB.R = (s.T_WB.R * d.gamma).normalized();
	latest.setState(predicted);
}

bool Estimator::Impl::tryToStart(int64_t t_ns)
{
	Stage stage(hook, "initialize");
	if (window.frames.size() < 2)
	{
		status.set(Status::initialising, t_ns, ever_started ? "starting anew" : "first frame");
		return false;
	}
	const bool from_wheels = options.useWheels() && options.factors.wheels_in_initialization;
	if (from_wheels) dropFramesBeforeWheels(window);
	const double waited_s = secondsBetween(window.frames.front()->t_ns, t_ns);
	if (from_wheels && waited_s >= options.window.start_after_s && startFromWheels(window, intervals, startPose(t_ns)))
		status.set(Status::from_wheels, t_ns, "wheels, accelerometer and gyro give the first pose");
	else if (visionDue(t_ns) && startFromVision(window, intervals, startPose(t_ns)))
		status.set(Status::tracking, t_ns, options.useWheels() ? "vision aligned with IMU and wheels" : "vision aligned with the IMU");
	else
		return false;
	running = ever_started = true;
	slip_gate.reset();
	standstill_gate.reset();
	window.landmarks.triangulate(window.T_BC_pose());
	const SolveReport solved = solveWindow(window, kStartIterations);
	if (!solved.usable || !plausible(window.latest().state()))
	{
		restart(t_ns, "the first window could not be solved");
		return false;
	}
	window.landmarks.assess(window.T_BC_pose());
	updateStatus(t_ns);
	return true;
}

void Estimator::Impl::track(FrameEstimate& out)
{
	Frame& latest = window.latest();
	const Frame& before = *window.frames[window.frames.size() - 2];
	const NavState previous = before.state();
	const auto slipping_s = slip_gate.judge(previous, velocity_sigma_m_s, latest.interval, window.wheelIntrinsics());
	out.slip = slipping_s.has_value();
	if (out.slip) distrustWheels(window, *slipping_s);
	const bool was_standing = before.standing;
	if (out.slip) standstill_gate.reset();
	latest.standing = standstill_gate.judge(latest.interval, previous.b_g, before.features, latest.features, fresh_track_sigma_rad);
	if (latest.standing && options.factors.standstill_factor) latest.interval.wheels->scaleCovariance(kStandstillTrust);
	out.standing = latest.standing;
	if (latest.standing && !was_standing) ++counters.standstills;
	{
		Stage stage(hook, "triangulate");
		window.landmarks.triangulate(window.T_BC_pose());
	}
	SolveReport solved;
	{
		Stage stage(hook, "optimize");
		solved = solveWindow(window, options.window.max_iterations);
	}
	if (!solved.usable || !plausible(latest.state()))
	{
		restart(latest.t_ns, "the window diverged");
		return;
	}
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
	const Pose3 T_BO = calibration.T_BO();
	out.T_WO = out.state.T_WB * T_BO;
	out.landmarks = window.landmarks.countKnown(latest);

	Eigen::Matrix<double, 15, 15> covariance_B;
	if (latestCovariance(window, covariance_B))
	{
		// p_WO = p_WB + R_WB p_BO and R_WO = R_WB R_BO, perturbed on the right.
		Eigen::Matrix<double, 6, 6> J = Eigen::Matrix<double, 6, 6>::Zero();
		J.topLeftCorner<3, 3>().setIdentity();
		J.topRightCorner<3, 3>() = -out.state.T_WB.R.toRotationMatrix() * so3::skew(T_BO.p);
		J.bottomRightCorner<3, 3>() = T_BO.R.toRotationMatrix().transpose();
		out.covariance = J * covariance_B.topLeftCorner<6, 6>() * J.transpose();
		velocity_sigma_m_s = std::sqrt(covariance_B.diagonal().segment<3>(StateOrder::v).maxCoeff());
	}
	last_state = out.state;
	T_WO_last = out.T_WO;
	t_last_known_ns = out.t_ns;
}

void Estimator::Impl::restart(int64_t t_ns, const std::string& cause)
{
	if (running)
	{
		++counters.reinitializations;
		status.set(Status::initialising, t_ns, cause);
	}
	running = false;
	last_state.reset();
	window.clear();
	intervals.relinearizeAt(window, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
	slip_gate.reset();
	standstill_gate.reset();
}

Pose3 Estimator::Impl::startPose(int64_t t_ns) const
{
	if (!ever_started) return Pose3();
	const auto segments = wheel_samples.segments(t_last_known_ns, t_ns, options.window.max_wheel_gap_s);
	if (!segments) return T_WO_last;
	WheelPreintegration travelled(options.noise.wheels, calibration.wheels);
	for (const WheelSegment& s : *segments) travelled.integrate(s);
	return T_WO_last * Pose3(travelled.dR(), travelled.dp());
}

void Estimator::Impl::updateStatus(int64_t t_ns)
{
	if (options.useCamera()) status.update(t_ns, window.landmarks.countKnown(window.latest()), window.landmarks.countSeen(window.latest()));
}

bool Estimator::Impl::visionDue(int64_t t_ns)
{
	if (!options.useCamera() || (last_vision_try_ns && secondsBetween(*last_vision_try_ns, t_ns) < kVisionStartPeriod_s)) return false;
	last_vision_try_ns = t_ns;
	return true;
}

Estimator::Estimator(const EstimatorOptions& options, const Calibration& calibration) : impl_(std::make_unique<Impl>(options, calibration)) {}
Estimator::~Estimator() = default;

bool Estimator::addImu(const ImuSample& sample) { return impl_->imu.add(sample); }
bool Estimator::addWheels(const WheelSample& sample) { return impl_->wheel_samples.add(sample); }
FrameEstimate Estimator::addFrame(const FeatureFrame& frame) { return impl_->processFrame(frame); }

Eigen::Quaterniond Estimator::predictCameraRotation(int64_t t_prev_ns, int64_t t_cur_ns) const
{
	const auto span = impl_->imu.span(t_prev_ns, t_cur_ns, impl_->options.window.reinitialize_after_gap_s);
	if (!span) return Eigen::Quaterniond::Identity();
	const Eigen::Vector3d b_g = impl_->last_state ? impl_->last_state->b_g : Eigen::Vector3d::Zero();
	Eigen::Quaterniond R = Eigen::Quaterniond::Identity();
	for (size_t i = 1; i < span->size(); ++i)
	{
		const ImuSample &a = (*span)[i - 1], &b = (*span)[i];
		R = R * so3::expQuaternion((0.5 * (a.gyro_rad_s + b.gyro_rad_s) - b_g) * secondsBetween(a.t_ns, b.t_ns));
	}
	const Eigen::Quaterniond R_BC = impl_->window.T_BC_pose().R;
	return (R_BC.conjugate() * R * R_BC).normalized();
}

std::vector<NavState> Estimator::propagate(int64_t t_after_ns, int64_t t_until_ns) const
{
	std::vector<NavState> states;
	if (!impl_->last_state || !impl_->options.useImu()) return states;
	NavState s = *impl_->last_state;
	const auto span = impl_->imu.span(s.t_ns, std::min(t_until_ns, impl_->imu.latest_ns()), impl_->options.window.reinitialize_after_gap_s);
	if (!span) return states;
	for (size_t i = 1; i < span->size(); ++i)
	{
		s = propagateStep(s, (*span)[i - 1], (*span)[i], impl_->options.noise.gravity_m_s2);
		if (s.t_ns > t_after_ns) states.push_back(s);
	}
	return states;
}

Status Estimator::status() const { return impl_->status.now(); }
const std::vector<StatusChange>& Estimator::statusChanges() const { return impl_->status.changes(); }

const EstimatorCounters& Estimator::counters() const
{
	impl_->counters.slip_events = impl_->slip_gate.events();
	impl_->counters.imu_gaps = impl_->intervals.imuGaps();
	impl_->counters.wheel_gaps += impl_->options.mode == Mode::wheel ? 0 : impl_->intervals.wheelGaps() - impl_->counters.wheel_gaps;
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
		points.push_back({id, T_WC * Eigen::Vector3d(landmark.sightings.front().bearing_C / landmark.inverse_depth_1_m), landmark.deviation});
	}
	return points;
}

CalibrationEstimate Estimator::calibration() const
{
	const Window& w = impl_->window;
	return {w.T_BC_pose(), w.wheelIntrinsics(), w.plane()[0], w.plane()[1], w.plane()[2]};
}

void Estimator::setStageHook(StageHook hook) { impl_->hook = std::move(hook); }
}  // namespace viwo
