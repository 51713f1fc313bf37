#include <viwo/core/So3.h>

#include <SimulatedDrive.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>

namespace viwo
{
namespace
{
using test::Drive;
using test::DriveSetup;
using test::measured;
using test::optionsOf;

using Vector4 = Eigen::Matrix<double, 4, 1>;
using Matrix4 = Eigen::Matrix<double, 4, 4>;

/** Normalised squared error of position and yaw per degree of freedom, relative to the first pose. */
double normalisedError(const Pose3& T_first_true, const Pose3& T_true, const FrameEstimate& e, const Pose3& T_first)
{
	const Pose3 expected = T_first * (T_first_true.inverse() * T_true);
	Vector4 error;
	error << e.T_WO.p - expected.p, so3::log(expected.R.conjugate() * e.T_WO.R).z();
	const int rows[] = {0, 1, 2, 5};
	Matrix4 covariance;
	for (int r = 0; r < 4; ++r)
		for (int c = 0; c < 4; ++c) covariance(r, c) = e.covariance(rows[r], rows[c]);
	return error.dot(covariance.ldlt().solve(error)) / 4;
}

TEST(EstimatorConsistency, CovarianceTellsTheErrors)
{
	for (const Mode mode : {Mode::wio, Mode::viwo})
	{
		double sum = 0;
		int count = 0;
		const int runs = test::seedsOf(10);
		for (int seed = 1; seed <= runs; ++seed)
		{
			DriveSetup setup(seed % 2 ? "straight 1 m, rotate 90 deg" : "arc 0.8 m 90 deg", seed);
			setup.wheels.radius_error = setup.wheels.left_right_difference = setup.wheels.track_error = 0;
			setup.wheels.radius_deviation = 0.007;
			setup.wheels.left_right_deviation = 0.014;
			setup.wheels.track_deviation = 0.01;
			const Drive drive(setup);
			const test::DriveResult result = runDrive(drive, optionsOf(mode));
			const FrameEstimate* first = nullptr;
			double of_run = 0;
			int of_run_count = 0;
			for (const FrameEstimate& e : result.estimates)
			{
				if (!e.has_pose) continue;
				if (!first) first = &e;
				if (secondsBetween(first->t_ns, e.t_ns) < 2) continue;
				of_run += normalisedError(drive.motion.at_ns(first->t_ns).T_WO, drive.motion.at_ns(e.t_ns).T_WO, e, first->T_WO);
				++of_run_count;
			}
			sum += of_run;
			count += of_run_count;
		}
		measured("ANEES of position and yaw per degree of freedom, " + std::to_string(runs) + " runs, mode " +
		             modeNames()[static_cast<size_t>(mode)],
		         sum / count, "");
		EXPECT_GT(sum / count, 0.3);
		EXPECT_LT(sum / count, 3);
	}
}
}  // namespace
}  // namespace viwo
