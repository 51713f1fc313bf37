#include <WindowUpdate.h>

#include <viwo/core/So3.h>

#include <ImuPreintegration.h>
#include <IntervalFactory.h>
#include <NumericJacobian.h>
#include <SlidingRun.h>
#include <WheelPreintegration.h>
#include <WheelStart.h>
#include <WindowSolver.h>
#include <gtest/gtest.h>
#include <residuals/BlockAlgebra.h>
#include <residuals/StatePrior.h>

#include <map>
#include <set>

namespace viwo
{
namespace
{
using test::Drive;
using test::DriveSetup;
using test::measured;
using test::optionsOf;
using test::SlidingRun;

/** No factor, sighting or prior speaks of a state that is not in the window. */
void expectNothingDangles(Window& window)
{
	std::set<const double*> known{window.T_BC.data(), window.wheels.data(), window.plane().data()};
	std::set<const Frame*> frames;
	for (const auto& f : window.frames)
	{
		known.insert(f->pose.data());
		known.insert(f->motion.data());
		frames.insert(f.get());
	}
	for (const auto& [id, l] : window.landmarks.all())
	{
		known.insert(&l.inverse_depth_1_m);
		for (const Sighting& s : l.sightings) EXPECT_EQ(frames.count(s.frame), 1u);
	}
	for (const Factor& f : collectFactors(window))
		for (const double* block : f.blocks) EXPECT_EQ(known.count(block), 1u);
	for (const double* block : window.prior_blocks) EXPECT_EQ(known.count(block), 1u);
}

EstimatorOptions smallWindow(Mode mode, int keyframes)
{
	EstimatorOptions options = optionsOf(mode);
	options.window.keyframes = keyframes;
	options.window.keyframe_parallax_px = 4;
	return options;
}

TEST(WindowUpdate, FillsWithKeyframesThenTheOldestLeaves)
{
	DriveSetup setup("straight 1.2 m");
	setup.route.speed_m_s = 0.3;
	SlidingRun run(setup, smallWindow(Mode::viwo, 5));
	std::map<Fate, int> fates;
	for (const FeatureFrame& f : run.drive.frames)
	{
		const Fate fate = run.step(f);
		++fates[fate];
		EXPECT_LE(run.window.frames.size(), 6u);
		if (fate == Fate::kept_oldest_marginalized)
		{
			EXPECT_NE(run.window.prior, nullptr);
			EXPECT_FALSE(run.window.frames.front()->interval.imu || run.window.frames.front()->interval.wheels);
		}
		EXPECT_EQ(fate == Fate::merged,
		          run.window.frames.size() > 1 && run.window.frames[run.window.frames.size() - 2]->id != run.window.latest().id - 1);
		for (size_t i = 1; i < run.window.frames.size(); ++i)
		{
			const Frame &a = *run.window.frames[i - 1], &b = *run.window.frames[i];
			ASSERT_TRUE(b.interval.imu && b.interval.wheels);
			EXPECT_NEAR(b.interval.imu->dt_s(), secondsBetween(a.t_ns, b.t_ns), 1e-9);
			EXPECT_NEAR(b.interval.wheels->dt_s(), secondsBetween(a.t_ns, b.t_ns), 1e-9);
		}
		expectNothingDangles(run.window);
	}
	std::cout << "[measured] growing " << fates[Fate::kept_growing] << ", oldest marginalised " << fates[Fate::kept_oldest_marginalized]
	          << ", merged " << fates[Fate::merged] << ", timed " << fates[Fate::kept_timed] << "\n";
	EXPECT_GT(fates[Fate::kept_oldest_marginalized], 3);
	EXPECT_GT(fates[Fate::merged], 3);
	EXPECT_EQ(fates[Fate::kept_timed], 0);
}

TEST(WindowUpdate, ExactDataStayExact)
{
	DriveSetup setup = DriveSetup::perfect("straight 0.5 m, rotate 30 deg, straight 0.4 m");
	setup.route.speed_m_s = 0.3;
	SlidingRun run(setup, smallWindow(Mode::viwo, 5));
	double worst_m = 0, worst_rad = 0;
	for (size_t i = 0; i < run.drive.frames.size(); ++i)
	{
		run.step(run.drive.frames[i], i == 0 ? 0 : 2e-3);
		const NavState state = run.window.latest().state(), truth = run.truthAt(state.t_ns);
		if (i < 8) continue;
		worst_m = std::max(worst_m, (state.T_WB.p - truth.T_WB.p).norm());
		worst_rad = std::max(worst_rad, so3::log(state.T_WB.R.conjugate() * truth.T_WB.R).norm());
	}
	measured("worst position on exact data, states disturbed by 2 mm and 2 mrad", 1e3 * worst_m, "mm");
	measured("  rotation", 1e3 * worst_rad, "mrad");
	EXPECT_LT(worst_m, 3e-4);
	EXPECT_LT(worst_rad, 3e-4);
}

/** Sensor errors small enough for first-order models; the noise that the estimator reckons with stays. */
DriveSetup nearlyExact(const std::string& route)
{
	DriveSetup setup(route);
	constexpr double kShare = 0.1;
	auto& i = setup.imu;
	auto& w = setup.wheels;
	for (double* error :
	     {&i.acc_noise_m_s2_sqrtHz, &i.gyro_noise_rad_s_sqrtHz, &i.acc_walk_m_s3_sqrtHz, &i.gyro_walk_rad_s2_sqrtHz, &i.acc_start_bias_m_s2,
	      &i.gyro_start_bias_rad_s, &i.acc_scale_error, &i.gyro_scale_error, &i.axis_misalignment_deg, &i.acc_resolution_m_s2,
	      &i.gyro_resolution_rad_s, &w.radius_error, &w.left_right_difference, &w.track_error, &w.noise_m_s_sqrtHz,
	      &w.noise_per_speed_sqrtHz, &setup.floor.height_rms_mm, &setup.vibration.acceleration_m_s2, &setup.vibration.rate_deg_s})
		*error *= kShare;
	w.tick_quantisation = false;
	return setup;
}

/** Merging and marginalising lose nothing: the sliding window ends where a batch of all its kept frames ends. */
TEST(WindowUpdate, SlidingAgreesWithBatch)
{
	const DriveSetup setup = nearlyExact("arc 0.8 m 60 deg");
	EstimatorOptions options = smallWindow(Mode::wio, 4);
	options.factors.plane_factor = false;
	SlidingRun sliding(setup, options);
	std::vector<int64_t> kept_ns;
	for (const FeatureFrame& f : sliding.drive.frames)
	{
		sliding.step(f, 0, 10);
		for (const auto& frame : sliding.window.frames)
			if (frame->keyframe && (kept_ns.empty() || frame->t_ns > kept_ns.back())) kept_ns.push_back(frame->t_ns);
	}
	if (kept_ns.back() != sliding.window.latest().t_ns) kept_ns.push_back(sliding.window.latest().t_ns);
	ASSERT_GT(kept_ns.size(), 8u);

	options.window.keyframes = 40;
	SlidingRun batch(setup, options);
	for (const int64_t t_ns : kept_ns)
	{
		FeatureFrame f;
		f.t_ns = t_ns;
		batch.push(f);
		if (batch.window.frames.size() == 1) addStartPriors(batch.window, batch.window.latest(), 0.1);
	}
	for (int i = 0; i < 60; ++i) solveWindow(batch.window, 50);
	for (int i = 0; i < 60; ++i) solveWindow(sliding.window, 50);

	const NavState a = sliding.window.latest().state(), b = batch.window.latest().state(), truth = batch.truthAt(kept_ns.back());
	Eigen::Matrix<double, 15, 15> covariance_sliding, covariance_batch;
	ASSERT_TRUE(latestCovariance(sliding.window, covariance_sliding));
	ASSERT_TRUE(latestCovariance(batch.window, covariance_batch));
	const double difference_m = (a.T_WB.p - b.T_WB.p).norm(), error_m = (b.T_WB.p - truth.T_WB.p).norm();
	const double difference_rad = so3::log(a.T_WB.R.conjugate() * b.T_WB.R).norm();
	measured("sliding window against batch of " + std::to_string(kept_ns.size()) + " frames", 1e3 * difference_m,
	         "mm, " + std::to_string(1e3 * difference_rad) + " mrad; their error " + std::to_string(1e3 * error_m) + " mm");
	measured("  covariance", (covariance_sliding - covariance_batch).norm() / covariance_batch.norm(), "relative");
	EXPECT_LT(difference_m, 0.02 * std::sqrt(covariance_batch.topLeftCorner<2, 2>().trace()));
	EXPECT_LT(difference_rad, 0.02 * std::sqrt(covariance_batch(5, 5)));
	for (int i = 0; i < 15; ++i) EXPECT_NEAR(std::sqrt(covariance_sliding(i, i) / covariance_batch(i, i)), 1, 0.05) << "entry " << i;
}

TEST(WindowUpdate, MergingJoinsIntervalsAndLeavesNoState)
{
	SlidingRun run(DriveSetup("straight 1 m"), smallWindow(Mode::viwo, 5));
	int merged = 0;
	for (const FeatureFrame& f : run.drive.frames)
	{
		if (run.window.frames.size() < 2)
		{
			run.step(f);
			continue;
		}
		run.push(f);
		run.window.landmarks.triangulate(run.window.T_BC_pose());
		const Frame* const candidate = run.window.frames[run.window.frames.size() - 2].get();
		const double *pose = candidate->pose.data(), *motion = candidate->motion.data();
		const int64_t begin_ns = run.window.frames[run.window.frames.size() - 3 + (run.window.frames.size() < 3)]->t_ns;
		if (advanceWindow(run.window) != Fate::merged) continue;
		++merged;
		for (const double* block : run.window.prior_blocks) EXPECT_TRUE(block != pose && block != motion);
		for (const Factor& factor : run.window.start_priors)
			for (const double* block : factor.blocks) EXPECT_TRUE(block != pose && block != motion);
		const Interval whole = run.between(begin_ns, run.window.latest().t_ns);
		const Interval& joined = run.window.latest().interval;
		EXPECT_LT((joined.imu->delta().alpha - whole.imu->delta().alpha).norm(), 1e-5);
		EXPECT_LT((joined.imu->delta().beta - whole.imu->delta().beta).norm(), 1e-4);
		EXPECT_LT((joined.wheels->dp() - whole.wheels->dp()).norm(), 1e-9);
		expectNothingDangles(run.window);
	}
	EXPECT_GT(merged, 20);
}

/** A frame that is dropped although the prior knows it is eliminated from the prior. */
TEST(WindowUpdate, DroppedFrameLeavesThePrior)
{
	DriveSetup setup("straight 1.5 m");
	setup.route.speed_m_s = 0.3;
	SlidingRun run(setup, smallWindow(Mode::viwo, 4));
	size_t i = 0;
	while (!run.window.prior && i < run.drive.frames.size()) run.step(run.drive.frames[i++]);
	ASSERT_TRUE(run.window.prior);
	// The marginalised landmarks were seen by the latest frame too: the prior holds its pose.
	const double* const pose = run.window.latest().pose.data();
	ASSERT_NE(std::find(run.window.prior_blocks.begin(), run.window.prior_blocks.end(), pose), run.window.prior_blocks.end());
	run.window.options.window.keyframe_parallax_px = 1e3;
	run.window.options.window.keyframe_min_tracked = 0;
	EXPECT_EQ(run.step(run.drive.frames[i]), Fate::merged);
	EXPECT_EQ(std::find(run.window.prior_blocks.begin(), run.window.prior_blocks.end(), pose), run.window.prior_blocks.end());
	ASSERT_TRUE(run.window.prior);
	expectNothingDangles(run.window);
}

TEST(WindowUpdate, StandingKeepsParallaxAndShortIntervals)
{
	DriveSetup setup("straight 0.8 m, stand 16 s");
	setup.route.speed_m_s = 0.3;
	EstimatorOptions options = smallWindow(Mode::viwo, 5);
	SlidingRun run(setup, options);
	std::map<Fate, int> fates_standing;
	std::vector<int64_t> before_standing;
	for (const FeatureFrame& f : run.drive.frames)
	{
		const double t_s = run.drive.secondsOf(f.t_ns);
		const Fate fate = run.step(f);
		EXPECT_LE(run.window.frames.size(), 6u);
		for (const auto& frame : run.window.frames)
			EXPECT_LE(frame->interval.imu ? frame->interval.imu->dt_s() : 0, options.window.max_interval_s + 1e-6);
		if (t_s < 5) continue;  // it stands
		++fates_standing[fate];
		std::vector<int64_t> keyframes;
		for (const auto& frame : run.window.frames)
			if (frame->keyframe) keyframes.push_back(frame->id);
		if (fates_standing[Fate::kept_timed] == 1 && before_standing.empty()) before_standing = keyframes;
		if (before_standing.empty()) continue;
		EXPECT_EQ(keyframes, before_standing);
	}
	std::cout << "[measured] while standing: merged " << fates_standing[Fate::merged] << ", timed " << fates_standing[Fate::kept_timed]
	          << ", keyframes kept " << before_standing.size() << "\n";
	EXPECT_GE(fates_standing[Fate::kept_timed], 3);
	EXPECT_GE(before_standing.size(), 3u);
	EXPECT_EQ(fates_standing[Fate::kept_oldest_marginalized], 0);
	expectNothingDangles(run.window);
}

/** Information of a set of factors along one direction, with each state at the point where its Jacobians are taken. */
struct GaugeInformation
{
	explicit GaugeInformation(Window& window)
	{
		for (const Factor& f : collectFactors(window))
		{
			std::vector<test::RowMajor> J;
			std::vector<double*> p;
			Eigen::VectorXd r(f.cost->num_residuals());
			for (const BlockShape& s : f.cost->shapes()) J.emplace_back(f.cost->num_residuals(), s.tangent);
			for (auto& j : J) p.push_back(j.data());
			if (!f.cost->linearize(f.blocks.data(), r.data(), p.data())) continue;
			Eigen::MatrixXd along = Eigen::MatrixXd::Zero(r.size(), 4), magnitude = along;
			for (size_t i = 0; i < J.size(); ++i)
			{
				const double* x0 = f.cost->linearizationPoint(static_cast<int>(i));
				const Eigen::MatrixXd n = directions(window, f.blocks[i], x0 ? x0 : f.blocks[i], f.cost->shapes()[i]);
				along += J[i] * n;
				magnitude += J[i].cwiseAbs() * n.cwiseAbs();
			}
			information += along.colwise().squaredNorm().transpose();
			scale += magnitude.colwise().squaredNorm().transpose();
		}
	}

