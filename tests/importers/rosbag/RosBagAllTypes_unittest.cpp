#include "AllTypesBag.h"
#include "BagFixture.h"

#include <mrpt/maps/CPointsMap.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationGPS.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <opencv2/imgproc.hpp>

using namespace viwo;
using namespace viwo::testing;

namespace
{
/** Every topic of writeBagOfAllTypes() under a label of its own. */
constexpr char kMap[] =
    "[general]\nground_truth = /vicon\n[IMU]\ntopic = /imu\n[ODOM]\ntopic = /odom\n[TWIST]\ntopic = /vehicle/twist\n[JOINTS]\ntopic = "
    "/joint_states\nleft_joints = fl rl\nright_joints = fr rr\nwheel_radius_m = 0.1\ntrack_m = 0.5\n[CAM]\ntopic = "
    "/cam0/image_raw\ncamera_info = /cam0/camera_info\n[CAM2]\ntopic = /cam1/image_raw/compressed\ncamera_info = "
    "/cam1/camera_info\n[BGR]\ntopic = /bgr/image_raw\n[BAYER]\ntopic = /bayer/image_raw\n[DEEP]\ntopic = /deep/image_raw\n[LASER]\ntopic "
    "= /scan\n[GPS]\ntopic = /fix\n[POINTS]\ntopic = /points\n";

std::vector<int64_t> stampsOf(const std::string& rawlog, const std::string& label)
{
	std::vector<int64_t> stamps;
	for (const auto& observation : observationsOf<mrpt::obs::CObservation>(rawlog, label)) stamps.push_back(stampOf(*observation));
	return stamps;
}

std::vector<int64_t> every(int64_t period_ms, int64_t phase_ms, int count)
{
	std::vector<int64_t> stamps;
	for (int i = 0; i < count; ++i) stamps.push_back(at_ns(period_ms * i + phase_ms));
	return stamps;
}

cv::Mat pictureOf(const mrpt::obs::CObservationImage& observation)
{
	return cv::imread(observation.image.getExternalStorageFileAbsolutePath(), cv::IMREAD_UNCHANGED);
}

/** The picture that was sent, without the bytes that pad its rows. */
cv::Mat sent(const std::string& encoding, int n, int type)
{
	auto message = imageMessage(0, "", encoding, n, static_cast<uint32_t>(CV_ELEM_SIZE(type)));
	return cv::Mat(12, 16, type, message.data.data(), message.step).clone();
}

void expectSamePicture(const mrpt::obs::CObservationImage& observation, const cv::Mat& expected, const std::string& what)
{
	const cv::Mat picture = pictureOf(observation);
	ASSERT_EQ(picture.type(), expected.type()) << what;
	EXPECT_EQ(cv::norm(picture, expected, cv::NORM_INF), 0) << what;
}
}  // namespace

// One bag with every type and encoding, two cameras with a lens each, streams out of order: each message comes back once, in order, equal.
TEST_F(RosBag, EveryTypeInOneBag)
{
	for (const auto compression : {rosbag::compression::Uncompressed, rosbag::compression::LZ4, rosbag::compression::BZ2})
	{
		writeBagOfAllTypes(path("x.bag"), compression);
		const ImportResult result = import(writeMap(kMap));
		EXPECT_EQ(result.imu_samples, 100u);
		EXPECT_EQ(result.odometry_samples, 40u + 20 + 19);
		EXPECT_EQ(result.images, 50u);
		EXPECT_EQ(result.scans, 10u);
		EXPECT_EQ(result.gps_fixes, 10u);
		EXPECT_EQ(result.point_clouds, 10u);
		EXPECT_EQ(result.ground_truth_poses, 10u);

		const std::string rawlog = path("x.rawlog");
		EXPECT_EQ(stampsOf(rawlog, "IMU"), every(20, 0, 100));
		EXPECT_EQ(stampsOf(rawlog, "ODOM"), every(50, 0, 40));
		EXPECT_EQ(stampsOf(rawlog, "TWIST"), every(100, 11, 20));
		EXPECT_EQ(stampsOf(rawlog, "JOINTS"), every(100, 100, 19));
		EXPECT_EQ(stampsOf(rawlog, "CAM"), every(200, 0, 10));
		EXPECT_EQ(stampsOf(rawlog, "CAM2"), every(200, 1, 10));
		EXPECT_EQ(stampsOf(rawlog, "BGR"), every(200, 2, 10));
		EXPECT_EQ(stampsOf(rawlog, "BAYER"), every(200, 3, 10));
		EXPECT_EQ(stampsOf(rawlog, "DEEP"), every(200, 4, 10));
		EXPECT_EQ(stampsOf(rawlog, "LASER"), every(200, 5, 10));
		EXPECT_EQ(stampsOf(rawlog, "GPS"), every(200, 7, 10));
		EXPECT_EQ(stampsOf(rawlog, "POINTS"), every(200, 9, 10));
	}
}

TEST_F(RosBag, EveryTypeHasItsContent)
{
	writeBagOfAllTypes(path("x.bag"));
	import(writeMap(kMap));
	const std::string rawlog = path("x.rawlog");
	const auto twists = observationsOf<mrpt::obs::CObservationOdometry>(rawlog, "TWIST");
	const auto joints = observationsOf<mrpt::obs::CObservationOdometry>(rawlog, "JOINTS");
	const auto clouds = observationsOf<mrpt::obs::CObservationPointCloud>(rawlog, "POINTS");
	const auto bgr = observationsOf<mrpt::obs::CObservationImage>(rawlog, "BGR");
	const auto bayer = observationsOf<mrpt::obs::CObservationImage>(rawlog, "BAYER");
	const auto deep = observationsOf<mrpt::obs::CObservationImage>(rawlog, "DEEP");
	for (size_t i = 0; i < twists.size(); ++i)
	{
		EXPECT_EQ(twists[i]->velocityLocal.vx, 0.01 * static_cast<double>(i));
		EXPECT_EQ(twists[i]->velocityLocal.omega, -0.02 * static_cast<double>(i));
	}
	// Left 3, right 7 rad/s with r = 0.1 m and l = 0.5 m.
	for (const auto& joint : joints)
	{
		EXPECT_NEAR(joint->velocityLocal.vx, 0.5, 1e-9);
		EXPECT_NEAR(joint->velocityLocal.omega, 0.8, 1e-9);
	}
	for (int n = 0; n < 10; ++n)
	{
		const auto i = static_cast<size_t>(n);
		expectSamePose(clouds[i]->sensorPose, kT_OL, "POINTS");
		ASSERT_EQ(clouds[i]->pointcloud->size(), 3u);
		float x = 0, y = 0, z = 0;
		clouds[i]->pointcloud->getPoint(1, x, y, z);
		EXPECT_EQ(Eigen::Vector3f(x, y, z), Eigen::Vector3f(3, static_cast<float>(n), 4));
		expectSamePose(bgr[i]->cameraPose, kT_OC, "BGR");
		expectSamePicture(*bgr[i], sent("bgr8", n, CV_8UC3), "BGR " + std::to_string(n));
		cv::Mat colours;
		// OpenCV's name of the pattern that ROS calls grbg.
		cv::cvtColor(sent("bayer_grbg8", n, CV_8UC1), colours, cv::COLOR_BayerGB2BGR);
		expectSamePicture(*bayer[i], colours, "BAYER " + std::to_string(n));
		cv::Mat grey;
		sent("mono16", n, CV_16UC1).convertTo(grey, CV_8U, 1.0 / 256);
		expectSamePicture(*deep[i], grey, "DEEP " + std::to_string(n));
	}
}
