#pragma once

#include <viwo/core/Options.h>

namespace viwo
{
/** Gyroscope bias from vision and wheels: both at once with their information, or the plain mean of the two estimates (Niu et al.
 * Sec. 5.2). */
enum class GyroBiasMethod
{
	weighted,
	paper_mean
};

/** Where the search for the vertical starts. */
enum class GravityStart
{
	specific_force,  //!< the mean of the window's: any mounting, any slope
	vehicle_up       //!< z of O: level ground
};

/** Alignment of the vision-only reconstruction with IMU and wheels; whether those take part is FactorOptions::wheels_in_initialization. */
struct InitializerOptions : Options<InitializerOptions>
{
	GyroBiasMethod gyro_bias = GyroBiasMethod::weighted;
	GravityStart gravity_start = GravityStart::specific_force;

	double max_gyro_bias_rad_s = 0.1;
	double max_chi2_per_dof = 6;
	double max_scale_sigma = 0.1;
	double max_scale_sigma_without_wheels = 0.3;

	template <class Visitor>
	void visit(Visitor& v)
	{
		v.choice("gyro_bias", gyro_bias, "both by their information, or the plain mean of vision's and the wheels' estimates",
		         {"weighted", "paper_mean"});
		v.choice("gravity_start", gravity_start,
		         "the vertical at the start: mean specific force (any mounting) or the vehicle's z axis (level ground)",
		         {"specific_force", "vehicle_up"});
		v("max_gyro_bias_rad_s", max_gyro_bias_rad_s, "a larger gyroscope bias is not believed, rad/s", 0.0, 10.0);
		v("max_chi2_per_dof", max_chi2_per_dof, "misfit of an alignment, at most", 0.1, 1e6);
		v("max_scale_sigma", max_scale_sigma, "relative standard deviation of the scale, at most", 1e-4, 10.0);
		v("max_scale_sigma_without_wheels", max_scale_sigma_without_wheels, "the same for vision and IMU alone", 1e-4, 10.0);
	}
};
}  // namespace viwo
