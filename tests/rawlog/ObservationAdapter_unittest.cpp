#include <viwo/core/MrptPose.h>
#include <viwo/core/So3.h>
#include <viwo/rawlog/ObservationAdapter.h>

#include <cmath>

#include "ExpectError.h"
#include "RawlogFixture.h"

using namespace viwo;
using namespace viwo::testing;
using namespace mrpt::obs;
using Source = AdapterOptions::OdometrySource;

namespace
{
template <class Observation>
AdaptedObservation give(ObservationAdapter& adapter, const Observation& observation)
{
	return adapter.convert(std::make_shared<Observation>(observation));
}

template <class Sample, class Observation>
Sample sampleOf(ObservationAdapter& adapter, const Observation& observation)
{
	const auto result = give(adapter, observation);
	EXPECT_TRUE(std::holds_alternative<Sample>(result.sample));
	return std::holds_alternative<Sample>(result.sample) ? std::get<Sample>(result.sample) : Sample{};
}

bool isEmpty(const AdaptedObservation& result)
{
	return std::holds_alternative<std::monostate>(result.sample);
}

CObservationOdometry ticksAt(int ms, int32_t left, int32_t right)
{
	auto odometry = makeOdometry(kStart_ns + ms * kMillisecond_ns, {}, EncoderTicks{left, right});
	odometry.hasVelocities = false;
	return odometry;
}

AdapterOptions withSource(Source source)
{
	AdapterOptions options;
	options.odometry_source = source;
	options.metres_per_tick = 1e-3;
	return options;
}
}  // namespace

TEST(ObservationAdapter, ImuRoundTrip)
{
	ObservationAdapter adapter;
	const ImuSample sample{kStart_ns, {1, 2, 3}, {4, 5, 6}};
	const auto back = sampleOf<ImuSample>(adapter, makeImu(sample, Pose3()));
	EXPECT_EQ(back.t_ns, sample.t_ns);
	EXPECT_EQ(back.acc_m_s2, sample.acc_m_s2);
	EXPECT_EQ(back.gyro_rad_s, sample.gyro_rad_s);
}

TEST(ObservationAdapter, ImuReadsMrptsSlotsByMeaning)
{
	CObservationIMU imu;
	imu.sensorLabel = "IMU";
	imu.timestamp = mrptTime(kStart_ns);
	for (size_t i = 0; i < 6; i++)
	{
		imu.rawMeasurements[i] = static_cast<double>(i + 1);
		imu.dataIsPresent[i] = true;
	}
	ObservationAdapter adapter;
	const auto sample = sampleOf<ImuSample>(adapter, imu);
	EXPECT_EQ(sample.acc_m_s2, Eigen::Vector3d(1, 2, 3));
	EXPECT_EQ(sample.gyro_rad_s, Eigen::Vector3d(6, 5, 4));
}

TEST(ObservationAdapter, ImuSamplesBeyondAnySensorsRangeAreRejected)
{
	ObservationAdapter adapter;
	const auto imuAt = [](int ms, double acc_m_s2, double rate_rad_s) {
		return makeImu({kStart_ns + ms * kMillisecond_ns, {acc_m_s2, 0, 0}, {0, rate_rad_s, 0}}, Pose3());
	};
	EXPECT_FALSE(give(adapter, imuAt(0, 199, -34)).rejected);
	EXPECT_EQ(give(adapter, imuAt(5, -1e30, 0)).rejected, Rejection::out_of_range);
	EXPECT_EQ(give(adapter, imuAt(10, 9.81, 36)).rejected, Rejection::out_of_range);
	EXPECT_FALSE(give(adapter, imuAt(15, 9.81, 0)).rejected);
	EXPECT_EQ(adapter.counts().at("IMU").rejected.at("out_of_range"), 2u);

	AdapterOptions wide;
	wide.max_acc_m_s2 = 1e5;
	wide.max_rate_rad_s = 1e4;
	ObservationAdapter shock(wide);
	EXPECT_FALSE(give(shock, imuAt(0, 5000, 100)).rejected);
}

