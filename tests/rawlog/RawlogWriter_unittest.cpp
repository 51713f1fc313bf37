#include <viwo/core/MrptPose.h>
#include <viwo/core/So3.h>

#include "ExpectError.h"
#include "RawlogFixture.h"

using namespace viwo;
using namespace viwo::testing;
using namespace mrpt::obs;
namespace fs = std::filesystem;

namespace
{
class RawlogWriterTest : public RawlogTest
{
   protected:
	template <class Observation>
	typename Observation::Ptr throughFile(const Observation& observation)
	{
		RawlogWriter writer(path);
		writer.write(observation);
		writer.close();
		const auto all = readAll(path);
		EXPECT_EQ(all.size(), 1u);
		return std::dynamic_pointer_cast<Observation>(all.at(0));
	}

	const Pose3 T_Ox{so3::expQuaternion({0.3, -1.2, 2.0}), Eigen::Vector3d(0.1, -0.2, 0.3)};
};

void expectNear(const Pose3& a, const Pose3& b)
{
	EXPECT_LT((a.p - b.p).norm(), 1e-12);
	EXPECT_LT(a.R.angularDistance(b.R), 1e-12);
}
}  // namespace

TEST(MrptTime, HundredNanosecondsRoundedToNearest)
{
	for (int64_t t : {int64_t{0}, kStart_ns, -kStart_ns, int64_t{1403715273262142900}}) EXPECT_EQ(nanosecondsOf(mrptTime(t)), t);
	EXPECT_EQ(roundedToRawlog(1403715273262142976), 1403715273262143000);
	EXPECT_EQ(roundedToRawlog(149), 100);
	EXPECT_EQ(roundedToRawlog(150), 200);
	EXPECT_EQ(roundedToRawlog(-149), -100);
	EXPECT_EQ(roundedToRawlog(-151), -200);
	EXPECT_NEAR(mrpt::Clock::toDouble(mrptTime(kStart_ns)), 1700000000.1234567, 1e-6);
	EXPECT_LT(nanosecondsOf(INVALID_TIMESTAMP), 0);
}

TEST_F(RawlogWriterTest, ImuKeepsItsAxes)
{
	const ImuSample sample{kStart_ns, {1, 2, 3}, {4, 5, 6}};
	const auto imu = throughFile(makeImu(sample, T_Ox, "MYNT"));
	ASSERT_TRUE(imu);
	EXPECT_EQ(imu->sensorLabel, "MYNT");
	EXPECT_EQ(nanosecondsOf(imu->timestamp), kStart_ns);
	expectNear(fromMrpt(imu->sensorPose), T_Ox);
	EXPECT_EQ(imu->get(IMU_X_ACC), 1);
	EXPECT_EQ(imu->get(IMU_Z_ACC), 3);
	EXPECT_EQ(imu->get(IMU_WX), 4);
	EXPECT_EQ(imu->get(IMU_YAW_VEL), 6);
	EXPECT_EQ(imu->rawMeasurements[3], 6) << "MRPT's slot 3 is the rate about z";
	EXPECT_FALSE(imu->has(IMU_TEMPERATURE));
}

TEST_F(RawlogWriterTest, OdometryWithAndWithoutTicks)
{
	const auto with = throughFile(makeOdometry(kStart_ns, {0.15, -0.2}, EncoderTicks{-7, 2147483647}, 1, 2, 3, "BASE"));
	ASSERT_TRUE(with);
	EXPECT_EQ(with->sensorLabel, "BASE");
	EXPECT_TRUE(with->hasVelocities && with->hasEncodersInfo);
	EXPECT_EQ(with->velocityLocal.vx, 0.15);
	EXPECT_EQ(with->velocityLocal.omega, -0.2);
	EXPECT_EQ(with->encoderLeftTicks, -7);
	EXPECT_EQ(with->encoderRightTicks, 2147483647);
	EXPECT_NEAR(with->odometry.phi(), 3, 1e-12);
	EXPECT_FALSE(throughFile(makeOdometry(kStart_ns, {0.15, -0.2}))->hasEncodersInfo);
}

TEST_F(RawlogWriterTest, ScanMarksMissingReturns)
{
	const auto scan = throughFile(makeScan(kStart_ns, {1.5f, 0, std::nanf(""), 25, 20}, 4.5, 20, T_Ox));
	ASSERT_TRUE(scan);
	EXPECT_EQ(scan->sensorLabel, "LMS100");
	ASSERT_EQ(scan->getScanSize(), 5u);
	const std::vector<bool> expected{true, false, false, false, true};
	for (size_t i = 0; i < 5; i++) EXPECT_EQ(scan->getScanRangeValidity(i), expected[i]) << i;
	EXPECT_EQ(scan->getScanRange(0), 1.5f);
	EXPECT_TRUE(scan->rightToLeft);
	EXPECT_FLOAT_EQ(scan->aperture, 4.5f);
	EXPECT_FLOAT_EQ(scan->maxRange, 20);
	expectNear(fromMrpt(scan->sensorPose), T_Ox);
}

