#pragma once

#include "TimeShift.h"
#include "WheelPreintegration.h"
#include "residuals/LocalCost.h"

#include <viwo/core/Pose3.h>

#include <Eigen/Core>
#include <vector>

namespace viwo
{
/** Two frames and the wheels' travel between them (Niu et al. Eq. 19, with all terms in O). R_WO = R_WB R_BO, p_WO = p_WB + R_WB p_BO:
 *
 *      r_p   = R_WOi^T (p_WOj - p_WOi) - dp(k),   r_phi = Log(dR(k)^T R_WOi^T R_WOj)
 *
 *  with, to first order in the change d of the intrinsics since the preintegration, dp + J_p d and dR Exp(theta), theta = J_phi d.
 *  The lever arm is here only and not in the preintegration.
 *
 *  The encoders' noise is in what they measure, so it grows with the size that the wheels are given: were it weighed as if it did not,
 * small wheels would explain any motion best, and each interval would pull them a little that way. So the rows that are the encoders'
 * alone, forward and yaw, count in units of the measurement: they are divided by k / k_0 and by (k / k_0) (track_0 / track), with k the
 * mean of k_left and k_right and 0 for what the covariance was propagated with.
 *
 *  Where the wheels' place and the clocks are estimated too, T_BO is a state, and the interval's shift adds to the correction:
 *  S (t_d - t_w - shift_0), since frames are at t_CAM + t_d - t_w in the wheels' clock (t_IMU = t_CAM + t_d = t_WHEEL + t_w). Then
 *
 *      dr_p = [R_BO^T (p_BiOj - p_BO)]_x dphi + R_BO^T (R_BiBj - I) dp,   dr_phi = J_r^-1(r_phi) (I - R_OiOj^T) dphi
 *
 *  for a change (dp, dphi) of T_BO, with p_BiOj the place of O_j in B_i.
 *
 *  Blocks: pose T_WB_i, pose T_WB_j, wheel intrinsics (k_left, k_right, track in m); with a shift also pose T_BO, t_d (s), t_w (s). Six
 *  residuals.
 */
class WheelResidual : public LocalCost
{
   public:
	using Whitening = Eigen::Matrix<double, 6, 6>;

	/** Copies what it needs.
	 *  @param covariance_inflation factor on the covariance, > 1 when the wheels are thought to have slipped. */
	WheelResidual(const WheelPreintegration& preintegration, const Pose3& T_BO, double covariance_inflation = 1);
	/** With the blocks of T_BO and of both offsets. @param shift at t_d - t_w. */
	WheelResidual(const WheelPreintegration& preintegration, const WheelTimeShift& shift);

	bool evaluateLocal(double const* const* x, double* residuals, double** jacobians) const override;

	/** The lower triangular factor that is applied to the rows [r_p, r_phi] where the intrinsics are those of the preintegration. */
	const Whitening& whiteningFactor() const { return whiten_; }

   private:
	WheelResidual(const WheelPreintegration& preintegration, const Pose3& T_BO, double covariance_inflation, std::vector<BlockShape> shapes,
	              const WheelTimeShift& shift);
	using IntrinsicsGradient = Eigen::Matrix<double, 1, 3>;
	/** Into units of the measurement, and how that depends on the intrinsics. */
	struct Units
	{
		Eigen::Matrix<double, 6, 1> factor;
		IntrinsicsGradient d_forward, d_yaw;
	};
	Units units(const Eigen::Vector3d& intrinsics) const;
	/** What residual and Jacobians share. */
	struct Terms
	{
		Units units;
		Eigen::Matrix<double, 6, 1> r;  //!< in metres and radians
		Whitening whiten;               //!< with the units in it
		Pose3 T_i, T_j, T_BO;
		Eigen::Quaterniond R_WOi, R_WOj;
		Eigen::Vector3d p_BiOj, lever;  //!< lever: of O_j from O_i, in O_i
		Eigen::Vector3d theta, r_phi;   //!< theta: correction of dR
	};
	Terms evaluate(double const* const* x, double* residuals) const;
	void calibrationJacobians(const Terms& t, const Eigen::Matrix3d& J_phi, const Eigen::Matrix3d& J_dR, double** jacobians) const;

	Eigen::Vector3d dp_;
	Eigen::Quaterniond dR_;
	WheelPreintegration::IntrinsicsJacobian intrinsics_jacobian_;
	Eigen::Vector3d intrinsics_;
	Pose3 T_BO_;
	WheelTimeShift shift_;
	Whitening whiten_;
};
}  // namespace viwo