TEST(ObservationAdapter, VelocityBecomesWheelSpeeds)
{
	ObservationAdapter adapter;
	const auto sample = sampleOf<WheelSample>(adapter, makeOdometry(kStart_ns, {0.15, 0.1}));
	EXPECT_EQ(sample.t_ns, kStart_ns);
	EXPECT_NEAR(sample.v_left_m_s, 0.15 - 0.1 * 0.115, 1e-15);
	EXPECT_NEAR(sample.v_right_m_s, 0.15 + 0.1 * 0.115, 1e-15);
	const auto twist = twistOf(sample, WheelIntrinsics());
	EXPECT_NEAR(twist.v_m_s, 0.15, 1e-15);
	EXPECT_NEAR(twist.w_rad_s, 0.1, 1e-15);
}

TEST(ObservationAdapter, InstantaneousVelocitiesAreAveragedOverTheInterval)
{
	AdapterOptions options;
	options.velocity_meaning = AdapterOptions::VelocityMeaning::instantaneous;
	ObservationAdapter adapter(options);
	give(adapter, makeOdometry(kStart_ns, {0.1, 0}));
	const auto sample = sampleOf<WheelSample>(adapter, makeOdometry(kStart_ns + 50 * kMillisecond_ns, {0.3, 0}));
	EXPECT_NEAR(sample.v_left_m_s, 0.2, 1e-15);
}

TEST(ObservationAdapter, AbsoluteTicks)
{
	ObservationAdapter adapter(withSource(Source::ticks_absolute));
	const auto first = give(adapter, ticksAt(0, 5000, -5000));
	EXPECT_TRUE(isEmpty(first) && !first.rejected) << "the first reading only starts an interval";
	const auto sample = sampleOf<WheelSample>(adapter, ticksAt(50, 5010, -5020));
	EXPECT_NEAR(sample.v_left_m_s, 0.2, 1e-12);
	EXPECT_NEAR(sample.v_right_m_s, -0.4, 1e-12);
}

TEST(ObservationAdapter, AbsoluteTicksWrapAround)
{
	ObservationAdapter adapter(withSource(Source::ticks_absolute));
	give(adapter, ticksAt(0, 2147483645, -2147483646));
	const auto sample = sampleOf<WheelSample>(adapter, ticksAt(50, -2147483646, 2147483645));
	EXPECT_NEAR(sample.v_left_m_s, 5e-3 / 0.05, 1e-12);
	EXPECT_NEAR(sample.v_right_m_s, -5e-3 / 0.05, 1e-12);
}

TEST(ObservationAdapter, ResetEncoderIsRejectedAndTheNextIntervalIsGood)
{
	ObservationAdapter adapter(withSource(Source::ticks_absolute));
	give(adapter, ticksAt(0, 100000, 100000));
	EXPECT_EQ(give(adapter, ticksAt(50, 0, 0)).rejected, Rejection::too_fast);
	EXPECT_NEAR(sampleOf<WheelSample>(adapter, ticksAt(100, 10, 10)).v_left_m_s, 0.2, 1e-12);
	EXPECT_EQ(adapter.counts().at("ODOMETRY").rejected.at("too_fast"), 1u);
	EXPECT_EQ(adapter.counts().at("ODOMETRY").accepted, 2u);
}

TEST(ObservationAdapter, IncrementalTicksWithInvertedWheel)
{
	AdapterOptions options = withSource(Source::ticks_increment);
	options.metres_per_tick = 0;
	options.wheel_radius_m = 0.05;
	options.ticks_per_revolution = 1000;
	options.right_inverted = true;
	EXPECT_NEAR(options.metresPerTick(), 2 * M_PI * 0.05 / 1000, 1e-18);
	ObservationAdapter adapter(options);
	give(adapter, ticksAt(0, 7, 7));
	const auto sample = sampleOf<WheelSample>(adapter, ticksAt(100, 100, -100));
	EXPECT_NEAR(sample.v_left_m_s, 0.1 * M_PI, 1e-12);
	EXPECT_NEAR(sample.v_right_m_s, 0.1 * M_PI, 1e-12);
}

