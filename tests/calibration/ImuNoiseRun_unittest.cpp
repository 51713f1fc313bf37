#include "ExpectError.h"
#include "StandingLog.h"
#include "TempFolder.h"

#include <viwo/calibration/ImuNoiseReport.h>
#include <viwo/calibration/ImuNoiseRun.h>
#include <viwo/sim/ImuModel.h>
#include <viwo/sim/Motion.h>

#include <iostream>

namespace viwo::testing
{
namespace
{
ImuNoiseResult estimate(const std::string& path)
{
	ImuNoiseOptions options;
	options.rawlogs = {path};
	return estimateImuNoise(options);
}

bool warns(const ImuNoiseResult& result, const std::string& of)
{
	for (const std::string& warning : result.warnings)
		if (warning.find(of) != std::string::npos) return true;
	return false;
}

/** What a warning-free log must not lead to. */
std::string all(const ImuNoiseResult& result)
{
	std::string text;
	for (const std::string& warning : result.warnings) text += warning + "\n";
	return text;
}

ImuNoiseResult of(const ImuRecord& record, const std::function<void(RawlogWriter&, size_t)>& beside = {})
{
	const TempFolder folder;
	writeStandingLog(folder.file("x.rawlog"), record, beside);
	return estimate(folder.file("x.rawlog"));
}

TEST(ImuNoiseRun, ASimulatedImuAtRestHasTheDensitiesOfItsRig)
{
	sim::Route route;
	route.segments = "stand 900 s";
	const sim::Motion motion(route);
	const sim::ImuOptions truth;  // all of its errors: quantised, misaligned, biased
	const sim::ImuModel model(motion, truth, 5);
	ImuRecord record;
	for (const ImuSample& s : model.samples())
	{
		record.t_ns.push_back(s.t_ns);
		for (size_t k = 0; k < 3; ++k)
		{
			record.axes[k].push_back(s.acc_m_s2[static_cast<Eigen::Index>(k)]);
			record.axes[k + 3].push_back(s.gyro_rad_s[static_cast<Eigen::Index>(k)]);
		}
	}
	const EvenImu imu = evenlySampled(std::move(record));
	for (size_t axis = 0; axis < kImuAxes; ++axis)
	{
		const NoiseModel m = fitNoise(allanCurve(imu.axes[axis], imu.interval_s));
		const double N = axis < 3 ? truth.acc_noise_m_s2_sqrtHz : truth.gyro_noise_rad_s_sqrtHz;
		const double K = axis < 3 ? truth.acc_walk_m_s3_sqrtHz : truth.gyro_walk_rad_s2_sqrtHz;
		std::cout << "[measured] " << imuAxisName(axis) << ": N/truth " << m.white.value / N << " ("
		          << (m.white.value - N) / m.white.deviation << " deviations), K/truth " << m.walk.value / K << " ("
		          << (m.walk.value - K) / m.walk.deviation << ")\n";
		EXPECT_NEAR(m.white.value, N, 3 * m.white.deviation + 0.002 * N);
		EXPECT_GT(m.walk.limit, K);
		if (m.walk.observed)
		{
			EXPECT_NEAR(m.walk.value, K, 3 * m.walk.deviation);
		}
	}
}

TEST(ImuNoiseRun, ALogAtRestGivesTheLargestAxesAndNoWarning)
{
	StandingImu imu;
	imu.length_s = 650;
	imu.rate_hz = 50;
	ImuRecord record = imu.record();
	for (double& x : record.axes[4]) x *= 2;
	const ImuNoiseResult r = of(record);
	EXPECT_EQ(all(r), "");
	EXPECT_EQ(r.gyro_noise.axis, 4u);
	EXPECT_NEAR(r.gyro_noise.reading.value, 4e-4, 3 * r.gyro_noise.reading.deviation);
	EXPECT_NEAR(r.acc_noise.reading.value, 2e-3, 4 * r.acc_noise.reading.deviation);
	EXPECT_FALSE(r.acc_walk.reading.observed);
	const RigImu rig = r.rig();
	EXPECT_EQ(rig.mounting.x_m, 0.1);
	EXPECT_EQ(rig.acc_walk_m_s3_sqrtHz, 0);
	EXPECT_NE(describeImuNoise(r).find("acc_walk_m_s3_sqrtHz: not observed: log of 11 min"), std::string::npos) << describeImuNoise(r);
}

TEST(ImuNoiseRun, KnocksAndDrivesAreToldAndLeftOut)
{
	ImuRecord record = StandingImu().record();
	for (size_t i = 5000; i < 5050; ++i) record.axes[0][i] += i % 2 == 0 ? 3 : -3;  // 50.0 s
	const auto odometry = [&](RawlogWriter& writer, size_t i)
	{
		if (i % 10 != 0) return;
		const bool driving = i >= 8000 && i < 8300;
		writer.write(makeOdometry(record.t_ns[i], {driving ? 0.2 : 0.0, 0}, {}, driving ? 0.002 * static_cast<double>(i - 8000) : 0.0));
	};
	for (size_t i = 8000; i < 8300; ++i) record.axes[5][i] += 0.002 * static_cast<double>(i - 8000);
	const ImuNoiseResult r = of(record, odometry);
	EXPECT_TRUE(warns(r, "knocked or moved at 50.0-51.0 s: left out")) << all(r);
	EXPECT_TRUE(warns(r, "the wheels turn at 7")) << all(r);
	EXPECT_NEAR(r.acc_noise.reading.value, 2e-3, 4 * r.acc_noise.reading.deviation);
	EXPECT_NEAR(r.gyro_noise.reading.value, 2e-4, 4 * r.gyro_noise.reading.deviation);
}

TEST(ImuNoiseRun, StepsDriftsUnitsAndRepeatsAreTold)
{
	StandingImu imu;
	imu.length_s = 300;
	ImuRecord stepped = imu.record();
	for (size_t i = 15000; i < stepped.t_ns.size(); ++i) stepped.axes[3][i] += 0.002;
	const ImuNoiseResult step = of(stepped);
	EXPECT_TRUE(warns(step, "gyro x steps by 0.00")) << all(step);
	EXPECT_TRUE(warns(step, "at 150.0 s")) << all(step);

	ImuRecord warming = imu.record();
	for (size_t i = 0; i < warming.t_ns.size(); ++i) warming.axes[2][i] += 2e-6 * static_cast<double>(i);
	const ImuNoiseResult drift = of(warming);
	EXPECT_TRUE(warns(drift, "acc z drifts by 0.05")) << all(drift);
	EXPECT_FALSE(warns(drift, "steps")) << all(drift);

	ImuRecord in_g = imu.record();
	for (size_t axis = 0; axis < 3; ++axis)
		for (double& x : in_g.axes[axis]) x /= 9.81;
	EXPECT_TRUE(warns(of(in_g), "another unit"));

	ImuRecord twice = imu.record();
	for (auto& axis : twice.axes)
		for (size_t i = 1; i < axis.size(); i += 2) axis[i] = axis[i - 1];
	EXPECT_TRUE(warns(of(twice), "50 % of the samples repeat"));
}

TEST(ImuNoiseRun, AnAxisThatIsNotMeasuredIsLeftOut)
{
	ImuRecord planar = StandingImu().record();
	for (const size_t axis : {3u, 4u}) std::fill(planar.axes[axis].begin(), planar.axes[axis].end(), 0.0);
	const ImuNoiseResult r = of(planar);
	EXPECT_TRUE(warns(r, "gyro x is left out")) << all(r);
	EXPECT_EQ(r.gyro_noise.axis, 5u);
	for (const size_t axis : {5u}) std::fill(planar.axes[axis].begin(), planar.axes[axis].end(), 0.0);
	expectError([&] { of(planar); }, {"no white noise", "rates"});
}

TEST(ImuNoiseRun, LostSamplesAndJitterAreToldAndHarmless)
{
	StandingImu imu;
	imu.length_s = 200;
	ImuRecord whole = imu.record(), record;
	std::mt19937_64 generator(4);
	std::uniform_real_distribution<double> draw(0, 1);
	for (size_t i = 0; i < whole.t_ns.size(); ++i)
	{
		if (draw(generator) < 0.02 || (i > 9000 && i < 10000)) continue;
		record.t_ns.push_back(whole.t_ns[i] + nanoseconds(0.004 * draw(generator)));
		for (size_t axis = 0; axis < kImuAxes; ++axis) record.axes[axis].push_back(whole.axes[axis][i]);
	}
	const ImuNoiseResult r = of(record);
	EXPECT_TRUE(warns(r, "samples are missing, the longest gap is 10.0")) << all(r);
	EXPECT_TRUE(warns(r, "stamps jitter")) << all(r);
	EXPECT_NEAR(r.rate_hz, 100, 0.05);
	EXPECT_NEAR(r.acc_noise.reading.value, 2e-3, 4 * r.acc_noise.reading.deviation);
}

TEST(ImuNoiseRun, BadInputsAreErrorsInOneLine)
{
	const TempFolder folder;
	StandingImu imu;
	imu.length_s = 10;
	writeStandingLog(folder.file("short.rawlog"), imu.record());
	expectError([&] { estimate(folder.file("short.rawlog")); },
	            {"short.rawlog", "10.0 s of 1000 IMU samples", "30 s show the white noise"});
	expectError([&] { estimate(folder.file("none.rawlog")); }, {"none.rawlog"});
	ImuNoiseOptions options;
	options.rawlogs = {folder.file("short.rawlog")};
	options.imu_label = "XSENS";
	expectError([&] { estimateImuNoise(options); }, {"under label XSENS", "IMUs here: IMU (1000)", "--imu-label"});
	options.imu_label = "IMU";
	options.from_s = 9.999;
	expectError([&] { estimateImuNoise(options); }, {"usable IMU samples between --from and --to"});

	ImuRecord driving = StandingImu().record();
	const auto odometry = [&](RawlogWriter& writer, size_t i)
	{
		if (i % 10 == 0) writer.write(makeOdometry(driving.t_ns[i], {i < 9000 ? 0.2 : 0.0, 0}));
	};
	expectError([&] { of(driving, odometry); }, {"not at rest for 7", "--from and --to"});

	RawlogWriter writer(folder.file("wheels.rawlog"));
	writer.write(makeOdometry(kStandingStart_ns, {0, 0}));
	writer.close();
	expectError([&] { estimate(folder.file("wheels.rawlog")); }, {"no IMU", "ODOMETRY (1 CObservationOdometry)"});
}
}  // namespace
}  // namespace viwo::testing
