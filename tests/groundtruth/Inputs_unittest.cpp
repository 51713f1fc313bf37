#include "ExpectError.h"
#include "InertialYaw.h"
#include "MapFiles.h"
#include "OdometryTrack.h"
#include "RangeNoise.h"
#include "RoomRun.h"
#include "ScanCloud.h"

#include <viwo/core/Scalars.h>
#include <viwo/evaluation/Consistency.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <random>

using namespace viwo;
using namespace viwo::gt;
using namespace viwo::testing;

namespace
{
constexpr int64_t kPeriod_ns = 50'000'000;

/** Readings at 20 Hz along an arc at 0.5 m/s, changed before they get into the track. */
OdometryTrack arcOf(int readings, const std::function<void(int, Pose2&)>& change)
{
	OdometryTrack track;
	Pose2 T;
	for (int i = 0; i < readings; ++i)
	{
		change(i, T);
		track.add((i + 1) * kPeriod_ns, T);
		T = T * Pose2(0.025, 0, 0.01);
	}
	track.clean();
	return track;
}

Pose2 stepAt(OdometryTrack& track, int i)
{
	const auto a = track.at(i * kPeriod_ns), b = track.at((i + 1) * kPeriod_ns);
	return a && b ? between(a->T, b->T) : Pose2(1e9, 0, 0);
}
}  // namespace

TEST(OdometryTrack, WhatIsPossibleIsLeftAsItIs)
{
	OdometryTrack track = arcOf(100, [](int i, Pose2& T) { T = i == 50 ? T * Pose2(0.25, 0, 0) : T; });
	EXPECT_EQ(track.jumps(), 0u);
	EXPECT_EQ(track.leftOut(), 0u);
	EXPECT_NEAR(stepAt(track, 50).p.x(), 0.275, 0.001) << "a push";
}

TEST(OdometryTrack, ALeapIsReplacedByConstantVelocity)
{
	OdometryTrack track = arcOf(100, [](int i, Pose2& T) { T = i == 40 ? Pose2() : i == 70 ? T * Pose2(0, 0, -2.5) : T; });
	EXPECT_EQ(track.jumps(), 2u);
	EXPECT_EQ(track.size(), 100u);
	EXPECT_NEAR(track.largestJump_rad(), 2.5, 0.02);
	for (int i = 1; i < 99; ++i)
	{
		const Pose2 step = stepAt(track, i);
		EXPECT_NEAR(step.p.x(), 0.025, 1e-9) << i;
		EXPECT_NEAR(step.yaw, 0.01, 1e-9) << i;
	}
	OdometryTrack again = arcOf(100, [](int i, Pose2& T) { T = i == 40 ? Pose2() : T; });
	EXPECT_EQ(again.at(40 * kPeriod_ns)->jumps, 0u);
	EXPECT_EQ(again.at(41 * kPeriod_ns)->jumps, 1u);
}

TEST(OdometryTrack, SingleWildReadingsAreTakenOut)
{
	OdometryTrack track;
	for (int i = 0; i < 100; ++i)
		track.add((i + 1) * kPeriod_ns, i == 30 || i == 31 || i == 60 ? Pose2(1e6, 2, 0) : Pose2(0.025 * i, 0, 0));
	track.add(200 * kPeriod_ns, Pose2(std::nan(""), 0, 0));
	track.add(201 * kPeriod_ns, Pose2(1e12, 0, 0));
	track.add(3 * kPeriod_ns, Pose2());
	track.clean();
	EXPECT_EQ(track.leftOut(), 6u);
	EXPECT_EQ(track.jumps(), 0u);
	EXPECT_NEAR(track.at(31 * kPeriod_ns)->T.p.x(), 0.75, 1e-9) << "between its neighbours";
}

TEST(OdometryTrack, NothingIsLeftOfNothingButLeaps)
{
	OdometryTrack track = arcOf(100, [](int i, Pose2& T) { T = Pose2(1e5 * (i % 7), 1e3 * (i % 5), i); });
	EXPECT_TRUE(track.useless());
	EXPECT_EQ(track.size(), 0u);
	EXPECT_FALSE(track.at(10 * kPeriod_ns).has_value());
}

TEST(RangeNoise, NoiseIsToldFromNoisySurfaces)
{
	std::mt19937 random(1);
	std::uniform_real_distribution<float> any(0.1f, 10);
	std::normal_distribution<float> normal;
	RoomLog log;
	std::vector<Scan> scans;
	for (int s = 0; s < 40; ++s)
	{
		Scan scan;
		scan.step_rad = M_PI / 180;
		for (int k = 0; k <= 180; ++k)
			scan.ranges_m.push_back(s % 4 == 3 ? any(random)
			                                   : log.range(RoomLog::poseAt(s), (k - 90) * M_PI / 180) +
			                                         (s % 4 == 2 ? 0.2f : 0.01f) * normal(random));
		scans.push_back(scan);
	}
	EXPECT_EQ(blankNoise(scans, rangeNoise_m(scans)), 10u);
	for (size_t s = 0; s < scans.size(); ++s) EXPECT_EQ(scans[s].ranges_m[90] == 0, s % 4 == 3) << s;
}