TEST(ObservationAdapter, BunchedStampsLoseNoTravel)
{
	for (const auto source : {Source::ticks_absolute, Source::ticks_increment})
	{
		ObservationAdapter adapter(withSource(source));
		double travel_m = 0;
		int64_t last_t_ns = 0;
		int32_t ticks = 0;
		// 100 Hz readings of 2 m/s that are received four at a time, 100 us apart.
		for (int i = 0; i < 401; i++)
		{
			ticks += 20;
			auto odometry = makeOdometry(kStart_ns + (i / 4) * 40 * kMillisecond_ns + (i % 4) * 100000, {}, EncoderTicks{});
			odometry.encoderLeftTicks = odometry.encoderRightTicks = source == Source::ticks_increment ? 20 : ticks;
			const auto result = give(adapter, odometry);
			EXPECT_FALSE(result.rejected);
			const auto* sample = std::get_if<WheelSample>(&result.sample);
			if (sample && last_t_ns) travel_m += sample->v_left_m_s * 1e-9 * static_cast<double>(sample->t_ns - last_t_ns);
			if (sample || i == 0) last_t_ns = sample ? sample->t_ns : kStart_ns;
		}
		EXPECT_NEAR(travel_m, 400 * 0.02, 1e-9);
	}
}

TEST(ObservationAdapter, PosesGiveTheTwistOfTheirArc)
{
	ObservationAdapter adapter(withSource(Source::pose));
	const double dt_s = 0.05;
	for (const auto& [v, w] : {std::pair{0.15, 0.3}, std::pair{-0.2, 0.5}, std::pair{0.3, 0.0}, std::pair{0.0, -1.0}, std::pair{0.5, 40.0}})
	{
		ObservationAdapter fresh(withSource(Source::pose));
		const double yaw0 = 2.9, dyaw = w * dt_s;
		const Eigen::Vector3d step = so3::leftJacobian({0, 0, dyaw}) * Eigen::Vector3d(v * dt_s, 0, 0);
		const Eigen::Vector3d end = so3::exp({0, 0, yaw0}) * step;
		give(fresh, makeOdometry(kStart_ns, {}, {}, 1, 2, yaw0));
		const auto sample =
		    sampleOf<WheelSample>(fresh, makeOdometry(kStart_ns + 50 * kMillisecond_ns, {}, {}, 1 + end.x(), 2 + end.y(), yaw0 + dyaw));
		const auto twist = twistOf(sample, WheelIntrinsics());
		EXPECT_NEAR(twist.v_m_s, v, 1e-12);
		EXPECT_NEAR(twist.w_rad_s, w, 1e-12);
	}
}

TEST(ObservationAdapter, ClockOffsets)
{
	AdapterOptions options;
	options.camera_time_offset_s = 0.0123;
	options.wheel_time_offset_s = -0.02;
	ObservationAdapter adapter(options);
	EXPECT_EQ(sampleOf<ImageRef>(adapter, makeImage(kStart_ns, smallCamera(), Pose3(), "x.png")).t_ns, kStart_ns + 12300000);
	EXPECT_EQ(sampleOf<WheelSample>(adapter, makeOdometry(kStart_ns, {})).t_ns, kStart_ns - 20000000);
	EXPECT_EQ(sampleOf<ImuSample>(adapter, makeImu(imuSample(kStart_ns), Pose3())).t_ns, kStart_ns);
}

TEST(ObservationAdapter, LabelsAreSelectable)
{
	AdapterOptions options;
	options.imu_label = "XSENS";
	ObservationAdapter adapter(options);
	const auto other = give(adapter, makeImu(imuSample(kStart_ns), Pose3(), "IMU"));
	EXPECT_TRUE(isEmpty(other) && !other.rejected);
	EXPECT_EQ(adapter.counts().count("IMU"), 0u);
	sampleOf<ImuSample>(adapter, makeImu(imuSample(kStart_ns), Pose3(), "XSENS"));
	EXPECT_EQ(adapter.counts().at("XSENS").accepted, 1u);
}

TEST(ObservationAdapter, BadImuReadingsAreRejectedByReason)
{
	ObservationAdapter adapter;
	const auto imuAt = [](int ms) { return makeImu(imuSample(kStart_ns + ms * kMillisecond_ns), Pose3()); };
	EXPECT_FALSE(give(adapter, imuAt(0)).rejected);
	auto nan = imuAt(5), infinite = imuAt(5), without_rate = imuAt(5);
	nan.rawMeasurements[IMU_X_ACC] = std::nan("");
	infinite.rawMeasurements[IMU_WY] = INFINITY;
	without_rate.dataIsPresent[IMU_WX] = false;
	EXPECT_EQ(give(adapter, nan).rejected, Rejection::not_finite);
	EXPECT_EQ(give(adapter, infinite).rejected, Rejection::not_finite);
	EXPECT_EQ(give(adapter, without_rate).rejected, Rejection::missing_data);
	EXPECT_EQ(give(adapter, imuAt(0)).rejected, Rejection::duplicate_stamp);
	EXPECT_EQ(give(adapter, imuAt(-5)).rejected, Rejection::stamp_backwards);
	EXPECT_FALSE(give(adapter, imuAt(5)).rejected);
	const auto& counts = adapter.counts().at("IMU");
	EXPECT_EQ(counts.accepted, 2u);
	EXPECT_EQ(counts.rejected,
	          (std::map<std::string, uint64_t>{{"not_finite", 2}, {"missing_data", 1}, {"duplicate_stamp", 1}, {"stamp_backwards", 1}}));
}

