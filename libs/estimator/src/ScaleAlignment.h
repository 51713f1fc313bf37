#pragma once

#include <viwo/core/Calibration.h>
#include <viwo/estimator/InitializerOptions.h>
#include <viwo/sfm/StructureFromMotion.h>

#include <Eigen/Core>
#include <vector>

#include "Belief.h"
#include "ImuPreintegration.h"
#include "WheelPreintegration.h"

namespace viwo
{
enum class ScaleStatus
{
	ok,
	ill_conditioned,  //!< the data leave the scale or a velocity open
	bad_gravity,      //!< the specific force does not look like gravity
	negative_scale,
	bad_residual
};

struct ScaleResult
{
	ScaleStatus status = ScaleStatus::ill_conditioned;
	double scale = 0;                                 //!< metres per unit of the reconstruction
	double scale_sigma = 0;                           //!< relative
	Eigen::Vector3d up_c0 = Eigen::Vector3d::Zero();  //!< unit, the vertical in the first camera frame
	double up_sigma_rad = 0;                          //!< larger of the two tilts'
	std::vector<Eigen::Vector3d> v_B;                 //!< velocity of B at each frame, in its own axes, m/s
	/** Of [v_0 ... v_n, s] and the two tilts of up_c0. */
	Eigen::MatrixXd covariance;
	/** The reconstruction's poses, its units, corrected within their covariance to fit IMU and wheels. */
	std::vector<Pose3> T_c0_ck;
	double chi2_per_dof = 0;
	double condition = 0;  //!< of the whitened system with columns of unit norm
};

/** Scale, velocities and the vertical (Niu et al. Eq. 11-13; without wheels VINS-Mono, Qin et al. 2018, Sec. V-B).
 *
 *  Per interval, in the axes of b_k, with R_bkc0 = R_BC Rbar_c0ck^T and g_c0 the up vector times |g|:
 *
 *      s R_bkc0 (pbar_c0ck+1 - pbar_c0ck) - R_bkbk+1 p_BC + p_BC = alpha_k + v_k dt - 1/2 R_bkc0 g_c0 dt^2
 *      R_bkbk+1 v_k+1 - v_k                                      = beta_k - R_bkc0 g_c0 dt
 *      s R_bkc0 (pbar_c0ck+1 - pbar_c0ck)                        = R_BO dp_k + (p_BO - p_BC) - R_bkbk+1 (p_BO - p_BC)
 *
 *  Weighted by the joint covariance of everything in them: vision's intervals, IMU, wheels, and what is constant over the window and
 * unknown (accelerometer bias, wheel radii and track). Vision's steps multiply the unknown scale; plain least squares would take their
 * noise for signal and find the scale too small, so they are corrected along with the solution (Gauss-Helmert model).
 *
 *  The vertical starts as the options say, or without wheels as three free unknowns,
 * and is refined on its tangent plane with |g| fixed.
 *
 *  @param imu propagated at the window's gyroscope bias. @param wheels as many as imu, or none.
 */
ScaleResult alignScale(const SfmResult& sfm, const std::vector<ImuPreintegration>& imu, const std::vector<WheelPreintegration>& wheels,
                       const Calibration& calibration, const Belief& belief, double gravity_m_s2, const InitializerOptions& options);
}  // namespace viwo
