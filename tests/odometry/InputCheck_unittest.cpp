#include "InputCheck.h"

#include <gtest/gtest.h>
#include <viwo/rawlog/RawlogWriter.h>

#include "ExpectError.h"
#include "TempFolder.h"

namespace viwo
{
namespace
{
constexpr int64_t kStart_ns = 1700000000000000000;

/** Two seconds of sensors at the given rates; 0: none. Images have no files: nobody looks at them here. */
std::string logOf(const viwo::testing::TempFolder& folder, int image_hz, int imu_hz, int odometry_hz)
{
	const std::string path = folder.file("x.rawlog");
	RawlogWriter writer(path);
	mrpt::img::CImage image(8, 8, mrpt::img::CH_GRAY);
	const CameraModel camera{8, 8, 10, 10, 4, 4, CameraModel::Distortion::none, {}};
	for (int ms = 0; ms < 2000; ++ms)
	{
		const int64_t t_ns = kStart_ns + ms * 1000000LL;
		const auto due = [&](int hz) { return hz > 0 && ms % (1000 / hz) == 0; };
		if (due(imu_hz)) writer.write(makeImu({t_ns, Eigen::Vector3d(0, 0, 9.81), Eigen::Vector3d::Zero()}, Pose3()));
		if (due(odometry_hz)) writer.write(makeOdometry(t_ns, {0.1, 0}));
		if (due(image_hz)) writer.write(makeEmbeddedImage(t_ns, camera, Pose3(), image));
	}
	writer.close();
	return path;
}

class InputCheck : public ::testing::Test
{
   protected:
	OdometryRunOptions options(const std::string& rawlog, Mode mode)
	{
		OdometryRunOptions o;
		o.rawlog = rawlog;
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

TEST_F(InputCheck, ImuMustBeFasterThanTheCamera)
{
	viwo::testing::expectError([&] { checkInput(options(logOf(folder_, 20, 10, 20), Mode::viwo)); }, {"IMU has 10.0 Hz", "camera 20.0 Hz"});
	checkInput(options(logOf(folder_, 20, 10, 20), Mode::wio));
}
}  // namespace
}  // namespace viwo
