#include <viwo/core/So3.h>
#include <viwo/frontend/FeatureTracker.h>
#include <viwo/sim/Renderer.h>
#include <viwo/sim/Rig.h>
#include <viwo/sim/World.h>

#include <benchmark/benchmark.h>

#include <opencv2/core.hpp>

namespace viwo
{
namespace
{
/** Down a corridor at 0.15 m/s and 0.15 rad/s; s: images since the start, at 10 Hz. */
Pose3 cameraAt(double s)
{
	return Pose3(so3::expQuaternion({0, 0, 0.015 * s}), Eigen::Vector3d(1 + 0.015 * s, 0, 0.3)) *
	       Pose3(forwardOpticalAxes(), Eigen::Vector3d::Zero());
}

sim::Renderer& corridor()
{
	static sim::Renderer renderer(sim::World::load(VIWO_SOURCE_DIR "/share/viwo/worlds/corridor.ini"), sim::CameraOptions().model());
	return renderer;
}

sim::GreyImage image(double s)
{
	return corridor().render([s](double shutter) { return cameraAt(s + 0.1 * shutter); }, sim::Exposure());
}

/** 640x480, motion blur of 10 ms. */
void renderFrame(benchmark::State& state)
{
	corridor();
	double s = 0;
	for (auto _ : state) benchmark::DoNotOptimize(image(s = s < 20 ? s + 1 : 0));
}
BENCHMARK(renderFrame)->Unit(benchmark::kMillisecond);

/** The front-end on rendered images, to and fro. */
void trackFrame(benchmark::State& state)
{
	cv::setNumThreads(1);
	std::vector<sim::GreyImage> images;
	for (int i = 0; i < 10; ++i) images.push_back(image(i));
	FeatureTracker tracker(sim::CameraOptions().model(), TrackerOptions());
	int64_t t_ns = 0;
	int last = 0, next = 0, step = 1;
	for (auto _ : state)
	{
		sim::GreyImage& grey = images[static_cast<size_t>(next)];
		const cv::Mat view(grey.height_px, grey.width_px, CV_8U, grey.pixels.data());
		benchmark::DoNotOptimize(tracker.track(t_ns, view, cameraAt(last).R.conjugate() * cameraAt(next).R));
		t_ns += 100'000'000;
		last = next;
		if (next + step < 0 || next + step > 9) step = -step;
		next += step;
	}
	state.counters["tracked"] = tracker.stats().tracked;
}
BENCHMARK(trackFrame)->Unit(benchmark::kMillisecond);
}  // namespace
}  // namespace viwo
