#include "CalibrationCovariance.h"
#include "EstimatorImpl.h"
#include "WindowSolver.h"

#include <viwo/core/Time.h>

namespace viwo
{
void Estimator::Impl::runOnWheelsAlone(FrameEstimate& out)
{
	if (!reckoning)
	{
		if (!wheel_samples.covers(out.t_ns)) return;
		reckoning.emplace(options, calibration.wheels);
		reckoning->reset(out.t_ns, Pose3());
		status.set(Status::from_wheels, out.t_ns, "wheels alone");
	}
	reckon(out);
	out.has_pose = true;
}

/** A hole in the IMU stream, and not yet one that ends the window: the next frame that the IMU reaches bridges it. */
bool Estimator::Impl::inShortImuHole(int64_t t_ns) const
{
	return running && imu.latest_ns() < imuNeeded(t_ns) && secondsBetween(*last_frame_ns, t_ns) <= options.window.reinitialize_after_gap_s;
}

void Estimator::Impl::passOverImuHole(FrameEstimate& out)
{
	if (!status_before_hole)
	{
		status_before_hole = status.now();
		const Belief belief = learnedBelief(window);
		reckoning->setIntrinsics(belief.wheels, belief.wheels_covariance);
	}
	out.has_pose = reckon(out);
	if (secondsBetween(imu.latest_ns(), window.offsets().imuTime(out.t_ns)) <= options.window.max_imu_gap_s) return;
	if (out.has_pose)
		status.set(Status::dead_reckoning, out.t_ns, "no IMU samples: the wheels carry on");
	else
		status.set(Status::waiting, out.t_ns, "no IMU samples, and nothing carries on");
}

/** A new window begins with this belief; where O is, and how well that is known, is with the reckoning. */
void Estimator::Impl::loseWindow(const std::string& cause, const Belief& belief)
{
	if (running) ++counters.reinitializations;
	running = false;
	lost_cause = cause;
	last_state.reset();
	status_before_hole.reset();
	window.clear(belief);
	slip_gate.setMounting(window.calibration.T_OB);
	intervals.beginAt(belief);
	if (reckoning) reckoning->setIntrinsics(belief.wheels, belief.wheels_covariance);
	slip_gate.reset();
	standstill_gate.reset();
}

void Estimator::Impl::carryOnWithoutWindow(FrameEstimate& out)
{
	if (!reckoning) return;
	out.has_pose = reckon(out);
	if (out.has_pose)
		status.set(Status::dead_reckoning, out.t_ns, lost_cause + ": the wheels carry on");
	else
		status.set(Status::initialising, out.t_ns, lost_cause);
}

/** From the last known pose as far as the wheels tell. @return whether they tell all of it. */
bool Estimator::Impl::reckon(FrameEstimate& out)
{
	const int64_t wheels_ns = window.offsets().wheelTime(out.t_ns);
	const bool known = options.useWheels() && reckoning->advance(wheel_samples, wheels_ns);
	WheelOdometry here = *reckoning;
	if (!known) here.passUnknown(wheels_ns);
	out.T_WO = here.T_WO();
	out.covariance = here.covariance();
	out.state = here.bodyState(window.calibration.T_OB);
	out.state.t_ns += nanoseconds(window.t_w_s);
	if (options.useImu()) out.state.b_a = window.belief.b_a, out.state.b_g = window.belief.b_g;
	return known;
}
}  // namespace viwo
