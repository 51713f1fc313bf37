#pragma once

#include <viwo/core/ImuSample.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

namespace viwo
{
/** Motion of B between two times as the IMU alone gives it, without gravity and initial velocity (Niu et al. Eq. 1). In B's axes at the
 * start. */
struct ImuDelta
{
	Eigen::Vector3d alpha = Eigen::Vector3d::Zero();            //!< m
	Eigen::Vector3d beta = Eigen::Vector3d::Zero();             //!< m/s
	Eigen::Quaterniond gamma = Eigen::Quaterniond::Identity();  //!< R of B at the end in B at the start
};

/** Preintegrated raw specific force and angular rate (Niu et al. Eq. 1, with gravity left to the residual).
 *
 *  Each step between neighbouring samples holds the mean of its two samples constant in B and integrates it in closed form: second order in
 * the step, and exact for a constant turn. Errors are "true minus integrated", with the rotation perturbed on the right.
 *
 *  Noise: one white measurement of variance sigma^2/h a step, i.e. white in continuous time. A sample shared by two steps enters both with
 * half its weight, which sums to the same. At an interval's two ends half a sample's noise belongs to the neighbours: there the model is on
 * the safe side by at most sigma^2 T/4 each (T: sample period), and in return neighbouring intervals add up to the noise of their union.
 *  The bias walks with variance sigma^2 h a step; within a step its mean is half way.
 */
class ImuPreintegration
{
   public:
	using BiasJacobian = Eigen::Matrix<double, 9, 6>;
	using Covariance = Eigen::Matrix<double, 15, 15>;

	ImuPreintegration(const ImuNoise& noise, const Eigen::Vector3d& b_a, const Eigen::Vector3d& b_g);

	/** @param span at least two samples, strictly increasing, the first and the last exactly at the interval's ends (see
	 * ImuBuffer::span()). A second call goes on: its span begins with the last sample of the first.
	 */
	void integrate(const std::vector<ImuSample>& span);

	/** Joins an interval that begins where this one ends, integrated at the same bias: delta, bias Jacobian, covariance and raw samples. */
	void append(const ImuPreintegration& next);

	/** Integrates the raw samples anew at another bias. */
	void repropagate(const Eigen::Vector3d& b_a, const Eigen::Vector3d& b_g);

	/** The delta at another bias, to first order. */
	ImuDelta corrected(const Eigen::Vector3d& b_a, const Eigen::Vector3d& b_g) const;

	double dt_s() const { return dt_s_; }
	const ImuDelta& delta() const { return delta_; }
	/** Rows [alpha, phi, beta] (StateOrder's p, phi, v), columns [b_a, b_g]; gamma(b + d) = gamma(b) Exp(J_phi d). */
	const BiasJacobian& biasJacobian() const { return bias_jacobian_; }
	/** In StateOrder, the biases' random walk and its cross terms included. */
	const Covariance& covariance() const { return covariance_; }
	const Eigen::Vector3d& b_a() const { return b_a_; }
	const Eigen::Vector3d& b_g() const { return b_g_; }
	const std::vector<ImuSample>& samples() const { return samples_; }
	int64_t t_begin_ns() const { return samples_.empty() ? 0 : samples_.front().t_ns; }
	int64_t t_end_ns() const { return samples_.empty() ? 0 : samples_.back().t_ns; }

   private:
	void reset();
	void integrateStep(const ImuSample& from, const ImuSample& to);
	void propagateErrors(double dt_s, const Eigen::Matrix<double, 9, 9>& F, const BiasJacobian& M);

	ImuNoise noise_;
	Eigen::Vector3d b_a_, b_g_;
	double dt_s_ = 0;
	ImuDelta delta_;
	BiasJacobian bias_jacobian_ = BiasJacobian::Zero();
	Covariance covariance_ = Covariance::Zero();
	std::vector<ImuSample> samples_;
};
}  // namespace viwo
