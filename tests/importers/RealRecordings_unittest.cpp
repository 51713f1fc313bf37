#include "RawlogContent.h"
#include "TempFolder.h"

#include <viwo/core/MrptPose.h>
#include <viwo/core/Time.h>
#include <viwo/core/Trajectory.h>
#include <viwo/importers/EurocImporter.h>
#include <viwo/importers/KittiImporter.h>
#include <viwo/importers/RosBagImporter.h>
#include <viwo/rawlog/MrptTime.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <iostream>

using namespace viwo;
using namespace viwo::testing;

namespace
{
/** Empty when the real data are not here. */
std::string dataFolder(const std::string& name)
{
	const char* root = std::getenv("VIWO_TEST_DATA");
	return root == nullptr ? std::string() : std::string(root) + "/" + name;
}

/** ATE in x-y after a rotation about z and a shift, in closed form. */
double planarAte_m(const std::vector<Eigen::Vector2d>& ref, const std::vector<Eigen::Vector2d>& est)
{
	Eigen::Vector2d mean_ref = Eigen::Vector2d::Zero(), mean_est = Eigen::Vector2d::Zero();
	const double n = static_cast<double>(ref.size());
	for (size_t i = 0; i < ref.size(); ++i) mean_ref += ref[i] / n, mean_est += est[i] / n;
	double dot = 0, cross = 0, squares = 0;
	for (size_t i = 0; i < ref.size(); ++i)
	{
		const Eigen::Vector2d r = ref[i] - mean_ref, e = est[i] - mean_est;
		dot += e.dot(r), cross += e.x() * r.y() - e.y() * r.x(), squares += e.squaredNorm() + r.squaredNorm();
	}
	return std::sqrt(std::max(0.0, squares - 2 * std::hypot(dot, cross)) / n);
}
}  // namespace

TEST(RealRecordings, EurocMicro)
{
	const std::string source = dataFolder("euroc_micro");
	if (source.empty()) GTEST_SKIP() << "VIWO_TEST_DATA is not set";
	const TempFolder folder;
	const ImportResult result = importEuroc({source, folder.file("x.rawlog")});
	EXPECT_EQ(result.images, 40u);
	EXPECT_EQ(result.imu_samples, 29120u);
	EXPECT_EQ(result.odometry_samples, 0u);
	EXPECT_EQ(result.ground_truth_poses, 2895u);
	EXPECT_NEAR(result.duration_s, 145.595, 0.01);

	const RawlogContent content(folder.file("x.rawlog"));
	EXPECT_EQ(content.imu.size(), 29120u);
	EXPECT_EQ(content.images.size(), 40u);
	double norm = 0;
	for (int i = 0; i < 400; ++i)
		norm += Eigen::Vector3d(content.imu[i]->get(mrpt::obs::IMU_X_ACC), content.imu[i]->get(mrpt::obs::IMU_Y_ACC),
		                        content.imu[i]->get(mrpt::obs::IMU_Z_ACC))
		            .norm() /
		        400;
	std::cout << "[measured] mean specific force while the vehicle stands: " << norm << " m/s^2\n";
	EXPECT_NEAR(norm, 9.81, 0.15);
}

// Truth, odometry and IMU of KITTI must tell of one and the same drive.
TEST(RealRecordings, KittiSnippet)
{
	const std::string source = dataFolder("kitti_snippet");
	if (source.empty()) GTEST_SKIP() << "VIWO_TEST_DATA is not set";
	const TempFolder folder;
	const ImportResult result = importKitti({source, folder.file("x.rawlog")}, {});
	EXPECT_EQ(result.images, 219u);
	EXPECT_EQ(result.imu_samples, 379u);
	EXPECT_EQ(result.odometry_samples, 379u);
	EXPECT_NEAR(result.duration_s, 22.7, 0.7);

	const Trajectory truth = Trajectory::loadTum(result.ground_truth_path);
	const RawlogContent content(folder.file("x.rawlog"));
	ASSERT_EQ(truth.size(), content.odometry.size());
	double gyro_yaw = 0, yaw_rate_square = 0, path = 0;
	std::vector<Eigen::Vector2d> ref, est;
	for (size_t i = 0; i < truth.size(); ++i)
	{
		ref.emplace_back(truth.poses()[i].T.p.head<2>());
		est.emplace_back(content.odometry[i]->odometry.x(), content.odometry[i]->odometry.y());
		if (i == 0) continue;
		const double dt_s = secondsBetween(truth.poses()[i - 1].t_ns, truth.poses()[i].t_ns);
		const double w = 0.5 * (content.imu[i - 1]->get(mrpt::obs::IMU_WZ) + content.imu[i]->get(mrpt::obs::IMU_WZ));
		const double dyaw = std::remainder(yawOf(truth.poses()[i].T.R) - yawOf(truth.poses()[i - 1].T.R), 2 * M_PI);
		gyro_yaw += w * dt_s;
		yaw_rate_square += std::pow(dyaw / dt_s - w, 2) / static_cast<double>(truth.size() - 1);
		path += 0.5 * (content.odometry[i - 1]->velocityLocal.vx + content.odometry[i]->velocityLocal.vx) * dt_s;
	}
	const double truth_yaw = std::remainder(yawOf(truth.poses().back().T.R) - yawOf(truth.poses().front().T.R), 2 * M_PI);
	const double ate_m = planarAte_m(ref, est);
	std::cout << "[measured] length " << truth.length_m() << " m by truth, " << path << " m by speed; turn " << truth_yaw
	          << " rad by truth, " << gyro_yaw << " by gyro; yaw rate of truth against gyro " << std::sqrt(yaw_rate_square)
	          << " rad/s rms; ATE of integrated odometry " << ate_m << " m\n";
	EXPECT_NEAR(path / truth.length_m(), 1, 0.01);
	EXPECT_NEAR(std::remainder(truth_yaw - gyro_yaw, 2 * M_PI), 0, 0.05);
	EXPECT_LT(std::sqrt(yaw_rate_square), 0.02);
	EXPECT_LT(ate_m, 0.01 * truth.length_m());
}

