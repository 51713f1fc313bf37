#include <viwo/core/So3.h>

#include <Marginalizer.h>
#include <SlidingRun.h>
#include <benchmark/benchmark.h>

#include <algorithm>

namespace viwo
{
namespace
{
/** Ten keyframes and the latest frame, 150 features, with a prior: the window of a robot on an arc after some ten seconds. */
class TypicalWindow
{
   public:
	TypicalWindow() : run_(setup(), test::optionsOf(Mode::viwo))
	{
		for (size_t i = 0; i + 1 < run_.drive.frames.size(); ++i) run_.step(run_.drive.frames[i]);
		run_.push(run_.drive.frames.back());
		window().landmarks.triangulate(window().T_BC_pose());
		for (auto& frame : window().frames) states_.push_back(frame->state());
		for (auto& [id, landmark] : window().landmarks.all()) depths_.push_back(landmark.inverse_depth_1_m);
	}
	Window& window() { return run_.window; }

	/** Back to the states before the solver, the latest frame off by some millimetres as its prediction is. */
	void reset()
	{
		for (size_t i = 0; i < states_.size(); ++i) window().frames[i]->setState(states_[i]);
		window().latest().pose[0] += 0.005;
		size_t l = 0;
		for (auto& [id, landmark] : window().landmarks.all()) landmark.inverse_depth_1_m = depths_[l++];
	}

   private:
	static test::DriveSetup setup()
	{
		test::DriveSetup setup("arc 1.5 m 90 deg");
		setup.route.speed_m_s = 0.3;
		setup.tracks.max_features = 150;
		setup.room_points = 1500;
		setup.route.duration_s = 10;
		return setup;
	}

	test::SlidingRun run_;
	std::vector<NavState> states_;
	std::vector<double> depths_;
};

TypicalWindow& typical()
{
	static TypicalWindow window;
	return window;
}

void evaluateResiduals(benchmark::State& state)
{
	const std::vector<Factor> factors = collectFactors(typical().window());
	std::vector<std::vector<std::vector<double>>> jacobians;
	std::vector<std::vector<double*>> pointers;
	std::vector<std::vector<double>> residuals;
	for (const Factor& f : factors)
	{
		jacobians.emplace_back();
		for (const BlockShape& s : f.cost->shapes())
			jacobians.back().emplace_back(static_cast<size_t>(f.cost->num_residuals() * s.tangent));
		pointers.emplace_back();
		for (auto& j : jacobians.back()) pointers.back().push_back(j.data());
		residuals.emplace_back(static_cast<size_t>(f.cost->num_residuals()));
	}
	for (auto _ : state)
		for (size_t i = 0; i < factors.size(); ++i)
			factors[i].cost->linearize(factors[i].blocks.data(), residuals[i].data(), pointers[i].data());
	state.SetItemsProcessed(static_cast<int64_t>(factors.size()) * state.iterations());
}
BENCHMARK(evaluateResiduals)->Unit(benchmark::kMillisecond);

void solve(benchmark::State& state)
{
	TypicalWindow& t = typical();
	for (auto _ : state)
	{
		state.PauseTiming();
		t.reset();
		state.ResumeTiming();
		benchmark::DoNotOptimize(solveWindow(t.window(), t.window().options.window.max_iterations));
	}
}
BENCHMARK(solve)->Unit(benchmark::kMillisecond);

void covariance(benchmark::State& state)
{
	Eigen::Matrix<double, 15, 15> covariance;
	for (auto _ : state) benchmark::DoNotOptimize(latestCovariance(typical().window(), covariance));
}
BENCHMARK(covariance)->Unit(benchmark::kMillisecond);

/** The oldest frame with the landmarks anchored there. */
void marginaliseOldest(benchmark::State& state)
{
	Window& w = typical().window();
	Frame& oldest = *w.frames.front();
	std::vector<double*> blocks{oldest.pose.data(), oldest.motion.data()};
	for (auto& [id, landmark] : w.landmarks.all())
		if (landmark.in_use && &landmark.anchor() == &oldest) blocks.push_back(&landmark.inverse_depth_1_m);
	const auto touches = [&](const Factor& f)
	{
		return std::any_of(f.blocks.begin(), f.blocks.end(),
		                   [&](double* b) { return std::find(blocks.begin(), blocks.end(), b) != blocks.end(); });
	};
	for (auto _ : state)
	{
		Marginalizer marginalizer;
		for (const Factor& factor : collectFactors(w))
			if (touches(factor) || factor.cost == w.prior) marginalizer.add(factor);
		for (double* block : blocks) marginalizer.eliminate(block);
		benchmark::DoNotOptimize(marginalizer.run());
	}
}
BENCHMARK(marginaliseOldest)->Unit(benchmark::kMillisecond);
}  // namespace
}  // namespace viwo
