#pragma once

#include <viwo/estimator/Estimator.h>

#include "IntervalFactory.h"
#include "SampleBuffer.h"
#include "StatusLog.h"
#include "WheelGates.h"
#include "WheelOdometry.h"
#include "Window.h"
#include "WorldGauge.h"

#include <algorithm>
#include <optional>

namespace viwo
{
/** The estimator's state, and the steps that a frame takes: Estimator.cpp with a window, EstimatorStart.cpp towards one,
 * EstimatorReckoning.cpp without. */
struct Estimator::Impl
{
	EstimatorOptions options;
	Calibration calibration;  //!< as given
	ImuBuffer imu;
	WheelBuffer wheel_samples;
	Window window;
	IntervalFactory intervals;
	SlipGate slip_gate;
	StandstillGate standstill_gate;
	StatusLog status;
	double fresh_track_sigma_rad;  //!< noise of a corner between two images: no drift in it yet
	EstimatorCounters counters;
	StageHook hook;

	bool running = false;  //!< the window has states
	int64_t next_frame_id = 0;
	std::optional<int64_t> last_asked_ns;    //!< latest frame of all
	std::optional<int64_t> last_emitted_ns;  //!< its time in the IMU's clock
	std::optional<int64_t> last_frame_ns;    //!< latest one in the window; intervals begin there
	std::optional<int64_t> last_vision_try_ns;
	std::optional<NavState> last_state;      //!< of the last frame that the window gave
	double velocity_sigma_m_s = 0;           //!< of that state, along its worst axis
	std::optional<WheelOdometry> reckoning;  //!< from the last known pose on; nothing before the first
	WorldGauge gauge;
	std::optional<Status> status_before_hole;  //!< set while the IMU does not reach the frames of a running window
	std::string lost_cause;

	Impl(const EstimatorOptions& o, const Calibration& c)
	    : options(o),
	      calibration(c),
	      window(o, c),
	      intervals(o, c.wheels),
	      slip_gate(o, c),
	      status(o.window),
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
	void runOnWheelsAlone(FrameEstimate& out);
	bool inShortImuHole(int64_t t_ns) const;
	void passOverImuHole(FrameEstimate& out);
	void runOnWindow(const FeatureFrame& features, FrameEstimate& out);
	bool tryToStart(int64_t t_ns);
	std::optional<StatusChange> findStart(int64_t t_ns, const Pose3& T_WO);
	void track(FrameEstimate& out);
	void push(const FeatureFrame& features, const Interval& interval);
	void judgeWheels(FrameEstimate& out);
	void loseWindow(const std::string& cause, const Belief& belief);
	void carryOnWithoutWindow(FrameEstimate& out);
	bool reckon(FrameEstimate& out);
	void report(FrameEstimate& out);
	void updateStatus(int64_t t_ns);
	void adoptCalibration();
	void slide();
	int64_t emittedStamp(int64_t t_frame_ns);
	int64_t imuNeeded(int64_t t_frame_ns) const;
	int64_t wheelsNeeded(int64_t t_frame_ns) const;
	bool visionDue(int64_t t_ns);
	void forgetSamplesBefore(int64_t t_ns);
};
}  // namespace viwo
