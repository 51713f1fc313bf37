#include <WorldGauge.h>

#include <viwo/core/So3.h>

#include <CovarianceComparison.h>
#include <NumericJacobian.h>
#include <gtest/gtest.h>

namespace viwo
{
namespace
{
using Matrix6 = Eigen::Matrix<double, 6, 6>;

Matrix6 drawCovariance(test::Random& random, double sigma)
{
	Matrix6 root;
	for (int i = 0; i < 6; ++i) root.col(i) = random.vector(6, sigma);
	return root * root.transpose();
}

/** A start drawn from its covariance, a motion that the window measures exactly: where O ends up. */
TEST(WorldGauge, TurnsEverythingAboutTheStart)
{
	test::Random random(61);
	const Pose3 T_WO_start(so3::expQuaternion({0.02, -0.03, 0.7}), Eigen::Vector3d(3, -2, 0.1));
	const Pose3 T_WO = T_WO_start * Pose3(so3::expQuaternion({-0.01, 0.02, 1.1}), Eigen::Vector3d(5, 2, 0.05));
	const Matrix6 at_start = drawCovariance(random, 0.004);
	WorldGauge gauge;
	gauge.startAt(T_WO_start, at_start);
	const Matrix6 model = gauge.covarianceOf(T_WO, Matrix6::Zero());

	const Matrix6 root = at_start.llt().matrixL();
	test::SampleCovariance<6> drawn;
	for (int i = 0; i < test::monteCarloDraws(20000); ++i)
	{
		const Vector6d error = root * random.vector(6, 1);
		// Only the heading's part of the start's rotation error lasts: roll and pitch are gravity's.
		const double yaw_rad = (T_WO_start.R * Eigen::Vector3d(error.tail<3>())).z();
		const Eigen::Quaterniond turn = so3::expQuaternion({0, 0, yaw_rad});
		const Pose3 moved(turn * T_WO.R, T_WO_start.p + error.head<3>() + turn * (T_WO.p - T_WO_start.p));
		drawn.add(poseMinus(moved, T_WO));
	}
	const double difference = (drawn.value() - model).norm() / model.norm();
	std::cout << "[measured] covariance against draws: " << difference << "\n";
	EXPECT_LT(difference, test::monteCarloBar(0.05));
	EXPECT_GT(model(0, 0), at_start(0, 0));
}

TEST(WorldGauge, NeverTakesAnythingAway)
{
	test::Random random(62);
	for (int i = 0; i < 20; ++i)
	{
		const Pose3 T_start = random.pose(0.1, 3), T = random.pose(0.1, 3);
		const Matrix6 at_start = drawCovariance(random, 0.1), in_window = drawCovariance(random, 0.1);
		WorldGauge gauge;
		EXPECT_EQ(gauge.covarianceOf(T, in_window), in_window) << "the first start is W itself";
		gauge.startAt(T_start, at_start);
		const Matrix6 gained = gauge.covarianceOf(T, in_window) - in_window;
		EXPECT_GT(Eigen::SelfAdjointEigenSolver<Matrix6>(gained).eigenvalues().minCoeff(), -1e-12);
		EXPECT_LT((gauge.covarianceOf(T_start, in_window) - in_window - at_start).topLeftCorner(3, 3).norm(), 1e-12);
	}
}
}  // namespace
}  // namespace viwo