	/** Tangent of moving everything by x, y, z, and of turning it about z: columns. */
	static Eigen::MatrixXd directions(const Window& window, const double* block, const double* x0, const BlockShape& shape)
	{
		Eigen::MatrixXd n = Eigen::MatrixXd::Zero(shape.tangent, 4);
		if (shape.kind == BlockKind::pose && block != window.T_BC.data())
		{
			const Pose3 T = poseFromBlock(x0);
			n.topLeftCorner<3, 3>().setIdentity();
			n.col(3) << Eigen::Vector3d::UnitZ().cross(T.p), T.R.conjugate() * Eigen::Vector3d::UnitZ();
		}
		if (shape.tangent == 9) n.col(3).head<3>() = Eigen::Vector3d::UnitZ().cross(Eigen::Map<const Eigen::Vector3d>(x0));
		return n;
	}

	Eigen::Vector4d information = Eigen::Vector4d::Zero(), scale = Eigen::Vector4d::Zero();
};

TEST(WindowUpdate, NoSensorTellsPositionAndHeading)
{
	DriveSetup setup("arc 1.5 m 60 deg");
	setup.route.speed_m_s = 0.3;
	EstimatorOptions options = smallWindow(Mode::viwo, 5);
	options.factors.plane_factor = false;
	SlidingRun run(setup, options);
	int marginalised = 0;
	for (const FeatureFrame& f : run.drive.frames)
	{
		run.push(f, 1e-3);
		if (run.window.frames.size() == 1)
		{
			// As at a start, but nothing that knows where it is or in which direction it drives.
			addStartPriors(run.window, run.window.latest(), 0.1);
			auto& priors = run.window.start_priors;
			const double* motion = run.window.latest().motion.data();
			priors.erase(
			    std::remove_if(priors.begin(), priors.end(),
			                   [&](const Factor& p) { return p.blocks[0] == motion || p.blocks[0] == run.window.latest().pose.data(); }),
			    priors.end());
			Eigen::Matrix<double, 9, 1> sigma;
			sigma << Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()), Eigen::Vector3d::Constant(0.1),
			    Eigen::Vector3d::Constant(0.01);
			priors.push_back(
			    {std::make_shared<StatePrior>(BlockShape::euclidean(9), motion, sigma), nullptr, {run.window.latest().motion.data()}});
		}
		run.window.landmarks.triangulate(run.window.T_BC_pose());
		solveWindow(run.window, 6);
		run.window.landmarks.assess(run.window.T_BC_pose());
		marginalised += advanceWindow(run.window) == Fate::kept_oldest_marginalized;
	}
	const GaugeInformation gauge(run.window);
	std::cout << "[measured] after " << marginalised << " marginalisations: information along x y z yaw " << gauge.information.transpose()
	          << "; of the single terms " << gauge.scale.transpose() << "\n";
	EXPECT_GT(marginalised, 8);
	for (int i = 0; i < 4; ++i) EXPECT_LT(gauge.information[i], 1e-9 * gauge.scale[i]);
}
}  // namespace
}  // namespace viwo
