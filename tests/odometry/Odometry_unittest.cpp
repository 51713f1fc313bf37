#include <gtest/gtest.h>
#include <viwo/odometry/Odometry.h>
#include <viwo/rawlog/MrptTime.h>
#include <viwo/rawlog/RawlogWriter.h>

#include <iostream>

#include "DrivenLog.h"
#include "ExpectError.h"

namespace viwo
{
namespace
{
using viwo::testing::DrivenLog;
using viwo::testing::largestDistance_m;

OdometryOptions optionsOf(Mode mode)
{
	OdometryOptions options;
	options.estimator.mode = mode;
	return options;
}

/** Feeds all observations; quiet. */
void feed(Odometry& odometry, const std::vector<mrpt::obs::CObservation::Ptr>& observations)
{
	odometry.setMinLoggingLevel(mrpt::system::LVL_ERROR);
	for (const auto& observation : observations) odometry.processObservation(observation);
	odometry.finish();
}

bool sameTrajectory(const Trajectory& a, const Trajectory& b)
{
	if (a.size() != b.size()) return false;
	for (size_t i = 0; i < a.size(); ++i)
		if (a.poses()[i].t_ns != b.poses()[i].t_ns || a.poses()[i].T.p != b.poses()[i].T.p ||
		    !a.poses()[i].T.R.coeffs().isApprox(b.poses()[i].T.R.coeffs(), 0))
			return false;
	return true;
}

class OdometryModes : public ::testing::TestWithParam<Mode>
{
};

TEST_P(OdometryModes, FollowsADriveWithoutACamera)
{
	const DrivenLog log;
	Odometry odometry(optionsOf(GetParam()));
	size_t callbacks = 0, imu_rate = 0;
	odometry.onFrame([&](const FrameEstimate& e) { callbacks += e.has_pose; });
	odometry.onImuRate([&](const NavState&) { ++imu_rate; });
	feed(odometry, log.observations());
	ASSERT_TRUE(odometry.latest().has_pose);
	const double error_m = largestDistance_m(odometry.trajectory(), log.truth);
	std::cout << "[measured] mode " << modeNames()[static_cast<size_t>(GetParam())] << ": " << 100 * error_m << " cm after "
	          << log.truth.length_m() << " m\n";
	EXPECT_LT(error_m, 0.08);
	EXPECT_EQ(callbacks, odometry.trajectory().size());
	EXPECT_GT(odometry.trajectory().size(), 140u) << "10 poses a second";
	EXPECT_TRUE(odometry.landmarks().empty());
	EXPECT_EQ(odometry.observationCounts().count("CAM"), 0u);
	if (GetParam() == Mode::wio)
	{
		EXPECT_GT(imu_rate, 10 * odometry.trajectory().size());
	}
}

INSTANTIATE_TEST_SUITE_P(All, OdometryModes, ::testing::Values(Mode::wheel, Mode::wio),
                         [](const auto& info) { return modeNames()[static_cast<size_t>(info.param)]; });

TEST(Odometry, NothingBeforeTheFirstObservations)
{
	Odometry odometry;
	EXPECT_FALSE(odometry.latest().has_pose);
	EXPECT_EQ(odometry.status(), Status::waiting);
	EXPECT_EQ(odometry.calibration(), nullptr);
	EXPECT_TRUE(odometry.trajectory().empty());
	odometry.finish();
	EXPECT_FALSE(odometry.latest().has_pose);
}

TEST(Odometry, OtherLabelsAreIgnored)
{
	const DrivenLog log("straight 0.3 m");
	auto observations = log.observations();
	Odometry plain(optionsOf(Mode::wio)), disturbed(optionsOf(Mode::wio));
	feed(plain, observations);
	for (size_t i = 0; i < observations.size(); i += 7)
	{
		const auto stranger = std::dynamic_pointer_cast<mrpt::obs::CObservation>(observations[i]->duplicateGetSmartPtr());
		stranger->sensorLabel = "STRANGER";
		observations.insert(observations.begin() + static_cast<std::ptrdiff_t>(i), stranger);
	}
	feed(disturbed, observations);
	EXPECT_TRUE(sameTrajectory(plain.trajectory(), disturbed.trajectory()));
}

TEST(Odometry, SameObservationsSamePoses)
{
	const DrivenLog log("straight 0.5 m, rotate 20 deg");
	Odometry a(optionsOf(Mode::wio)), b(optionsOf(Mode::wio));
	feed(a, log.observations());
	feed(b, log.observations());
	EXPECT_FALSE(a.trajectory().empty());
	EXPECT_TRUE(sameTrajectory(a.trajectory(), b.trajectory()));
}

TEST(Odometry, CalibrationCanBeGiven)
{
	const DrivenLog log("straight 0.5 m");
	Calibration given;
	given.T_OB = Pose3(forwardOpticalAxes(), Eigen::Vector3d(0.1, 0.02, 0.3));
	given.wheels.track_m = 0.23;
	Odometry from_log(optionsOf(Mode::wio)), from_caller(optionsOf(Mode::wio), given);
	feed(from_log, log.observations());
	feed(from_caller, log.observations());
	ASSERT_NE(from_log.calibration(), nullptr);
	EXPECT_LT((from_log.calibration()->T_OB.p - given.T_OB.p).norm(), 1e-9);
	ASSERT_EQ(from_log.trajectory().size(), from_caller.trajectory().size());
	for (size_t i = 0; i < from_log.trajectory().size(); ++i)
		EXPECT_LT((from_log.trajectory().poses()[i].T.p - from_caller.trajectory().poses()[i].T.p).norm(), 1e-6);
}

/** Copies, so that others keep their stamps. */
std::vector<mrpt::obs::CObservation::Ptr> copies(const std::vector<mrpt::obs::CObservation::Ptr>& observations)
{
	std::vector<mrpt::obs::CObservation::Ptr> result;
	for (const auto& o : observations) result.push_back(std::dynamic_pointer_cast<mrpt::obs::CObservation>(o->duplicateGetSmartPtr()));
	return result;
}

void shift(mrpt::obs::CObservation& o, double by_s)
{
	o.timestamp = mrptTime(nanosecondsOf(o.timestamp) + nanoseconds(by_s));
}

/** Exact encoder ticks at 1 m/s for 20 s, of which each third is stamped late. */
double wheelTravelOfTicks_m(double late_s)
{
	OdometryOptions options = optionsOf(Mode::wheel);
	options.rawlog.odometry_source = AdapterOptions::OdometrySource::ticks_absolute;
	options.rawlog.metres_per_tick = 1e-4;
	std::vector<mrpt::obs::CObservation::Ptr> readings;
	for (int i = 0; i < 2000; ++i)
	{
		const auto reading = mrpt::obs::CObservationOdometry::Create();
		reading->sensorLabel = "ODOMETRY";
		reading->timestamp = mrptTime(nanoseconds(1e6 + 0.01 * i + (i % 3 == 0 ? late_s : 0)));
		reading->hasEncodersInfo = true;
		reading->encoderLeftTicks = reading->encoderRightTicks = 100 * i;
		readings.push_back(reading);
	}
	Odometry odometry(options);
	feed(odometry, readings);
	return odometry.wheelTravel_m();
}

/** Speeds are means since the sample before: averaged once more, they would tell several percent too much here. */
TEST(Odometry, WheelTravelIsThatOfTheTicksHoweverUnevenTheirStamps)
{
	const double even_m = wheelTravelOfTicks_m(0), uneven_m = wheelTravelOfTicks_m(0.004);
	std::cout << "[measured] " << uneven_m << " m with uneven stamps, " << even_m << " m with even ones\n";
	EXPECT_NEAR(even_m, 20, 0.5) << "but for what came before the first pose";
	EXPECT_NEAR(uneven_m, even_m, 0.02);
}

TEST_P(OdometryModes, OneWrongStampCostsOneObservation)
{
	const DrivenLog log("straight 0.6 m");
	const auto observations = log.observations();
	for (const double by_s : {1e6, 1e9, -1.6e9})
	{
		auto wrong = copies(observations);
		size_t i = wrong.size() / 2;
		while (wrong[i]->sensorLabel != "ODOMETRY") ++i;
		shift(*wrong[i], by_s);
		Odometry odometry(optionsOf(GetParam()));
		feed(odometry, wrong);
		EXPECT_EQ(odometry.observationCounts().at("ODOMETRY").rejected.at("stamp_jump"), 1u);
		EXPECT_LT(largestDistance_m(odometry.trajectory(), log.truth), 0.08);
		EXPECT_LT(odometry.trajectory().size(), 120u);
	}
}

/** The clock is set while the robot stands: all stamps go on elsewhere. */
TEST_P(OdometryModes, StreamThatGoesOnElsewhereIsAGapWithFewPosesInIt)
{
	const DrivenLog log("straight 0.9 m");
	const auto whole = log.observations();
	auto jumped = copies(whole);
	for (size_t i = jumped.size() / 2; i < jumped.size(); ++i) shift(*jumped[i], 1e8);
	Odometry plain(optionsOf(GetParam())), odometry(optionsOf(GetParam()));
	feed(plain, whole);
	feed(odometry, jumped);
	EXPECT_EQ(odometry.observationCounts().at("ODOMETRY").rejected.count("stamp_jump"), 0u);
	const int64_t half_ns = plain.trajectory().poses().front().t_ns + nanoseconds(1e7);
	size_t after = 0;
	for (const auto& pose : odometry.trajectory().poses()) after += pose.t_ns > half_ns;
	std::cout << "[measured] " << odometry.trajectory().size() << " poses, " << after << " of them behind the gap, "
	          << plain.trajectory().size() << " without a gap\n";
	EXPECT_GT(after, plain.trajectory().size() / 3);
	EXPECT_LT(odometry.trajectory().size(), plain.trajectory().size() + 110) << "at most ten seconds are filled";
}

TEST(Odometry, StopsBetweenTheFramesOfOneObservation)
{
	const DrivenLog log("straight 0.3 m");
	const auto observations = log.observations();
	Odometry odometry(optionsOf(Mode::wheel));
	int frames = 0;
	bool stop = false;
	odometry.onFrame([&](const FrameEstimate&) { ++frames; });
	odometry.stopWhen([&] { return stop; });
	feed(odometry, observations);
	const int before = frames;
	const auto wheels = makeOdometry(nanosecondsOf(observations.back()->timestamp) + nanoseconds(9.0), {0, 0});
	odometry.onFrame([&](const FrameEstimate&) { stop = ++frames >= before + 5; });
	odometry.processObservation(std::make_shared<mrpt::obs::CObservationOdometry>(wheels));
	EXPECT_EQ(frames, before + 5);
}

TEST(Odometry, TwoCamerasUnderOneLabelAreTold)
{
	const CameraModel camera{8, 8, 10, 10, 4, 4, CameraModel::Distortion::none, {}};
	const CameraModel other{8, 8, 11, 10, 4, 4, CameraModel::Distortion::none, {}};
	const mrpt::img::CImage pixels(8, 8, mrpt::img::CH_GRAY);
	const Pose3 T_OC(forwardOpticalAxes(), Eigen::Vector3d(0.1, 0, 0.3)), moved(forwardOpticalAxes(), Eigen::Vector3d(0.1, 0.1, 0.3));
	const auto image = [&](double t_s, const CameraModel& c, const Pose3& T)
	{ return std::make_shared<mrpt::obs::CObservationImage>(makeEmbeddedImage(nanoseconds(1e9 + t_s), c, T, pixels)); };
	Odometry viwo(optionsOf(Mode::viwo)), wheel(optionsOf(Mode::wheel));
	viwo.processObservation(image(0, camera, T_OC));
	viwo.processObservation(image(0.1, camera, T_OC));
	viwo::testing::expectError([&] { viwo.processObservation(image(0.2, camera, moved)); }, {"CAM", "cameraPose", "cam_label"});
	viwo::testing::expectError([&] { viwo.processObservation(image(0.3, other, T_OC)); }, {"CAM", "calibration", "cam_label"});
	wheel.processObservation(image(0, camera, T_OC));
	EXPECT_NO_THROW(wheel.processObservation(image(0.1, camera, moved))) << "only their times are used";
}

TEST(Odometry, StatusChangesHaveTheirCause)
{
	const DrivenLog log("straight 0.5 m");
	Odometry odometry(optionsOf(Mode::wio));
	feed(odometry, log.observations());
	ASSERT_FALSE(odometry.statusChanges().empty());
	for (const StatusChange& change : odometry.statusChanges())
	{
		EXPECT_NE(change.from, change.to);
		EXPECT_FALSE(change.cause.empty());
		EXPECT_GE(change.t_ns, odometry.firstFrame_ns());
	}
	EXPECT_EQ(odometry.statusChanges().back().to, odometry.status());
}
}  // namespace
}  // namespace viwo