TEST(InertialYaw, WildRatesAreLeftOut)
{
	InertialYaw inertial;
	const double wild[] = {1e9, -1e6, std::nan(""), std::numeric_limits<double>::infinity()};
	std::vector<Scan> scans(60);
	for (int i = 0; i < 600; ++i)
	{
		ImuSample sample;
		sample.t_ns = (i + 1) * 10'000'000LL;
		sample.gyro_rad_s.z() = i % 100 == 7 ? wild[i / 100 % 4] : 0.5;
		inertial.add(makeImu(sample, Pose3()));
	}
	for (size_t s = 0; s < scans.size(); ++s)
	{
		scans[s].t_ns = static_cast<int64_t>(s + 1) * 95'000'000;
		scans[s].odometry = Pose2(0, 0, wrapped(0.5 * 0.095 * static_cast<double>(s)));
	}
	double bias_rad_s = 1;
	EXPECT_EQ(inertial.leftOut(), 6u);
	ASSERT_TRUE(inertial.integrate(scans, bias_rad_s));
	EXPECT_NEAR(bias_rad_s, 0, 1e-6);
}

TEST(MapFiles, AMapThatNoMemoryHoldsIsRefused)
{
	const TempFolder folder;
	Session session;
	std::vector<FinalPose> poses(2);
	poses[1].T = Pose2(40000, 30000, 0);
	expectError([&] { writeMaps(folder.path(), session, {}, poses, 0.05); }, {"4e+04 x 3e+04 m", "--resolution"});
}

/** Each beam from where the lidar is at the beam's own time, in front of a wall. */
TEST(ScanCloud, UndoesTheMotionOfTheSweep)
{
	const Twist2 twist{{0.8, 0.3}, 1.5};
	for (const double stamp_position : {0.0, 0.5, 1.0})
	{
		ScanOptions options;
		options.scan_duration_s = 0.1;
		options.stamp_position = stamp_position;
		Scan scan;
		scan.first_angle_rad = -0.5;
		scan.step_rad = 0.01;
		scan.T_OL = Pose3(Eigen::Quaterniond(Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ())), Eigen::Vector3d(0.2, 0.1, 0));
		const Pose2 T_OL(0.2, 0.1, 0.1);
		for (int k = 0; k <= 100; ++k)
		{
			const double dt_s = 0.1 * (k / 100.0 - stamp_position);
			const Pose2 T = Pose2(twist.v * dt_s, twist.w_rad_s * dt_s) * T_OL;
			scan.ranges_m.push_back(static_cast<float>((3 - T.p.x()) / std::cos(T.yaw + scan.first_angle_rad + 0.01 * k)));
		}
		double worst_m = 0, worst_skewed_m = 0;
		for (const OrientedPoint& point : scanCloud(scan, options, twist, 0.01)) worst_m = std::max(worst_m, std::abs(point.p.x() - 3));
		for (const OrientedPoint& point : scanCloud(scan, options, {}, 0.01))
			worst_skewed_m = std::max(worst_skewed_m, std::abs(point.p.x() - 3));
		std::cout << "[measured] off the wall by at most " << worst_m << " m, with the motion in it " << worst_skewed_m << " m\n";
		EXPECT_LT(worst_m, 1e-5);
		EXPECT_GT(worst_skewed_m, 0.05);
	}
}

/** What is masked may be anything: no file differs by a byte. */
TEST(GroundTruthInputs, MaskedBeamsAreIrrelevant)
{
	const TempFolder folder;
	const auto run = [&](const std::string& out, bool garbage)
	{
		std::mt19937 random(5);
		std::uniform_real_distribution<float> near(0.01f, 0.29f), usual(0.3f, 5.9f), far(6.1f, 29);
		RoomLog log;
		log.scans = 150;
		log.disturb = [&](int, std::vector<float>& r, Pose2&)
		{
			for (size_t k = 0; k < r.size(); ++k)
			{
				const bool masked = k < 30 || k > 140;
				const float wild = masked ? usual(random) : k % 9 == 0 ? near(random) : far(random);
				const bool out_of_limits = r[k] > 6 || k % 9 == 0;
				if (masked || out_of_limits) r[k] = garbage ? wild : masked ? 1.f : 0.f;
			}
		};
		log.write(folder.file("x.rawlog"));
		GroundTruthRunOptions options = optionsFor(folder, out);
		options.options.scan.first_angle_deg = -60.5;
		options.options.scan.last_angle_deg = 50.5;
		options.options.scan.min_range_m = 0.3;
		options.options.scan.max_range_m = 6;
		const GroundTruthRunResult result = runGroundTruth(options);
		EXPECT_LT(errorsOf(folder, log, out).rms_m, 0.06);
		EXPECT_GT(result.key_scans, 20u);
	};
	run("plain", false);
	run("garbage", true);
	for (const char* name :
	     {"trajectory.tum", "trajectory_covariance.csv", "graph.g2o", "map.pgm", "map.gridmap.gz", "map.simplemap", "map.png"})
		EXPECT_TRUE(readFile(folder.file(std::string("plain/") + name)) == readFile(folder.file(std::string("garbage/") + name))) << name;
}

