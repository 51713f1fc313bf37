#include "InputCheck.h"

#include <gtest/gtest.h>
#include <viwo/core/Time.h>
#include <viwo/rawlog/RawlogWriter.h>

#include <filesystem>
#include <utility>

#include "ExpectError.h"
#include "TempFolder.h"

namespace viwo
{
namespace
{
constexpr int64_t kStart_ns = 1700000000000000000;

/** Two seconds of sensors at the given rates; 0: none. Images have no files: nobody looks at them here. */
struct Robot
{
	int image_hz = 10, imu_hz = 100, odometry_hz = 20;
	Pose3 T_OB;
	Pose3 T_OC{forwardOpticalAxes(), Eigen::Vector3d(0.1, 0, 0.3)};
	Eigen::Vector3d force_B_m_s2{0, 0, 9.81};
	double imu_clock_s = 0, odometry_clock_s = 0, image_clock_s = 0;  //!< fast by
	double duration_s = 2;
};

std::string logOf(const viwo::testing::TempFolder& folder, const Robot& robot)
{
	const std::string path = folder.file("x.rawlog");
	RawlogWriter writer(path);
	mrpt::img::CImage image(8, 8, mrpt::img::CH_GRAY);
	const CameraModel camera{8, 8, 10, 10, 4, 4, CameraModel::Distortion::none, {}};
	for (int ms = 0; ms < 1000 * robot.duration_s; ++ms)
	{
		const auto t_ns = [&](double clock_s) { return kStart_ns + ms * 1000000LL + nanoseconds(clock_s); };
		const auto due = [&](int hz) { return hz > 0 && ms % (1000 / hz) == 0; };
		if (due(robot.imu_hz)) writer.write(makeImu({t_ns(robot.imu_clock_s), robot.force_B_m_s2, Eigen::Vector3d::Zero()}, robot.T_OB));
		if (due(robot.odometry_hz)) writer.write(makeOdometry(t_ns(robot.odometry_clock_s), {0.1, 0}));
		if (due(robot.image_hz)) writer.write(makeEmbeddedImage(t_ns(robot.image_clock_s), camera, robot.T_OC, image));
	}
	writer.close();
	return path;
}

std::string logOf(const viwo::testing::TempFolder& folder, int image_hz, int imu_hz, int odometry_hz)
{
	Robot robot;
	robot.image_hz = image_hz;
	robot.imu_hz = imu_hz;
	robot.odometry_hz = odometry_hz;
	return logOf(folder, robot);
}

class InputCheck : public ::testing::Test
{
   protected:
	OdometryRunOptions options(const std::string& rawlog, Mode mode)
	{
		OdometryRunOptions o;
		o.rawlogs = {rawlog};
		o.odometry.estimator.mode = mode;
		return o;
	}

