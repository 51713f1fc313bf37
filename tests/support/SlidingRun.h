#pragma once

#include <viwo/core/So3.h>

#include <IntervalFactory.h>
#include <NumericJacobian.h>
#include <SampleBuffer.h>
#include <SimulatedDrive.h>
#include <WheelStart.h>
#include <WindowSolver.h>
#include <WindowUpdate.h>

namespace viwo::test
{
/** A window that slides along a drive: states come in near the truth, nothing else of the estimator takes part. */
class SlidingRun
{
   public:
	SlidingRun(const DriveSetup& setup, const EstimatorOptions& options)
	    : drive(setup), window(options, drive.calibration), factory(options, drive.calibration.wheels)
	{
		for (const ImuSample& s : drive.imu) imu_.add(s);
		for (const WheelSample& s : drive.wheels) wheels_.add(s);
	}

	NavState truthAt(int64_t t_ns) const
	{
		const auto m = drive.motion.at_ns(t_ns);
		const Pose3& T_OB = drive.calibration.T_OB;
		NavState s;
		s.t_ns = t_ns;
		s.T_WB = m.T_WO * T_OB;
		s.v_WB = m.v_WO + m.T_WO.R * m.w_O.cross(T_OB.p);
		return s;
	}

	/** @param state_noise of the new frame's state. */
	Frame& push(const FeatureFrame& features, double state_noise = 0)
	{
		auto frame = std::make_unique<Frame>();
		frame->id = next_id_++;
		frame->t_ns = features.t_ns;
		NavState state = truthAt(features.t_ns);
		state.T_WB.p += random_.vector3(state_noise);
		state.T_WB.R = state.T_WB.R * so3::expQuaternion(random_.vector3(state_noise));
		state.v_WB += random_.vector3(state_noise);
		frame->setState(state);
		if (window.options.useCamera()) frame->features = features;
		if (!window.frames.empty()) frame->interval = factory.between(imu_, wheels_, window.latest().t_ns, features.t_ns);
		window.frames.push_back(std::move(frame));
		if (window.options.useCamera()) window.landmarks.add(window.latest());
		return window.latest();
	}

	/** The steps of the estimator for one frame. @param solves to go on where the solver's tolerance ended it. */
	Fate step(const FeatureFrame& features, double state_noise = 0, int solves = 1)
	{
		push(features, state_noise);
		if (window.frames.size() == 1) addStartPriors(window, window.latest(), 0.1);
		window.landmarks.triangulate(window.T_BC_pose());
		for (int i = 0; i < solves; ++i) solveWindow(window, 20);
		window.landmarks.assess(window.T_BC_pose());
		return advanceWindow(window);
	}

	Interval between(int64_t begin_ns, int64_t end_ns) { return factory.between(imu_, wheels_, begin_ns, end_ns); }

	Drive drive;
	Window window;
	IntervalFactory factory;

   private:
	ImuBuffer imu_;
	WheelBuffer wheels_;
	int64_t next_id_ = 0;
	Random random_{5};
};
}  // namespace viwo::test