/** Odometry that knows nothing of turns: the gyroscope leads, and its bias is found. */
TEST(GroundTruthInputs, TheGyroscopeTellsTurns)
{
	const TempFolder folder;
	RoomLog log;
	log.scans = 300;
	log.turn_scale = 0.3;
	log.gyro_bias_rad_s = 0.02;
	log.write(folder.file("x.rawlog"));
	runGroundTruth(optionsFor(folder));
	GroundTruthRunOptions options = optionsFor(folder, "without");
	options.options.odometry.use_imu = false;
	runGroundTruth(options);
	const auto with = nlohmann::json::parse(readFile(folder.file("out/summary.json")));
	const auto without = nlohmann::json::parse(readFile(folder.file("without/summary.json")));
	const double bias = with["odometry"]["gyro_bias_rad_s"];
	std::cout << "[measured] bias " << bias << ", searches " << with["window_searches"] << ", without the gyroscope "
	          << without["window_searches"] << ", rms " << errorsOf(folder, log).rms_m << " m, " << errorsOf(folder, log, "without").rms_m
	          << " m, turn scale " << with["odometry"]["turn_scale"] << "\n";
	EXPECT_EQ(with["guess"], "odometry, yaw by gyroscope");
	EXPECT_EQ(without["guess"], "odometry");
	EXPECT_NEAR(bias, 0.02, 1e-3);
	EXPECT_LT(errorsOf(folder, log).rms_m, 0.05);
	EXPECT_NEAR(with["odometry"]["turn_scale"].get<double>(), 1 / 0.3, 0.05);
}

/** Most beams see nothing, or a hood that goes along, which should have been masked: `good` keeps its meaning. */
TEST(GroundTruthInputs, GoodIsGoodWithBlockedBeamsToo)
{
	struct Block
	{
		const char* name;
		float range_m;
		size_t first, last;
	};
	for (const Block& block : {Block{"four fifths see nothing", 0, 20, 165}, Block{"a third sees a hood", 0.3f, 100, 160},
	                           Block{"half sees a hood", 0.3f, 60, 150}})
	{
		const TempFolder folder;
		RoomLog log;
		log.scans = 300;
		log.start_m = 20;
		log.disturb = [&](int i, std::vector<float>& r, Pose2&)
		{
			if (i >= 100 && i < 250)
				std::fill(r.begin() + static_cast<long>(block.first), r.begin() + static_cast<long>(block.last), block.range_m);
		};
		log.write(folder.file("x.rawlog"));
		const GroundTruthRunResult result = runGroundTruth(optionsFor(folder));
		const RoomErrors e = errorsOf(folder, log);
		const size_t told = static_cast<size_t>(std::count_if(result.notes.begin(), result.notes.end(),
		                                                      [](const std::string& note)
		                                                      { return note.find("parts of the robot") != std::string::npos; }));
		EXPECT_EQ(told, block.range_m > 0 ? 1u : 0u) << block.name;
		size_t good = 0, near = 0, blocked = 0;
		const auto covariances = loadCovariances(folder.file("out/trajectory_covariance.csv"));
		const Trajectory trajectory = Trajectory::loadTum(folder.file("out/trajectory.tum"));
		const StampedPose& first = trajectory.poses()[0];
		for (size_t i = 0; i < trajectory.size(); ++i)
		{
			if (covariances[i].flag != "good") continue;
			const StampedPose& pose = trajectory.poses()[i];
			const Pose2 estimate = between(pose2(first.T), pose2(pose.T));
			++good;
			blocked += i >= 100 && i < 250;
			near += (estimate.p - between(log.truth.at(first.t_ns), log.truth.at(pose.t_ns)).p).norm() < 0.05;
		}
		std::cout << "[measured] " << block.name << ": rms " << e.rms_m << " m, " << good << " good, " << blocked << " of them blocked, "
		          << near << " within 0.05 m\n";
		EXPECT_GE(20 * near, 19 * good) << block.name;
		if (block.range_m == 0)
		{
			EXPECT_LT(e.rms_m, 0.15) << block.name;
		}
	}
}
