#pragma once

#include <cstdint>

namespace viwo
{
/** Mean speeds of the two wheels over the interval that ends at t_ns and began at the sample before it.
 *  Speeds are those of nominal radii: the true ones are k_left * v_left_m_s and k_right * v_right_m_s.
 */
struct WheelSample
{
	int64_t t_ns = 0;
	double v_left_m_s = 0;
	double v_right_m_s = 0;
};

/** Scale of each wheel's radius against nominal, and the distance between the wheels (paper Eq. 2: l). */
struct WheelIntrinsics
{
	double k_left = 1;
	double k_right = 1;
	double track_m = 0.23;
};

/** Planar body velocity of O: forward speed (m/s) and yaw rate (rad/s), paper Eq. 2. */
struct WheelTwist
{
	double v_m_s = 0;
	double w_rad_s = 0;
};

inline WheelTwist twistOf(const WheelSample& s, const WheelIntrinsics& k)
{
	const double v_l = k.k_left * s.v_left_m_s;
	const double v_r = k.k_right * s.v_right_m_s;
	return {0.5 * (v_r + v_l), (v_r - v_l) / k.track_m};
}

inline WheelSample wheelSampleFromTwist(int64_t t_ns, const WheelTwist& twist, double track_m)
{
	return {t_ns, twist.v_m_s - 0.5 * track_m * twist.w_rad_s, twist.v_m_s + 0.5 * track_m * twist.w_rad_s};
}

/** Noise of a wheel pair. Each wheel: white speed noise of density sqrt(s0^2 + (k |v|)^2).
 *  The floors make the covariance of a planar motion invertible; they are densities of a random walk over time.
 */
struct WheelNoise
{
	double s0_m_s_sqrtHz = 5e-4;        //!< > 0
	double k_sqrtHz = 0.015;            //!< growth with speed: (m/s)/(m/s)/sqrt(Hz)
	double lateral_m_s_sqrtHz = 2e-3;   //!< side slip
	double vertical_m_s_sqrtHz = 2e-3;  //!< vertical motion over an uneven floor
	double tilt_rad_s_sqrtHz = 5e-3;    //!< roll and pitch rates over an uneven floor
};
}  // namespace viwo
