#include "EstimatorImpl.h"
#include "Propagation.h"
#include "VisionStart.h"
#include "WheelStart.h"
#include "WindowSolver.h"
#include "WindowUpdate.h"

#include <viwo/core/Time.h>

namespace viwo
{
namespace
{
/** The first solve starts far from the optimum. */
constexpr int kStartIterations = 30;
/** Vision is tried at this spacing: a reconstruction that fails is not cheap. */
constexpr double kVisionStartPeriod_s = 0.3;
}  // namespace

bool Estimator::Impl::tryToStart(int64_t t_ns)
{
	Stage stage(hook, "initialize");
	if (!reckoning) status.set(Status::initialising, t_ns, "first frame");
	if (window.frames.size() < 2) return false;
	WheelOdometry start(options, calibration.wheels);
	if (reckoning)
	{
		start = *reckoning;
		const int64_t wheels_ns = window.offsets().wheelTime(t_ns);
		if (!options.useWheels() || !start.advance(wheel_samples, wheels_ns)) start.passUnknown(wheels_ns);
	}
	const std::optional<StatusChange> found = findStart(t_ns, start.T_WO());
	if (!found) return false;
	window.landmarks.triangulate(window.T_BC_pose());
	const SolveReport solved = solveWindow(window, kStartIterations);
	if (!solved.usable || !plausible(window.latest().state()) || !plausible(window.offsets()))
	{
		loseWindow("the first window could not be solved", nominalBelief(options, calibration));
		return false;
	}
	running = true;
	adoptCalibration();
	status.set(found->to, t_ns, found->cause);
	gauge.startAt(start.T_WO(), start.covariance());
	window.landmarks.assess(window.T_BC_pose());
	updateStatus(t_ns);
	return true;
}

/** Puts states into the waiting frames, with O of the latest at T_WO. @return the status that comes of it. */
std::optional<StatusChange> Estimator::Impl::findStart(int64_t t_ns, const Pose3& T_WO)
{
	const bool from_wheels = options.useWheels() && options.factors.wheels_in_initialization;
	if (from_wheels) dropFramesBeforeWheels(window);
	const double waited_s = secondsBetween(window.frames.front()->t_ns, t_ns);
	if (from_wheels && waited_s >= options.window.start_after_s && startFromWheels(window, intervals, T_WO))
		return StatusChange{t_ns, status.now(), Status::from_wheels, "wheels, accelerometer and gyro give the first pose"};
	if (!visionDue(t_ns) || !startFromVision(window, intervals, T_WO)) return std::nullopt;
	const char* const with = options.useWheels() ? "vision aligned with IMU and wheels" : "vision aligned with the IMU";
	return StatusChange{t_ns, status.now(), Status::tracking, with};
}

bool Estimator::Impl::visionDue(int64_t t_ns)
{
	if (!options.useCamera() || (last_vision_try_ns && secondsBetween(*last_vision_try_ns, t_ns) < kVisionStartPeriod_s)) return false;
	last_vision_try_ns = t_ns;
	return true;
}
}  // namespace viwo
