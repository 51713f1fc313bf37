#include <ImuPreintegration.h>
#include <WheelPreintegration.h>
#include <benchmark/benchmark.h>

namespace viwo
{
namespace
{
/** One image interval: 20 steps at 200 Hz. */
void imuInterval(benchmark::State& state)
{
	std::vector<ImuSample> span;
	for (int i = 0; i <= 20; ++i)
		span.push_back({i * 5'000'000, Eigen::Vector3d(0.1, 0.01 * i, 9.8), Eigen::Vector3d(0.01, 0.02, 0.1 + 0.01 * i)});
	for (auto _ : state)
	{
		ImuPreintegration interval(ImuNoise(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
		interval.integrate(span);
		benchmark::DoNotOptimize(interval.covariance());
	}
	state.SetItemsProcessed(20 * state.iterations());
}
BENCHMARK(imuInterval)->Unit(benchmark::kMicrosecond);

/** One image interval: three pieces of samples at 20 Hz. */
void wheelInterval(benchmark::State& state)
{
	for (auto _ : state)
	{
		WheelPreintegration interval(WheelNoise(), {1, 1, 0.23});
		for (int i = 0; i < 3; ++i) interval.integrate({0.033, 0.15, 0.17});
		benchmark::DoNotOptimize(interval.covariance());
	}
	state.SetItemsProcessed(3 * state.iterations());
}
BENCHMARK(wheelInterval)->Unit(benchmark::kMicrosecond);
}  // namespace
}  // namespace viwo