// Its IMU lies on its side, and the bag has no tf: robot_localization, whose test data this is, publishes it as turned by yaw -90, roll 90
// degrees.
TEST(RealRecordings, Husky)
{
	const std::string source = dataFolder("husky/test1.bag");
	if (source.empty()) GTEST_SKIP() << "VIWO_TEST_DATA is not set";
	if (!hasRosBagSupport()) GTEST_SKIP() << "built without ROS bags";
	const TempFolder folder;
	const ImportResult result = importRosBags({"", folder.file("x.rawlog")}, {{source}, {}, false});
	EXPECT_EQ(result.imu_samples, 11865u);
	EXPECT_EQ(result.odometry_samples, 3952u);
	EXPECT_EQ(result.gps_fixes, 989u);
	EXPECT_NE(result.mapping.find("yaw_pitch_roll_deg = -90 0 90"), std::string::npos) << result.mapping;

	const RawlogContent content(folder.file("x.rawlog"));
	ASSERT_EQ(content.imu.size(), 11865u);
	ASSERT_EQ(content.odometry.size(), 3952u);
	Eigen::Vector3d force_O = Eigen::Vector3d::Zero();
	std::vector<StampedPose> poses;
	size_t next = 0;
	Pose3 T_WO;
	for (size_t i = 1; i < content.imu.size(); ++i)
	{
		const auto& imu = *content.imu[i];
		const Pose3 T_OB = fromMrpt(imu.sensorPose);
		const auto vector = [&imu](auto x, auto y, auto z) { return Eigen::Vector3d(imu.get(x), imu.get(y), imu.get(z)); };
		force_O += T_OB.R * vector(mrpt::obs::IMU_X_ACC, mrpt::obs::IMU_Y_ACC, mrpt::obs::IMU_Z_ACC) / 11864;
		const double w_rad_s = (T_OB.R * vector(mrpt::obs::IMU_WX, mrpt::obs::IMU_WY, mrpt::obs::IMU_WZ)).z();
		const int64_t t_ns = nanosecondsOf(imu.timestamp);
		const double dt_s = secondsBetween(nanosecondsOf(content.imu[i - 1]->timestamp), t_ns);
		while (next + 1 < content.odometry.size() && nanosecondsOf(content.odometry[next]->timestamp) < t_ns) ++next;
		const double v_m_s = content.odometry[next]->velocityLocal.vx;
		T_WO = T_WO * Pose3(Eigen::Quaterniond(Eigen::AngleAxisd(w_rad_s * dt_s, Eigen::Vector3d::UnitZ())), {v_m_s * dt_s, 0, 0});
		poses.push_back({t_ns, T_WO});
	}
	const Trajectory gps = Trajectory::loadTum(result.gps_path);
	EXPECT_EQ(gps.size(), 989u);
	std::vector<Eigen::Vector2d> ref, est;
	size_t at = 0;
	for (const StampedPose& fix : gps.poses())
	{
		while (at + 1 < poses.size() && poses[at].t_ns < fix.t_ns) ++at;
		ref.emplace_back(fix.T.p.head<2>());
		est.emplace_back(poses[at].T.p.head<2>());
	}
	const double ate_m = planarAte_m(ref, est);
	std::cout << "[measured] mean specific force in O " << force_O.transpose() << " m/s^2; wheels with gyro against GPS: ATE " << ate_m
	          << " m\n";
	EXPECT_NEAR(force_O.z(), 9.8, 0.1);
	EXPECT_LT(force_O.head<2>().norm(), 0.3);
	EXPECT_LT(ate_m, 3.5);
}
