#pragma once

#include <SimulatedDrive.h>

#include <viwo/core/So3.h>

#include <Eigen/Cholesky>
#include <utility>

namespace viwo::test
{
/** Normalised squared error of position and yaw per degree of freedom, relative to the first pose. */
inline double normalisedError(const Pose3& T_first_true, const Pose3& T_true, const FrameEstimate& e, const Pose3& T_first)
{
	const Pose3 expected = T_first * (T_first_true.inverse() * T_true);
	Eigen::Vector4d error;
	error << e.T_WO.p - expected.p, so3::log(expected.R.conjugate() * e.T_WO.R).z();
	const int rows[] = {0, 1, 2, 5};
	Eigen::Matrix4d covariance;
	for (int r = 0; r < 4; ++r)
		for (int c = 0; c < 4; ++c) covariance(r, c) = e.covariance(rows[r], rows[c]);
	return error.dot(covariance.ldlt().solve(error)) / 4;
}

/** Sum and number of the normalised errors from so many seconds after the first pose on. */
inline std::pair<double, int> normalisedErrors(const Drive& drive, const DriveResult& result, double after_s)
{
	const FrameEstimate* first = nullptr;
	double sum = 0;
	int count = 0;
	for (const FrameEstimate& e : result.estimates)
	{
		if (!e.has_pose) continue;
		if (!first) first = &e;
		if (secondsBetween(first->t_ns, e.t_ns) < after_s) continue;
		sum += normalisedError(drive.motion.at_ns(first->t_ns).T_WO, drive.motion.at_ns(e.t_ns).T_WO, e, first->T_WO);
		++count;
	}
	return {sum, count};
}

/** Wheel errors as wide as the estimator's priors take them to be. */
inline void drawWheels(DriveSetup& setup)
{
	setup.wheels.radius_error = setup.wheels.left_right_difference = setup.wheels.track_error = 0;
	setup.wheels.radius_deviation = 0.007;
	setup.wheels.left_right_deviation = 0.014;
	setup.wheels.track_deviation = 0.01;
}
}  // namespace viwo::test
