#pragma once

#include <viwo/core/Pose3.h>
#include <viwo/core/Time.h>
#include <viwo/core/Trajectory.h>
#include <viwo/sim/Disturbances.h>
#include <viwo/sim/Route.h>

#include <cstdint>
#include <memory>

namespace viwo::sim
{
/** Exact state of O at one time. W is the simulated world: z up, the floor's mean at z = 0. */
struct MotionState
{
	Pose3 T_WO;
	Eigen::Vector3d v_WO = Eigen::Vector3d::Zero();     //!< velocity of O in W's axes, m/s
	Eigen::Vector3d a_WO = Eigen::Vector3d::Zero();     //!< acceleration of O in W's axes, m/s^2
	Eigen::Vector3d w_O = Eigen::Vector3d::Zero();      //!< angular rate of O against W, in O's axes, rad/s
	Eigen::Vector3d alpha_O = Eigen::Vector3d::Zero();  //!< its time derivative, rad/s^2
};

/** True ground speed of the two wheels, m/s. */
struct WheelSpeeds
{
	double left_m_s = 0, right_m_s = 0;
};

class PlanarPath;

/** The true motion of the robot, a pure function of time: a route driven with twice continuously differentiable speeds, over an uneven
 * floor, with body vibration. Velocities, accelerations and rates are exact derivatives of the pose, by the chain rule. The robot stands
 * tangentially on the floor and rolls along its own x axis; vibration comes on top of that and turns no wheel.
 */
class Motion
{
   public:
	/** @param epoch_ns stamp of t = 0. @throws Error for a route that cannot be driven. */
	explicit Motion(const Route& route, const FloorOptions& floor = FloorOptions::flat(),
	                const VibrationOptions& vibration = VibrationOptions::off(), uint64_t seed = 1, int64_t epoch_ns = kDefaultEpoch_ns);
	~Motion();
	Motion(Motion&&) noexcept;

	static constexpr int64_t kDefaultEpoch_ns = 1'700'000'000'000'000'000;

	/** t_s in [0, duration_s()]; clamped to it. */
	MotionState at(double t_s) const;
	MotionState at_ns(int64_t t_ns) const { return at(secondsBetween(epoch_ns_, t_ns)); }

	/** Ground speeds of wheels that stand `track_m` apart, vibration left out. */
	WheelSpeeds wheelSpeeds(double t_s, double track_m) const;

	double duration_s() const;
	int64_t epoch_ns() const { return epoch_ns_; }
	int64_t stamp_ns(double t_s) const { return epoch_ns_ + nanoseconds(t_s); }

	/** T_WO at rate_hz from 0 to the end. */
	Trajectory groundTruth(double rate_hz = 200) const;

   private:
	std::unique_ptr<const PlanarPath> path_;
	Floor floor_;
	Vibration vibration_;
	int64_t epoch_ns_;
};
}  // namespace viwo::sim
