#include <WheelGates.h>

#include <ImuPreintegration.h>
#include <SimulatedDrive.h>
#include <WheelPreintegration.h>
#include <Window.h>
#include <gtest/gtest.h>

namespace viwo
{
namespace
{
using test::Drive;
using test::DriveResult;
using test::DriveSetup;
using test::errorsOf;
using test::measured;
using test::optionsOf;
using test::runDrive;

TEST(SlipGate, SilentOnCleanDrives)
{
	int events = 0, drives = 0;
	const std::vector<std::string> routes{"straight 1.5 m", "arc 1 m 90 deg", "rotate 100 deg", "free 11 s"};
	for (const std::string& route : routes)
		for (int seed = 1; seed <= test::seedsOf(4); ++seed, ++drives)
			events += runDrive(DriveSetup(route, seed), optionsOf(Mode::wio)).counters.slip_events;
	for (size_t i = 0; i < routes.size(); ++i, ++drives)
		events += runDrive(DriveSetup(routes[i], 11 + i), optionsOf(Mode::viwo)).counters.slip_events;
	measured("slips seen on " + std::to_string(drives) + " clean drives", events, "");
	EXPECT_EQ(events, 0);
}

struct Burst
{
	std::string name;
	std::vector<double> slips;
	int bursts;
};

TEST(SlipGate, EveryBurstIsOneEvent)
{
	const std::vector<Burst> bursts{{"one wheel 30 %", {4, 2, 0.3, 0}, 1},
	                                {"two bursts", {3, 1, 0.3, 0, 6, 1, 0.3, 1}, 2},
	                                {"both wheels spin at twice the speed", {4, 2, 1, 0, 4, 2, 1, 1}, 1}};
	for (const std::string& route : {std::string("straight 1.2 m"), std::string("arc 1 m 70 deg")})
		for (const Burst& burst : bursts)
			for (const Mode mode : {Mode::wio, Mode::viwo})
			{
				DriveSetup setup(route, 3);
				const double clean_m = errorsOf(Drive(setup), runDrive(setup, optionsOf(mode))).ate_xyz_m;
				setup.wheels.slips = burst.slips;
				const Drive drive(setup);
				const DriveResult result = runDrive(drive, optionsOf(mode));
				const TrajectoryErrors errors = errorsOf(drive, result);
				measured(modeNames()[static_cast<size_t>(mode)] + ", " + route + ", " + burst.name + ": ATE", 1e3 * errors.ate_xyz_m,
				         "mm (clean " + std::to_string(1e3 * clean_m) + "), events " + std::to_string(result.counters.slip_events));
				EXPECT_EQ(result.counters.slip_events, burst.bursts) << route << ", " << burst.name;
				if (mode == Mode::viwo)
				{
					EXPECT_LT(errors.ate_xyz_m, 1.3 * clean_m + 0.02) << route << ", " << burst.name;
				}
			}
}

/** A slip that goes on is found again in an interval that is in part inflated already: what was merged into it later must not be left out.
 */
TEST(SlipGate, MergedIntervalsAreInflatedPartByPart)
{
	const WheelIntrinsics k;
	const WheelNoise noise;
	const WheelSegment segment{0.1, 0.2, 0.15};
	const auto one = [&]
	{
		auto interval = std::make_shared<WheelPreintegration>(noise, k);
		interval->integrate(segment);
		return interval;
	};
	Window window(optionsOf(Mode::viwo), Drive(DriveSetup::perfect("stand 0.2 s")).calibration);
	for (int i = 0; i < 2; ++i)
	{
		window.frames.push_back(std::make_unique<Frame>());
		window.frames.back()->t_ns = i * 100'000'000;
	}
	window.latest().interval.wheels = one();
	distrustWheels(window, 0.1);
	WheelPreintegration expected = *window.latest().interval.wheels;
	const WheelPreintegration inflated = expected;
	distrustWheels(window, 0.1);
	EXPECT_EQ(window.latest().interval.wheels->covariance(), inflated.covariance()) << "only once";

	window.latest().interval.wheels->append(*one());
	expected.append(inflated);
	const double partly = window.latest().interval.wheels->covariance()(5, 5);
	distrustWheels(window, 0.1);
	const auto& both = window.latest().interval.wheels->covariance();
	measured("yaw variance of a half and of a wholly inflated interval", partly, "and " + std::to_string(both(5, 5)) + " rad^2");
	EXPECT_LT((both - expected.covariance()).norm(), 1e-9 * both.norm());
	EXPECT_GT(both(5, 5), 1.9 * partly);
}

TEST(SlipGate, SwitchedOffSeesNothing)
{
	DriveSetup setup("straight 1 m");
	setup.wheels.slips = {3, 2, 0.3, 0};
	EstimatorOptions options = optionsOf(Mode::wio);
	options.factors.slip_gate = false;
	EXPECT_EQ(runDrive(setup, options).counters.slip_events, 0);
}

/** Share of the frames taken for standing among those that `are` says. */
template <class Predicate>
double standingShare(const Drive& drive, const DriveResult& result, const Predicate& are)
{
	int all = 0, standing = 0;
	for (const FrameEstimate& e : result.estimates)
	{
		if (!e.has_pose || !are(drive.secondsOf(e.t_ns), drive.motion.at_ns(e.t_ns))) continue;
		++all;
		standing += e.standing;
	}
	return all > 0 ? static_cast<double>(standing) / all : -1;
}

/** The simulated tracks have 0.3 px in each coordinate of each image, in the differences and with a margin: */
constexpr double kSyntheticTracks_px = 0.7;

TEST(Standstill, StandsAndDoesNotDrift)
{
	for (const Mode mode : {Mode::wio, Mode::viwo})
	{
		const Drive drive(DriveSetup("straight 0.4 m, stand 20 s, straight 0.4 m"));
		EstimatorOptions options = optionsOf(mode);
		options.noise.start_pixel_sigma_px = kSyntheticTracks_px;
		double begin_s = -1, end_s = 0;
		for (const FeatureFrame& f : drive.frames)
			if (const double t_s = drive.secondsOf(f.t_ns); t_s > 1 && drive.motion.at(t_s).v_WO.norm() < 1e-9)
			{
				if (begin_s < 0) begin_s = t_s;
				if (t_s - begin_s < 20.1) end_s = t_s;
			}
		const DriveResult result = runDrive(drive, options);
		const double share = standingShare(drive, result, [&](double t_s, const auto&) { return t_s > begin_s + 1 && t_s < end_s - 0.1; });
		const double while_driving = standingShare(drive, result, [](double, const auto& truth) { return truth.v_WO.norm() > 0.05; });
		const auto at = [&](double t_s) { return *result.trajectory.at(drive.motion.stamp_ns(t_s), 0.5); };
		const Pose3 moved = at(begin_s + 2).inverse() * at(end_s - 0.1);
		const std::string name = modeNames()[static_cast<size_t>(mode)];
		measured(
		    name + " while standing: moved", 1e3 * moved.p.norm(),
		    "mm, turned " + std::to_string(yawOf(moved.R) * 180 / M_PI) + " deg, taken for standing " + std::to_string(100 * share) + " %");
		EXPECT_LT(moved.p.norm(), 0.003);
		EXPECT_LT(std::abs(yawOf(moved.R)) * 180 / M_PI, 0.1);
		EXPECT_GT(share, 0.95);
		EXPECT_EQ(while_driving, 0);
		EXPECT_EQ(result.counters.standstills, 1);
		EXPECT_EQ(result.counters.slip_events, 0);
	}
}

/** Without the factor, standing is told but changes nothing: neither a factor nor the trust in the wheels. */
TEST(Standstill, SwitchedOffChangesNothing)
{
	const DriveSetup setup("straight 0.2 m, stand 4 s");
	EstimatorOptions off = optionsOf(Mode::wio);
	off.factors.standstill_factor = false;
	off.noise.start_pixel_sigma_px = kSyntheticTracks_px;
	const DriveResult told = runDrive(setup, off);
	EXPECT_EQ(told.counters.standstills, 1);
	Drive moving(setup);
	// A gyro peak that is too short to matter keeps the gate from ever seeing a standstill.
	for (size_t i = 0; i < moving.imu.size(); i += 2) moving.imu[i].gyro_rad_s.x() += 0.1;
	for (size_t i = 1; i < moving.imu.size(); i += 2) moving.imu[i].gyro_rad_s.x() -= 0.1;
	const DriveResult untold = runDrive(moving, off);
	EXPECT_EQ(untold.counters.standstills, 0);
	const auto yawSigma = [](const DriveResult& r) { return std::sqrt(r.estimates.back().covariance(5, 5)); };
	measured("yaw deviation after standing, told", 1e3 * yawSigma(told), "mrad; untold: " + std::to_string(1e3 * yawSigma(untold)));
	EXPECT_NEAR(yawSigma(told) / yawSigma(untold), 1, 0.02);
}

/** The robot stands, is pushed or turned with locked wheels, and stands again. */
TEST(Standstill, PushedWithLockedWheels)
{
	struct Push
	{
		std::string name, route;
		double speed_m_s, yaw_rate_rad_s, limit;
	};
	for (const Push& push :
	     {Push{"0.3 m/s", "stand 3 s, straight 0.6 m", 0.3, 0.15, 0.01}, Push{"0.1 m/s", "stand 3 s, straight 0.3 m", 0.1, 0.15, 0.1},
	      Push{"0.05 m/s", "stand 3 s, straight 0.2 m", 0.05, 0.15, 0.25}, Push{"0.05 rad/s", "stand 3 s, rotate 15 deg", 0.15, 0.05, 0.05},
	      Push{"0.02 rad/s", "stand 3 s, rotate 6 deg", 0.15, 0.02, 0.1}})
	{
		DriveSetup setup(push.route);
		setup.route.speed_m_s = push.speed_m_s;
		setup.route.yaw_rate_rad_s = push.yaw_rate_rad_s;
		Drive drive(setup);
		for (WheelSample& s : drive.wheels) s.v_left_m_s = s.v_right_m_s = 0;
		const DriveResult result = runDrive(drive, optionsOf(Mode::viwo));
		const double share =
		    standingShare(drive, result,
		                  [&](double, const auto& truth)
		                  { return truth.v_WO.norm() > 0.8 * push.speed_m_s || std::abs(truth.w_O.z()) > 0.8 * push.yaw_rate_rad_s; });
		measured("pushed at " + push.name + ": taken for standing", 100 * share,
		         "%, slip events " + std::to_string(result.counters.slip_events));
		EXPECT_GE(share, 0) << push.name;
		EXPECT_LT(share, push.limit) << push.name;
		EXPECT_TRUE(result.finite());
		EXPECT_EQ(result.counters.reinitializations, 0);
	}
}
}  // namespace
}  // namespace viwo
