#pragma once

#include <viwo/core/Pose3.h>
#include <viwo/core/WheelSample.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

namespace viwo
{
/** A stretch of time over which both wheels are taken to turn at constant speed. Speeds are those of nominal radii. */
struct WheelSegment
{
	double dt_s = 0;
	double v_left_m_s = 0;
	double v_right_m_s = 0;
	double variance_scale = 1;  //!< on all noise of this stretch: above 1 where the wheels slip
};

/** Motion of O between two times as the wheels give it (Niu et al. Eq. 2-8), in O's axes at the start; the lever arm is left to the
 * residual.
 *
 *  A segment is an exact arc. Noise (Niu et al. Eq. 2): each wheel has one white speed error of variance (s0^2 + (k |v|)^2)/dt a segment,
 * i.e. white in continuous time: the two pieces of a sample that is split at an image time together carry the noise of the whole. Side
 * slip, vertical motion, roll and pitch rates are white errors in O's axes of the moment (WheelNoise's floors), which make the covariance
 * invertible. Errors are [dp, dphi], the rotation perturbed on the right: the order and the tangent of a pose.
 */
class WheelPreintegration
{
   public:
	using Covariance = Eigen::Matrix<double, 6, 6>;
	using IntrinsicsJacobian = Eigen::Matrix<double, 6, 3>;

	/** @param at the intrinsics at which it integrates and linearises. */
	WheelPreintegration(const WheelNoise& noise, const WheelIntrinsics& at);

	/** Appends one segment; one with dt_s <= 0 is ignored. */
	void integrate(const WheelSegment& segment);

	/** Joins an interval that begins where this one ends, integrated at the same intrinsics. */
	void append(const WheelPreintegration& next);

	/** Integrates the raw segments anew at other intrinsics. */
	void repropagate(const WheelIntrinsics& at);

	/** Trusts the interval less (factor > 1) or more; holds through append() and repropagate(). */
	void scaleCovariance(double factor);

	/** Trusts no stretch more than this: lower variance scales are raised to it, others stay. @return whether any was lower. */
	bool raiseVarianceScale(double least);

	/** One for each segment. */
	void setVarianceScales(const std::vector<double>& scales);

	double dt_s() const { return dt_s_; }
	/** Length of O's path, sum of |v| dt at intrinsics(). */
	double distance_m() const { return distance_m_; }
	const Eigen::Vector3d& dp() const { return delta_.p; }  //!< m
	const Eigen::Quaterniond& dR() const { return delta_.R; }
	const Covariance& covariance() const { return covariance_; }
	/** Of [dp, dphi] with respect to (k_left, k_right, track_m). */
	const IntrinsicsJacobian& intrinsicsJacobian() const { return intrinsics_jacobian_; }
	const WheelIntrinsics& intrinsics() const { return intrinsics_; }
	const std::vector<WheelSegment>& segments() const { return segments_; }

	/** (dR, dp) at other intrinsics, to first order. */
	Pose3 corrected(const WheelIntrinsics& k) const;

   private:
	void reset();
	void integrateStep(const WheelSegment& segment);
	Covariance twistNoise(const WheelSegment& segment) const;
	IntrinsicsJacobian twistJacobian(const WheelSegment& segment) const;

	WheelNoise noise_;
	WheelIntrinsics intrinsics_;
	double dt_s_ = 0, distance_m_ = 0;
	Pose3 delta_;
	Covariance covariance_ = Covariance::Zero();
	IntrinsicsJacobian intrinsics_jacobian_ = IntrinsicsJacobian::Zero();
	std::vector<WheelSegment> segments_;
};
}  // namespace viwo
