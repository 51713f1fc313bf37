#include <mrpt/obs/CObservationComment.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "ExpectError.h"
#include "RawlogFixture.h"

using namespace viwo;
using namespace viwo::testing;
using namespace mrpt::obs;
namespace fs = std::filesystem;

namespace
{
using RawlogReaderTest = RawlogTest;

CObservationOdometry odometryAt(int ms, const std::string& label = "ODOMETRY")
{
	return makeOdometry(kStart_ns + ms * kMillisecond_ns, {}, {}, ms, 0, 0, label);
}

int millisecondsOf(const CObservation::Ptr& o)
{
	return static_cast<int>((nanosecondsOf(o->timestamp) - kStart_ns) / kMillisecond_ns);
}

std::vector<int> millisecondsOf(const std::vector<CObservation::Ptr>& observations)
{
	std::vector<int> result;
	for (const auto& o : observations) result.push_back(millisecondsOf(o));
	return result;
}

CActionCollection action(double dx_m, int32_t left_ticks, int32_t right_ticks, mrpt::Clock::time_point stamp)
{
	CActionRobotMovement2D movement;
	movement.timestamp = stamp;
	movement.hasEncodersInfo = true;
	movement.encoderLeftTicks = left_ticks;
	movement.encoderRightTicks = right_ticks;
	movement.hasVelocities = true;
	movement.velocityLocal = {dx_m, 0, 0};
	movement.computeFromOdometry(mrpt::poses::CPose2D(dx_m, 0, M_PI / 2), {});
	CActionCollection actions;
	actions.insert(movement);
	return actions;
}

CSensoryFrame frameWithScan(int ms)
{
	CSensoryFrame frame;
	frame.insert(std::make_shared<CObservation2DRangeScan>(makeScan(kStart_ns + ms * kMillisecond_ns, {1.f}, 1, 10, Pose3())));
	return frame;
}
}  // namespace

TEST_F(RawlogReaderTest, CompressedAndPlainGiveTheSame)
{
	PlainRawlog plain;
	RawlogWriter writer(folder.file("gz.rawlog"));
	for (int ms = 0; ms < 100; ms += 10)
	{
		plain << odometryAt(ms);
		writer.write(odometryAt(ms));
	}
	writer.close();
	writeFile(path, plain.bytes());
	const auto a = readAll(path), b = readAll(folder.file("gz.rawlog"));
	EXPECT_EQ(millisecondsOf(a), millisecondsOf(b));
	EXPECT_EQ(millisecondsOf(a), (std::vector<int>{0, 10, 20, 30, 40, 50, 60, 70, 80, 90}));
}

TEST_F(RawlogReaderTest, CountsByLabelAndClass)
{
	writeSecond(path);
	RawlogReader reader(path);
	EXPECT_EQ(readAll(reader).size(), kSecondEntries);
	EXPECT_EQ(reader.next(), nullptr);
	const auto& counts = reader.counts();
	EXPECT_EQ(counts.entries, kSecondEntries);
	ASSERT_EQ(counts.sensors.size(), 4u);
	const auto& imu = counts.sensors.at({"IMU", "CObservationIMU"});
	EXPECT_EQ(imu.read, kSecondImu);
	EXPECT_EQ(imu.first_t_ns, kStart_ns);
	EXPECT_EQ(imu.last_t_ns, kStart_ns + 995 * kMillisecond_ns);
	EXPECT_EQ(
	    counts.describe(),
	    "CAM (10 CObservationImage), IMU (200 CObservationIMU), LMS100 (25 CObservation2DRangeScan), ODOMETRY (20 CObservationOdometry)");
	EXPECT_EQ(reader.progress(), 1);
	EXPECT_FALSE(reader.truncated());
}

TEST_F(RawlogReaderTest, LabelsFilterWhatIsDeliveredButNotTheCounts)
{
	writeSecond(path);
	RawlogReaderOptions options;
	options.labels = {"CAM", "ODOMETRY"};
	RawlogReader reader(path, options);
	EXPECT_EQ(readAll(reader).size(), kSecondImages + kSecondOdometry);
	EXPECT_EQ(reader.counts().sensors.at({"IMU", "CObservationIMU"}).read, kSecondImu);
}

TEST_F(RawlogReaderTest, SortsWithinTheWindow)
{
	PlainRawlog plain;
	std::vector<int> stamps;
	for (int ms = 0; ms < 5000; ms += 10) stamps.push_back(ms);
	std::mt19937 generator(1);
	for (size_t i = 0; i + 40 < stamps.size(); i += 40)
		std::shuffle(stamps.begin() + static_cast<long>(i), stamps.begin() + static_cast<long>(i) + 40, generator);
	for (int ms : stamps) plain << odometryAt(ms);
	writeFile(path, plain.bytes());
	RawlogReader reader(path);
	const auto read = millisecondsOf(readAll(reader));
	EXPECT_EQ(read.size(), stamps.size());
	EXPECT_TRUE(std::is_sorted(read.begin(), read.end()));
	EXPECT_EQ(reader.counts().late, 0u);
}

TEST_F(RawlogReaderTest, EqualStampsStayInTheOrderOfTheFile)
{
	PlainRawlog plain;
	for (const char* label : {"B", "A", "C"}) plain << odometryAt(0, label);
	writeFile(path, plain.bytes());
	std::string order;
	for (const auto& o : readAll(path)) order += o->sensorLabel;
	EXPECT_EQ(order, "BAC");
}

