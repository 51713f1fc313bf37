#pragma once

#include <viwo/sim/Rig.h>

#include <atomic>
#include <functional>
#include <string>
#include <vector>

namespace viwo::sim
{
/** When the shutter opens, and the image files it makes. */
class CameraRecorder
{
   public:
	CameraRecorder(const Motion& motion, const World& world, const Rig& rig, uint64_t seed);

	/** Images whose exposure lies within the motion. */
	int64_t count() const;
	/** Middle of the exposure, true time. */
	double time_s(int64_t i) const { return 1e-3 * options_.phase_ms + static_cast<double>(i) / options_.rate_hz; }
	/** By the camera's clock. */
	int64_t stamp_ns(int64_t i) const;
	std::string fileName(int64_t i) const;

	/** Renders images 0 to count() - 1 into the folder. @param progress part that is done; false: stop.
	 *  @return how many were finished, from the first on. @throws Error when a file cannot be written.
	 */
	int64_t record(const std::string& folder, int threads, const std::function<bool(double)>& progress) const;

	/** Takes the image files of another run instead: of the same world, route, camera, floor, vibration and seed, or they will not fit.
	 *  @return how many: all. @throws Error for one that is missing or cannot be copied.
	 */
	int64_t take(const std::string& folder, const std::string& images_from) const;

   private:
	class Eye;
	struct Queue
	{
		std::atomic<int64_t> next{0};
		std::atomic<bool> stop{false};
	};
	void work(const std::string& folder, Queue& queue, const std::function<bool(double)>& progress) const;
	void writeImage(Eye& eye, int64_t i, const std::string& path) const;
	Exposure exposure(int64_t i) const;

	const Motion& motion_;
	const World& world_;
	CameraOptions options_;
	RendererOptions renderer_options_;
	ImageEffectsOptions effects_options_;
	CameraModel model_;
	Pose3 T_OC_actual_;
	std::vector<uint64_t> noise_seeds_;
};
}  // namespace viwo::sim