TEST(ObservationAdapter, AnOdometryPoseThatIsNoNumberMattersWhereItIsUsed)
{
	const auto poseless = [](int ms)
	{
		auto odometry = makeOdometry(kStart_ns + ms * kMillisecond_ns, {0.1, 0});
		odometry.odometry = mrpt::poses::CPose2D(std::nan(""), std::nan(""), std::nan(""));
		return odometry;
	};
	ObservationAdapter of_speeds;
	EXPECT_FALSE(give(of_speeds, poseless(0)).rejected);
	AdapterOptions options;
	options.odometry_source = AdapterOptions::OdometrySource::pose;
	ObservationAdapter of_poses(options);
	EXPECT_EQ(give(of_poses, poseless(0)).rejected, Rejection::not_finite);
	EXPECT_FALSE(give(of_poses, makeOdometry(kStart_ns, {std::nan(""), 0})).rejected);
}

TEST(ObservationAdapter, BadOdometryAndImageStampsAreRejected)
{
	ObservationAdapter adapter;
	EXPECT_FALSE(give(adapter, makeOdometry(kStart_ns, {0.1, 0})).rejected);
	EXPECT_EQ(give(adapter, makeOdometry(kStart_ns + 1000, {std::nan(""), 0})).rejected, Rejection::not_finite);
	EXPECT_EQ(give(adapter, makeOdometry(kStart_ns + 1000, {60, 0})).rejected, Rejection::too_fast);
	EXPECT_EQ(give(adapter, makeOdometry(kStart_ns, {0.1, 0})).rejected, Rejection::stamp_backwards);
	EXPECT_EQ(give(adapter, ticksAt(50, 1, 1)).rejected, Rejection::missing_data);
	EXPECT_FALSE(give(adapter, makeOdometry(kStart_ns + 2000, {0.1, 0})).rejected);

	const auto imageAt = [](int64_t t_ns) { return makeImage(t_ns, smallCamera(), Pose3(), "x.png"); };
	EXPECT_FALSE(give(adapter, imageAt(kStart_ns)).rejected);
	EXPECT_EQ(give(adapter, imageAt(kStart_ns)).rejected, Rejection::duplicate_stamp);
	EXPECT_EQ(give(adapter, imageAt(kStart_ns - 100)).rejected, Rejection::stamp_backwards);
}

TEST(ObservationAdapter, WhatCannotBeSkippedIsAnError)
{
	CObservationIMU only_orientation;
	only_orientation.sensorLabel = "IMU";
	only_orientation.timestamp = mrptTime(kStart_ns);
	only_orientation.set(IMU_YAW, 1);
	expectError(
	    [&]
	    {
		    ObservationAdapter a;
		    give(a, only_orientation);
	    },
	    {"IMU", "no accelerations", "imu_label"});
	auto no_rates = makeImu(imuSample(kStart_ns), Pose3());
	no_rates.dataIsPresent[IMU_WZ] = false;
	expectError(
	    [&]
	    {
		    ObservationAdapter a;
		    give(a, no_rates);
	    },
	    {"IMU", "no angular rates"});
	expectError(
	    [&]
	    {
		    ObservationAdapter a;
		    give(a, ticksAt(0, 1, 1));
	    },
	    {"ODOMETRY", "no velocities", "odometry_source", "ticks_absolute", "pose"});
	expectError(
	    [&]
	    {
		    ObservationAdapter a(withSource(Source::ticks_absolute));
		    give(a, makeOdometry(kStart_ns, {}));
	    },
	    {"no encoder ticks", "velocity, pose"});
	expectError(
	    [&]
	    {
		    ObservationAdapter a;
		    give(a, makeOdometry(kStart_ns, {}, {}, 0, 0, 0, "CAM"));
	    },
	    {"CAM", "CObservationOdometry", "CObservationImage", "cam_label"});
}

