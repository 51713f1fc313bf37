#pragma once

#include "Frame.h"
#include "SampleBuffer.h"

#include <viwo/estimator/EstimatorOptions.h>

namespace viwo
{
struct Belief;
struct Window;

/** Cuts the sample streams at frame times and preintegrates them. All intervals share one linearisation point (biases, wheel intrinsics,
 * offsets of the clocks),
 * so that any two neighbours can be composed; when the estimate has moved away from it, all of them are integrated anew.
 */
class IntervalFactory
{
   public:
	IntervalFactory(const EstimatorOptions& options, const WheelIntrinsics& nominal);

	/** The motion between two frames. `imu` is null where the stream has a hole longer than reinitialize_after_gap_s, `wheels` where it has
	 * one longer than max_wheel_gap_s; shorter ones are bridged. Each hole is counted once, however many intervals it spoils.
	 */
	Interval between(const ImuBuffer& imu, const WheelBuffer& wheels, int64_t t_begin_ns, int64_t t_end_ns);

	/** Moves the linearisation point to the latest frame's estimate where it has drifted from it, with all intervals of the window. */
	void relinearize(Window& window);

	/** Sets the biases of the point without looking at drift (start of a window). */
	void relinearizeAt(Window& window, const Eigen::Vector3d& b_a, const Eigen::Vector3d& b_g);

	/** Cuts all intervals of the window anew where the clocks' offsets have moved too far for a linear correction. To be called while the
	 * samples reach as far as the new offsets ask for: before the next frame, not after the latest. Without them nothing is done.
	 */
	void recut(Window& window, const ImuBuffer& imu, const WheelBuffer& wheels);

	/** Sets the point for intervals to come. */
	void beginAt(const Belief& belief);

	/** By which frames' times are turned into those of the sensors: the estimate's, or up to a threshold from it. */
	const ClockOffsets& offsets() const { return offsets_; }

	/** Holes longer than max_imu_gap_s and max_wheel_gap_s. */
	int imuGaps() const { return imu_gaps_; }
	int wheelGaps() const { return wheel_gaps_; }

   private:
	std::shared_ptr<ImuPreintegration> cutImu(const ImuBuffer& imu, int64_t t_begin_ns, int64_t t_end_ns, double max_gap_s) const;
	std::shared_ptr<WheelPreintegration> cutWheels(const WheelBuffer& wheels, int64_t t_begin_ns, int64_t t_end_ns) const;

	EstimatorOptions options_;
	Eigen::Vector3d b_a_ = Eigen::Vector3d::Zero(), b_g_ = Eigen::Vector3d::Zero();
	WheelIntrinsics wheels_;
	ClockOffsets offsets_;
	bool in_imu_gap_ = false, in_wheel_gap_ = false;
	int imu_gaps_ = 0, wheel_gaps_ = 0;
};
}  // namespace viwo