	const viwo::testing::TempFolder folder_;
};

TEST_F(InputCheck, TakesWhatTheModeNeeds)
{
	for (const Mode mode : {Mode::wheel, Mode::wio, Mode::vio, Mode::viwo}) checkInput(options(logOf(folder_, 10, 100, 20), mode));
	checkInput(options(logOf(folder_, 10, 100, 0), Mode::vio));
	checkInput(options(logOf(folder_, 0, 100, 20), Mode::wio));
	checkInput(options(logOf(folder_, 0, 0, 20), Mode::wheel));
}

TEST_F(InputCheck, MissingSensorIsNamedWithTheLabelsThereAre)
{
	using viwo::testing::expectError;
	expectError([&] { checkInput(options(logOf(folder_, 10, 100, 0), Mode::viwo)); }, {"x.rawlog", "no odometry", "CAM (20 ", "IMU (200 "});
	expectError([&] { checkInput(options(logOf(folder_, 10, 0, 20), Mode::vio)); }, {"no IMU", "ODOMETRY (40 "});
	expectError([&] { checkInput(options(logOf(folder_, 0, 100, 20), Mode::viwo)); }, {"no image", "cam_label"});
}

TEST_F(InputCheck, ObservationOfAnotherClassUnderTheLabelIsNoSensor)
{
	OdometryRunOptions o = options(logOf(folder_, 10, 100, 20), Mode::wheel);
	o.odometry.rawlog.odometry_label = "IMU";
	viwo::testing::expectError([&] { checkInput(o); }, {"no odometry", "under label IMU"});
}

TEST_F(InputCheck, SensorsOnDifferentClocks)
{
	for (const double clock_s : {-1.69e9, -100.0, 30.0, 1e9})
	{
		Robot robot;
		robot.duration_s = 8;
		robot.imu_clock_s = clock_s;
		viwo::testing::expectError([&] { checkInput(options(logOf(folder_, robot), Mode::wio)); }, {"IMU", "ODOMETRY", "different clocks"});
		EXPECT_NO_THROW(checkInput(options(logOf(folder_, robot), Mode::wheel))) << "the IMU is not used";
		robot.imu_clock_s = 0;
		robot.image_clock_s = clock_s;
		viwo::testing::expectError([&] { checkInput(options(logOf(folder_, robot), Mode::viwo)); }, {"CAM", "different clocks"});
	}
	Robot offset;
	offset.duration_s = 8;
	offset.image_clock_s = -8;
	OdometryRunOptions o = options(logOf(folder_, offset), Mode::vio);
	viwo::testing::expectError([&] { checkInput(o); }, {"different clocks"});
	o.odometry.rawlog.camera_time_offset_s = 8;
	EXPECT_NO_THROW(checkInput(o)) << "the configuration knows";
}

TEST_F(InputCheck, PosesOfSensorsThatWereNeverSet)
{
	using viwo::testing::expectError;
	Robot camera;
	camera.T_OC = Pose3();
	for (const Mode mode : {Mode::vio, Mode::viwo})
		expectError([&] { checkInput(options(logOf(folder_, camera), mode)); },
		            {"x.rawlog", "CAM", "identity", "rawlog-edit --sensors-pose"});
	EXPECT_NO_THROW(checkInput(options(logOf(folder_, camera), Mode::wio)));
	OdometryRunOptions to_write = options(logOf(folder_, camera), Mode::wheel);
	to_write.pose_frame = PoseFrame::C;
	expectError([&] { checkInput(to_write); }, {"identity"});

	Robot imu;
	imu.force_B_m_s2 = {0, -9.81, 0};  // axes as a camera's, but no pose that says so
	for (const Mode mode : {Mode::wio, Mode::viwo})
		expectError([&] { checkInput(options(logOf(folder_, imu), mode)); }, {"IMU", "90 deg", "rawlog-edit --sensors-pose"});
	EXPECT_NO_THROW(checkInput(options(logOf(folder_, imu), Mode::vio))) << "without wheels O is as good as any frame";
	imu.T_OB.R = forwardOpticalAxes();
	EXPECT_NO_THROW(checkInput(options(logOf(folder_, imu), Mode::viwo)));
	Robot slope;
	slope.force_B_m_s2 = {4, 0, 9};
	EXPECT_NO_THROW(checkInput(options(logOf(folder_, slope), Mode::viwo)));
}

TEST_F(InputCheck, AccelerometerThatDoesNotReadMetresPerSecondSquared)
{
	const auto reading = [&](double force, Mode mode, std::initializer_list<std::string> parts)
	{
		Robot robot;
		robot.force_B_m_s2 = {0, 0, force};
		viwo::testing::expectError([&] { checkInput(options(logOf(folder_, robot), mode)); }, parts);
	};
	reading(0, Mode::viwo, {"IMU", "gravity", "m/s^2"});
	reading(1, Mode::vio, {"IMU", "units of g"});
	reading(9810, Mode::wio, {"IMU", "9.81e+03", "m/s^2"});
}

TEST_F(InputCheck, LogsInTheWrongOrderAreToldBeforehand)
{
	Robot robot;
	std::filesystem::rename(logOf(folder_, robot), folder_.file("first.rawlog"));
	robot.imu_clock_s = robot.odometry_clock_s = robot.image_clock_s = 10;
	std::filesystem::rename(logOf(folder_, robot), folder_.file("second.rawlog"));
	OdometryRunOptions o = options(folder_.file("first.rawlog"), Mode::viwo);
	o.rawlogs.push_back(folder_.file("second.rawlog"));
	EXPECT_NO_THROW(checkInput(o));
	std::swap(o.rawlogs[0], o.rawlogs[1]);
	viwo::testing::expectError([&] { checkInput(o); },
	                           {"first.rawlog: begins 10.000 s before", "second.rawlog; give", "order of their time"});
}

TEST_F(InputCheck, MissingMaskIsToldByConfigurationAndKey)
{
	OdometryRunOptions o = options(logOf(folder_, 10, 100, 20), Mode::viwo);
	o.config_path = "robot.ini";
	o.odometry.tracker.mask_path = folder_.file("mask.png");
	viwo::testing::expectError([&] { checkInput(o); }, {"robot.ini: [tracker] mask_path", "mask.png", "no such file"});
	o.odometry.estimator.mode = Mode::wio;
	EXPECT_NO_THROW(checkInput(o));
}

TEST_F(InputCheck, PoseOfASensorThatTheLogLacksCannotBeWritten)
{
	OdometryRunOptions o = options(logOf(folder_, 0, 0, 20), Mode::wheel);
	o.pose_frame = PoseFrame::C;
	viwo::testing::expectError([&] { checkInput(o); }, {"no image", "--pose-frame C"});
	o.pose_frame = PoseFrame::B;
	viwo::testing::expectError([&] { checkInput(o); }, {"no IMU", "--pose-frame B"});
}

TEST_F(InputCheck, ImuMustBeFasterThanTheCamera)
{
	viwo::testing::expectError([&] { checkInput(options(logOf(folder_, 20, 10, 20), Mode::viwo)); }, {"IMU has 10.0 Hz", "camera 20.0 Hz"});
	checkInput(options(logOf(folder_, 20, 10, 20), Mode::wio));
}
}  // namespace
}  // namespace viwo