TEST(ObservationAdapter, OptionsThroughAFile)
{
	TempFolder folder;
	AdapterOptions options = withSource(Source::ticks_increment);
	options.right_inverted = true;
	options.cam_label = "LEFT_CAM";
	saveOptions(folder.file("c.ini"), {{"adapter", &options}});
	AdapterOptions back;
	loadOptions(folder.file("c.ini"), {{"adapter", &back}});
	EXPECT_EQ(back.odometry_source, Source::ticks_increment);
	EXPECT_TRUE(back.right_inverted);
	EXPECT_EQ(back.cam_label, "LEFT_CAM");
	EXPECT_EQ(back.metres_per_tick, 1e-3);
}

TEST(CalibrationFrom, PosesCameraAndTrack)
{
	const Pose3 T_OB(so3::expQuaternion({0.1, 0.2, 0.3}), Eigen::Vector3d(0.05, 0, 0.3)),
	    T_OC(forwardOpticalAxes(), Eigen::Vector3d(0.1, 0.02, 0.31));
	const auto image = makeImage(kStart_ns, smallCamera(), T_OC, "x.png");
	const auto imu = makeImu(imuSample(kStart_ns), T_OB);
	AdapterOptions options;
	options.track_m = 1.25;
	const Calibration c = calibrationFrom(options, &image, &imu);
	EXPECT_LT((c.T_OB.p - T_OB.p).norm() + c.T_OB.R.angularDistance(T_OB.R), 1e-12);
	EXPECT_LT((c.T_OC.p - T_OC.p).norm() + c.T_OC.R.angularDistance(T_OC.R), 1e-12);
	EXPECT_EQ(c.camera.coefficients(), smallCamera().coefficients());
	EXPECT_EQ(c.camera.distortion(), CameraModel::Distortion::plumb_bob);
	EXPECT_EQ(c.wheels.track_m, 1.25);
	const Calibration wheels_only = calibrationFrom(options, nullptr, nullptr);
	EXPECT_EQ(wheels_only.camera.width_px(), 0);
	EXPECT_EQ(wheels_only.T_OB.p, Eigen::Vector3d::Zero());

	auto uncalibrated = image;
	uncalibrated.cameraParams.setIntrinsicParamsFromValues(0, 0, 0, 0);
	expectError([&] { calibrationFrom(options, &uncalibrated, &imu); }, {"CAM", "focal length 0", "rawlog-edit --camera-params"});
	auto lost = imu;
	lost.sensorPose.x(std::nan(""));
	expectError([&] { calibrationFrom(options, &image, &lost); }, {"IMU", "pose", "not finite"});
}

TEST(CalibrationFrom, TheFirstObservationsOfARawlog)
{
	TempFolder folder;
	const std::string path = folder.file("test.rawlog");
	writeSecond(path);
	const AdapterOptions options;
	const Calibration c = readCalibration(path, options, true, true);
	EXPECT_EQ(c.camera.width_px(), 64);
	EXPECT_NEAR(c.T_OB.p.x(), 0.05, 1e-12);
	AdapterOptions other = options;
	other.cam_label = "LEFT";
	expectError([&] { readCalibration(path, other, true, true); },
	            {path, "no image", "LEFT", "labels here", "CAM (10 CObservationImage)", "cam_label"});
	EXPECT_NO_THROW(readCalibration(path, other, false, true));
	other.imu_label = "LMS100";
	expectError([&] { readCalibration(path, other, false, true); }, {path, "no IMU", "LMS100"});

	RawlogWriter writer(path);
	auto imu = makeImu(imuSample(kStart_ns), Pose3());
	imu.timestamp = INVALID_TIMESTAMP;
	for (int i = 0; i < 3; ++i) writer.write(imu);
	writer.close();
	expectError([&] { readCalibration(path, AdapterOptions(), false, true); }, {path, "none of the 3", "label IMU", "time stamp"});
	expectError([&] { readCalibration(folder.file("none.rawlog"), options, true, true); }, {"none.rawlog", "no such file"});
}
