#include <IntervalFactory.h>

#include <viwo/core/Time.h>

#include <ImuPreintegration.h>
#include <PlanarDrive.h>
#include <WheelPreintegration.h>
#include <Window.h>
#include <gtest/gtest.h>

namespace viwo
{
namespace
{
constexpr int64_t kFrame_ns = 100'000'000;

struct Streams
{
	/** @param hole_from_s, hole_to_s of both streams, open interval. */
	explicit Streams(double hole_from_s = 0, double hole_to_s = 0)
	{
		drive.v_swing_m_s = 0.05;
		drive.w_swing_rad_s = 0.1;
		const int64_t from_ns = nanoseconds(hole_from_s), to_ns = nanoseconds(hole_to_s);
		for (int64_t t_ns = 0; t_ns <= 3'000'000'000; t_ns += 5'000'000)
			if (t_ns <= from_ns || t_ns >= to_ns) imu.add(drive.imu(t_ns));
		for (int64_t t_ns = 0; t_ns <= 3'000'000'000; t_ns += 50'000'000)
			if (t_ns <= from_ns || t_ns >= to_ns) wheels.add(drive.wheel(t_ns, 50'000'000));
	}

	test::PlanarDrive drive;
	ImuBuffer imu;
	WheelBuffer wheels;
};

TEST(IntervalFactory, OneIntervalPerSensorOfTheMode)
{
	const Streams streams;
	for (const Mode mode : {Mode::wheel, Mode::wio, Mode::vio, Mode::viwo})
	{
		EstimatorOptions options;
		options.mode = mode;
		IntervalFactory factory(options, {1, 1, 0.23});
		const Interval interval = factory.between(streams.imu, streams.wheels, 13'000'000, 13'000'000 + kFrame_ns);
		EXPECT_EQ(interval.imu != nullptr, options.useImu());
		EXPECT_EQ(interval.wheels != nullptr, options.useWheels());
		EXPECT_NEAR(interval.imu ? interval.imu->dt_s() : 0.1, 0.1, 1e-12);
		EXPECT_NEAR(interval.wheels ? interval.wheels->dt_s() : 0.1, 0.1, 1e-12);
		EXPECT_EQ(factory.imuGaps() + factory.wheelGaps(), 0);
	}
}

TEST(IntervalFactory, HolesAreBridgedOrCounted)
{
	const EstimatorOptions options;
	{
		const Streams streams(1.0, 1.05);  // shorter than any limit
		IntervalFactory factory(options, {1, 1, 0.23});
		const Interval interval = factory.between(streams.imu, streams.wheels, 950'000'000, 1'100'000'000);
		EXPECT_TRUE(interval.imu && interval.wheels);
		EXPECT_EQ(factory.imuGaps() + factory.wheelGaps(), 0);
	}
	{
		const Streams streams(1.0, 1.5);  // the IMU's is bridged and counted, the wheels' is too long
		IntervalFactory factory(options, {1, 1, 0.23});
		const Interval interval = factory.between(streams.imu, streams.wheels, 950'000'000, 1'600'000'000);
		ASSERT_TRUE(interval.imu);
		EXPECT_NEAR(interval.imu->dt_s(), 0.65, 1e-12);
		EXPECT_FALSE(interval.wheels);
		EXPECT_EQ(factory.imuGaps(), 1);
		EXPECT_EQ(factory.wheelGaps(), 1);
	}
	{
		const Streams streams(1.0, 2.5);
		IntervalFactory factory(options, {1, 1, 0.23});
		EXPECT_FALSE(factory.between(streams.imu, streams.wheels, 950'000'000, 2'600'000'000).imu);
		EXPECT_FALSE(factory.between(streams.imu, streams.wheels, 2'950'000'000, 3'100'000'000).imu);  // not there yet
	}
}

/** However many frames a hole spoils, it is one. */
TEST(IntervalFactory, EachHoleCountsOnce)
{
	const Streams streams(1.0, 2.5);
	IntervalFactory factory(EstimatorOptions(), {1, 1, 0.23});
	for (int64_t t_ns = 500'000'000; t_ns < 2'900'000'000; t_ns += kFrame_ns)
		factory.between(streams.imu, streams.wheels, t_ns, t_ns + kFrame_ns);
	EXPECT_EQ(factory.imuGaps(), 1);
	EXPECT_EQ(factory.wheelGaps(), 1);
}

void expectSame(const Interval& a, const Interval& b)
{
	const auto relative = [](const auto& x, const auto& y) { return (x - y).norm() / std::max(1e-12, y.norm()); };
	EXPECT_LT(relative(a.imu->delta().alpha, b.imu->delta().alpha), 1e-9);
	EXPECT_LT(relative(a.imu->delta().beta, b.imu->delta().beta), 1e-9);
	EXPECT_LT(relative(a.imu->delta().gamma.coeffs(), b.imu->delta().gamma.coeffs()), 1e-9);
	EXPECT_LT(relative(a.imu->covariance(), b.imu->covariance()), 1e-9);
	EXPECT_LT(relative(a.imu->biasJacobian(), b.imu->biasJacobian()), 1e-9);
	EXPECT_LT(relative(a.wheels->dp(), b.wheels->dp()), 1e-9);
	EXPECT_LT(relative(a.wheels->dR().coeffs(), b.wheels->dR().coeffs()), 1e-9);
	EXPECT_LT(relative(a.wheels->covariance(), b.wheels->covariance()), 1e-9);
	EXPECT_LT(relative(a.wheels->intrinsicsJacobian(), b.wheels->intrinsicsJacobian()), 1e-9);
}

struct SmallWindow
{
	SmallWindow() : window(options, calibration()), factory(options, calibration().wheels)
	{
		for (int i = 0; i < 4; ++i)
		{
			auto frame = std::make_unique<Frame>();
			frame->t_ns = i * kFrame_ns;
			frame->pose[6] = 1;
			if (i > 0) frame->interval = factory.between(streams.imu, streams.wheels, (i - 1) * kFrame_ns, i * kFrame_ns);
			window.frames.push_back(std::move(frame));
		}
		collectFactors(window);  // makes the factors that relinearisation has to drop
	}
	static Calibration calibration()
	{
		Calibration c;
		c.camera = CameraModel(640, 480, 250, 250, 320, 240);
		return c;
	}

	EstimatorOptions options;
	Streams streams;
	Window window;
	IntervalFactory factory;
};

TEST(IntervalFactory, RelinearisationEqualsFreshIntegration)
{
	SmallWindow w;
	NavState state = w.window.latest().state();
	state.b_g = Eigen::Vector3d(0.004, -0.003, 0.002);
	state.b_a = Eigen::Vector3d(0.02, 0.03, -0.01);
	w.window.latest().setState(state);
	w.window.wheels = {1.01, 0.995, 0.232};
	w.factory.relinearize(w.window);
	for (int i = 1; i < 4; ++i)
	{
		Frame& frame = *w.window.frames[i];
		EXPECT_EQ(frame.imu_factor, nullptr);
		EXPECT_EQ(frame.wheel_factor, nullptr);
		EXPECT_EQ(frame.interval.imu->b_g(), state.b_g);
		EXPECT_EQ(frame.interval.wheels->intrinsics().k_left, 1.01);
		// What the factory makes from now on has the same point, so that neighbours can be joined.
		const Interval fresh = w.factory.between(w.streams.imu, w.streams.wheels, (i - 1) * kFrame_ns, i * kFrame_ns);
		EXPECT_EQ(fresh.imu->b_g(), state.b_g);
		expectSame(frame.interval, fresh);
	}
}

TEST(IntervalFactory, SmallMovesKeepThePoint)
{
	SmallWindow w;
	NavState state = w.window.latest().state();
	state.b_g = Eigen::Vector3d(0.001, 0, 0);
	w.window.latest().setState(state);
	w.window.wheels = {1.0005, 1, 0.23};
	w.factory.relinearize(w.window);
	for (int i = 1; i < 4; ++i)
	{
		EXPECT_NE(w.window.frames[i]->imu_factor, nullptr);
		EXPECT_NE(w.window.frames[i]->wheel_factor, nullptr);
		EXPECT_EQ(w.window.frames[i]->interval.imu->b_g().norm(), 0);
	}
}

TEST(IntervalFactory, JoinedIntervalsEqualTheirUnion)
{
	SmallWindow w;
	Interval joined = w.factory.between(w.streams.imu, w.streams.wheels, 113'000'000, 213'000'000);
	const Interval next = w.factory.between(w.streams.imu, w.streams.wheels, 213'000'000, 377'000'000);
	const Interval whole = w.factory.between(w.streams.imu, w.streams.wheels, 113'000'000, 377'000'000);
	joined.imu->append(*next.imu);
	joined.wheels->append(*next.wheels);
	EXPECT_LT((joined.imu->delta().alpha - whole.imu->delta().alpha).norm(), 1e-6);
	EXPECT_LT((joined.imu->delta().beta - whole.imu->delta().beta).norm(), 1e-5);
	EXPECT_LT((joined.wheels->dp() - whole.wheels->dp()).norm(), 1e-12);
	EXPECT_LT((joined.wheels->covariance() - whole.wheels->covariance()).norm() / whole.wheels->covariance().norm(), 1e-5);
	EXPECT_NEAR(joined.imu->dt_s(), whole.imu->dt_s(), 1e-12);
}

TEST(IntervalFactory, OffsetsThatMoveCutTheWindowAnewAndKeepWhatWasJudged)
{
	const Streams streams;
	const EstimatorOptions options;
	IntervalFactory factory(options, {1, 1, 0.23});
	Window window(options, Calibration());
	for (int64_t t_ns = 1'013'000'000; t_ns < 1'600'000'000; t_ns += kFrame_ns)
	{
		auto frame = std::make_unique<Frame>();
		frame->t_ns = t_ns;
		if (!window.frames.empty()) frame->interval = factory.between(streams.imu, streams.wheels, window.latest().t_ns, t_ns);
		window.frames.push_back(std::move(frame));
	}
	window.frames[3]->interval.wheels->scaleCovariance(100);  // slips between 1.213 s and 1.313 s

	window.t_d_s = 5e-4;
	factory.recut(window, streams.imu, streams.wheels);
	EXPECT_EQ(window.frames[1]->interval.cut_at.t_d_s, 0) << "too small a move";

	window.t_d_s = 0.03;
	window.t_w_s = -0.02;
	factory.recut(window, streams.imu, streams.wheels);
	double slipping_s = 0;
	for (size_t i = 1; i < window.frames.size(); ++i)
	{
		const int64_t begin_ns = window.frames[i - 1]->t_ns;
		const Interval& cut = window.frames[i]->interval;
		EXPECT_EQ(cut.cut_at.t_d_s, 0.03);
		EXPECT_EQ(cut.imu->t_begin_ns(), begin_ns + 30'000'000);
		EXPECT_NEAR(cut.wheels->dt_s(), 0.1, 1e-12);
		IntervalFactory direct(options, {1, 1, 0.23});
		const Interval in_wheel_clock =
		    direct.between(streams.imu, streams.wheels, begin_ns + 50'000'000, begin_ns + 50'000'000 + kFrame_ns);
		EXPECT_EQ(cut.wheels->dp(), in_wheel_clock.wheels->dp());
		for (const WheelSegment& s : cut.wheels->segments()) slipping_s += s.variance_scale > 1 ? s.dt_s : 0;
	}
	EXPECT_NEAR(slipping_s, 0.1, 0.051) << "as long as before, to half a sample at each end";

	window.t_d_s = 5;
	factory.recut(window, streams.imu, streams.wheels);
	EXPECT_EQ(window.frames[1]->interval.cut_at.t_d_s, 0.03) << "where no samples are, nothing is cut";
	EXPECT_EQ(factory.offsets().t_d_s, 0.03);
}
}  // namespace
}  // namespace viwo
