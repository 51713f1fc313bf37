#pragma once

#include <mrpt/obs/CObservation.h>
#include <mrpt/system/COutputLogger.h>
#include <mrpt/system/CTimeLogger.h>
#include <viwo/core/Trajectory.h>
#include <viwo/estimator/Estimator.h>
#include <viwo/odometry/OdometryOptions.h>
#include <viwo/odometry/StageTimes.h>

#include <functional>
#include <memory>
#include <vector>

namespace viwo
{
/** Visual-inertial-wheel odometry as an MRPT module: observations in, states out.
 *
 *  @code
 *  viwo::Odometry odometry;                          // defaults: a TurtleBot-class robot, labels CAM, IMU, ODOMETRY
 *  odometry.processObservation(observation);         // in the order of time, as RawlogReader gives them
 *  if (const auto s = odometry.latest(); s.has_pose) use(s.T_WO, s.covariance);
 *  @endcode
 *
 *  Frame W is O at the first pose, z up. Calibration is taken from the first observations of each sensor unless given.
 */
class Odometry : public mrpt::system::COutputLogger
{
   public:
	explicit Odometry(const OdometryOptions& options = {});
	Odometry(const OdometryOptions& options, const Calibration& calibration);
	~Odometry() override;

	/** Takes an image, IMU or odometry observation under its configured label; others, and sensors that the mode does not use, are ignored
	 *  (but images give the times of frames in every mode). Poses that become due are computed at once.
	 *  @throws Error for what cannot be used at all: no calibration, images of two cameras, wrong image size, missing image file (what was
	 *  computed stays).
	 */
	void processObservation(const mrpt::obs::CObservation::Ptr& observation);

	/** No more observations: processes the images that still wait for samples. */
	void finish();

	/** Asked before every frame; once it says true, no more are made (one observation may make many: see OdometryOptions::kLongestBlind_s).
	 */
	void stopWhen(std::function<bool()> asked);

	/** The newest frame's result; has_pose is false before the first. */
	const FrameEstimate& latest() const;

	/** One pose T_WO a frame, each as it was when first estimated. */
	const Trajectory& trajectory() const;
	/** How far the wheels, of nominal size, have rolled since the first pose, whether forwards or backwards. */
	double wheelTravel_m() const;

	std::vector<LandmarkPoint> landmarks() const;
	/** Key frames of the estimator's window, oldest first. */
	std::vector<KeyFrameView> keyFrames() const;
	Status status() const;
	std::vector<StatusChange> statusChanges() const;
	EstimatorCounters counters() const;
	CalibrationEstimate calibrationEstimate() const;
	/** Costs about as much as a frame's covariance. */
	CalibrationDeviations calibrationDeviations() const;
	/** With T_OB as estimated so far where that is switched on. Nothing before the first observation of every sensor that the mode needs.
	 */
	const Calibration* calibration() const;
	const std::map<std::string, RejectionCounts>& observationCounts() const;
	int64_t firstFrame_ns() const;

	/** Called for every frame, with or without a pose. */
	void onFrame(std::function<void(const FrameEstimate&)> callback);
	/** Called for the states between frames, at IMU rate: T_WB carried on from the last frame by the IMU. */
	void onImuRate(std::function<void(const NavState&)> callback);

	mrpt::system::CTimeLogger profiler;
	const StageTimes& stageTimes() const;

   private:
	struct Impl;
	std::unique_ptr<Impl> impl_;
};
}  // namespace viwo