TEST_F(RawlogReaderTest, TooLateIsDroppedAndCounted)
{
	PlainRawlog plain;
	for (int ms = 0; ms <= 2000; ms += 100) plain << odometryAt(ms);
	plain << odometryAt(1650, "SLOW") << odometryAt(1050, "SLOW") << odometryAt(2100);
	writeFile(path, plain.bytes());
	RawlogReader reader(path);
	const auto read = millisecondsOf(readAll(reader));
	EXPECT_TRUE(std::is_sorted(read.begin(), read.end()));
	EXPECT_TRUE(std::count(read.begin(), read.end(), 1650));
	EXPECT_FALSE(std::count(read.begin(), read.end(), 1050));
	EXPECT_EQ(reader.counts().late, 1u);
	EXPECT_EQ(reader.counts().sensors.at({"SLOW", "CObservationOdometry"}).late, 1u);
	EXPECT_EQ(reader.counts().sensors.at({"SLOW", "CObservationOdometry"}).read, 2u);
}

TEST_F(RawlogReaderTest, OneStampFarAheadCostsNothingElse)
{
	PlainRawlog plain;
	for (int ms = 0; ms < 1000; ms += 100) plain << odometryAt(ms);
	plain << odometryAt(1000000000);
	for (int ms = 1000; ms < 4000; ms += 200) plain << odometryAt(ms + 100) << odometryAt(ms);
	writeFile(path, plain.bytes());
	RawlogReader reader(path);
	const auto read = millisecondsOf(readAll(reader));
	EXPECT_EQ(read.size(), 40u) << "those that follow are still put in order";
	EXPECT_TRUE(std::is_sorted(read.begin(), read.end()));
	EXPECT_EQ(reader.counts().late, 0u);
	EXPECT_EQ(reader.counts().sensors.at({"ODOMETRY", "CObservationOdometry"}).stamp_jumps, 1u);

	RawlogReaderOptions all;
	all.max_stamp_jump_s = 0;
	RawlogReader credulous(path, all);
	EXPECT_EQ(millisecondsOf(readAll(credulous)).back(), 1000000000);
}

TEST_F(RawlogReaderTest, ObservationsWithoutStampAreCounted)
{
	auto unstamped = odometryAt(0);
	unstamped.timestamp = INVALID_TIMESTAMP;
	PlainRawlog plain;
	plain << odometryAt(0) << unstamped << odometryAt(10);
	writeFile(path, plain.bytes());
	RawlogReader reader(path);
	EXPECT_EQ(millisecondsOf(readAll(reader)), (std::vector<int>{0, 10}));
	EXPECT_EQ(reader.counts().sensors.at({"ODOMETRY", "CObservationOdometry"}).unstamped, 1u);
	EXPECT_EQ(reader.counts().sensors.at({"ODOMETRY", "CObservationOdometry"}).first_t_ns, kStart_ns);
}

TEST_F(RawlogReaderTest, CommentsAreKeptApart)
{
	CObservationComment comment;
	comment.text = "recorded on a Monday";
	PlainRawlog plain;
	plain << comment << odometryAt(0);
	writeFile(path, plain.bytes());
	RawlogReader reader(path);
	EXPECT_EQ(readAll(reader).size(), 1u);
	EXPECT_EQ(reader.comment(), "recorded on a Monday");
}

TEST_F(RawlogReaderTest, ActionsBecomeAbsoluteOdometry)
{
	PlainRawlog plain;
	plain << action(1, 100, 200, mrptTime(kStart_ns)) << frameWithScan(5)
	      << action(2, 10, -300, mrptTime(kStart_ns + 100 * kMillisecond_ns)) << frameWithScan(105);
	writeFile(path, plain.bytes());
	RawlogReader reader(path);
	const auto all = readAll(reader);
	EXPECT_EQ(reader.counts().entries, 4u);
	ASSERT_EQ(all.size(), 4u);
	EXPECT_EQ(millisecondsOf(all), (std::vector<int>{0, 5, 100, 105}));
	const auto first = std::dynamic_pointer_cast<CObservationOdometry>(all[0]),
	           second = std::dynamic_pointer_cast<CObservationOdometry>(all[2]);
	ASSERT_TRUE(first && second);
	EXPECT_EQ(first->sensorLabel, "ODOMETRY");
	EXPECT_EQ(first->encoderRightTicks, 200);
	EXPECT_EQ(second->encoderLeftTicks, 110);
	EXPECT_EQ(second->encoderRightTicks, -100);
	EXPECT_EQ(second->velocityLocal.vx, 2);
	// (1, 0, 90 deg), then 2 m ahead, which is along y.
	EXPECT_NEAR(second->odometry.x(), 1, 1e-12);
	EXPECT_NEAR(second->odometry.y(), 2, 1e-12);
	EXPECT_NEAR(std::abs(second->odometry.phi()), M_PI, 1e-12);
}

TEST_F(RawlogReaderTest, ActionsWithoutStampTakeThatOfTheirFrame)
{
	PlainRawlog plain;
	CSensoryFrame empty;
	plain << action(1, 0, 0, INVALID_TIMESTAMP) << empty << action(1, 0, 0, INVALID_TIMESTAMP) << frameWithScan(50)
	      << action(1, 0, 0, INVALID_TIMESTAMP);
	writeFile(path, plain.bytes());
	RawlogReaderOptions options;
	options.action_odometry_label = "WHEELS";
	RawlogReader reader(path, options);
	const auto all = readAll(reader);
	EXPECT_EQ(millisecondsOf(all), (std::vector<int>{50, 50, 50}));
	EXPECT_EQ(all.at(0)->sensorLabel, "WHEELS");
	EXPECT_EQ(all.at(2)->sensorLabel, "LMS100");
	const auto& wheels = reader.counts().sensors.at({"WHEELS", "CObservationOdometry"});
	EXPECT_EQ(wheels.read, 3u);
	EXPECT_EQ(wheels.unstamped, 1u) << "no frame follows the last action";
}