TEST_F(RawlogWriterTest, EveryCameraModelComesBack)
{
	using D = CameraModel::Distortion;
	const CameraModel models[] = {CameraModel(64, 48, 30, 31, 32, 24), smallCamera(),
	                              CameraModel(64, 48, 30, 31, 32, 24, D::kannala_brandt, {0.1, -0.2, 0.3, -0.4, 0})};
	for (const auto& model : models)
	{
		const auto image = throughFile(makeEmbeddedImage(kStart_ns, model, T_Ox, gradientImage()));
		ASSERT_TRUE(image);
		expectNear(fromMrpt(image->cameraPose), T_Ox);
		const CameraModel back = fromMrpt(image->cameraParams);
		EXPECT_EQ(back.distortion(), model.distortion());
		EXPECT_EQ(back.coefficients(), model.coefficients());
		EXPECT_EQ(back.width_px(), 64);
		EXPECT_EQ(back.height_px(), 48);
		EXPECT_EQ(back.fx_px(), model.fx_px());
		EXPECT_EQ(back.fy_px(), model.fy_px());
		EXPECT_EQ(back.cx_px(), model.cx_px());
		EXPECT_EQ(back.cy_px(), model.cy_px());
	}
	EXPECT_EQ(toMrpt(models[2]).k3(), 0.3);
	EXPECT_EQ(toMrpt(models[2]).k4(), -0.4);
}

TEST(CameraParameters, BadCalibrationIsAnError)
{
	mrpt::img::TCamera camera;
	expectError([&] { fromMrpt(camera); }, {"no calibration", "focal length 0"});
	camera.setIntrinsicParamsFromValues(-1, 1, 0, 0);
	expectError([&] { fromMrpt(camera); }, {"negative"});
	camera.setIntrinsicParamsFromValues(1, std::nan(""), 0, 0);
	expectError([&] { fromMrpt(camera); }, {"non-finite"});
	camera.setIntrinsicParamsFromValues(1, 1, 0, 0);
	camera.ncols = 0;
	expectError([&] { fromMrpt(camera); }, {"image size"});
	camera.ncols = 640;
	camera.nrows = 480;
	expectError([&] { fromMrpt(camera); }, {"640 x 480", "principal point"});
	camera.setIntrinsicParamsFromValues(340, 340, 642, 475);
	expectError([&] { fromMrpt(camera); }, {"cx 642.0", "640 x 480", "principal point"});
	camera.setIntrinsicParamsFromValues(340, 340, 321, 238);
	camera.distortion = mrpt::img::DistortionModel::plumb_bob;
	camera.dist[5] = 0.1;
	expectError([&] { fromMrpt(camera); }, {"five"});
}

TEST_F(RawlogWriterTest, ExternalImageNames)
{
	EXPECT_EQ(RawlogWriter::imageName("CAM", 1403715273000000042), "CAM_1403715273.000000042.jpg");
	RawlogWriter writer(path);
	EXPECT_FALSE(fs::exists(folder.file("test_Images")));
	EXPECT_EQ(writer.imagePath("CAM", 5, "png"), folder.file("test_Images/CAM_0.000000005.png"));
	EXPECT_TRUE(fs::is_directory(folder.file("test_Images")));
}

TEST_F(RawlogWriterTest, SameInputSameBytes)
{
	writeSecond(folder.file("a.rawlog"));
	writeSecond(folder.file("b.rawlog"));
	const std::string a = readFile(folder.file("a.rawlog"));
	EXPECT_GT(a.size(), 1000u);
	EXPECT_TRUE(a == readFile(folder.file("b.rawlog")));
	const std::string gzip_head("\x1f\x8b\x08\x00\x00\x00\x00\x00", 8);
	EXPECT_EQ(a.substr(0, 8), gzip_head) << "no name, no time";
}

TEST_F(RawlogWriterTest, NothingAppearsWithoutClose)
{
	{
		RawlogWriter writer(path);
		writer.write(makeOdometry(kStart_ns, {}));
		EXPECT_FALSE(fs::exists(path));
	}
	EXPECT_TRUE(fs::is_empty(folder.path()));
	expectError([&] { RawlogWriter(folder.file("none/x.rawlog")); }, {"none/x.rawlog", "no folder"});
}

TEST_F(RawlogWriterTest, AFileInTheWayOfTheImagesIsTold)
{
	writeFile(folder.file("x_Images"), "");
	RawlogWriter writer(folder.file("x.rawlog"));
	expectError([&] { writer.imagesFolder(); }, {folder.file("x_Images"), "a file of this name is in the way", "move it away"});
}

TEST_F(RawlogWriterTest, ImagesOfARawlogThatDoesNotAppearAreRemoved)
{
	for (const bool earlier_images : {false, true})
	{
		const std::string images = folder.file("x_Images"), kept = images + "/" + RawlogWriter::imageName("CAM", kStart_ns);
		if (earlier_images) fs::create_directory(images), writeFile(kept, "earlier");
		{
			RawlogWriter writer(folder.file("x.rawlog"));
			writeFile(writer.imagePath("CAM", kStart_ns), "later");
			writeFile(writer.imagePath("CAM", kStart_ns + 1000), "later");
		}
		EXPECT_EQ(fs::exists(images), earlier_images);
		EXPECT_EQ(fs::exists(kept), earlier_images);
		EXPECT_FALSE(fs::exists(images + "/" + RawlogWriter::imageName("CAM", kStart_ns + 1000)));
	}
	RawlogWriter writer(folder.file("x.rawlog"));
	const std::string image = writer.imagePath("CAM", kStart_ns + 1000);
	writeFile(image, "later");
	writer.close();
	EXPECT_TRUE(fs::exists(image));
}

TEST_F(RawlogWriterTest, FullDiskIsAnError)
{
	if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
	RawlogWriter writer("/dev/full");
	writer.write(makeOdometry(kStart_ns, {}));
	expectError([&] { writer.close(); }, {"/dev/full", "cannot write"});
}
