#include "CameraRecorder.h"

#include <viwo/core/Error.h>
#include <viwo/rawlog/RawlogWriter.h>
#include <viwo/sim/Mounting.h>
#include <viwo/sim/RandomSource.h>

#include <array>
#include <cmath>
#include <exception>
#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <thread>

namespace viwo::sim
{
namespace
{
bool same(const Pose3& a, const Pose3& b)
{
	return a.p == b.p && a.R.coeffs() == b.R.coeffs();
}

/** Blue, green and red of grey surfaces in warm light; the luma stays what it was. */
cv::Mat inWarmLight(const cv::Mat& grey)
{
	constexpr std::array<double, 3> kGains = {0.80, 1.0, 1.0763};
	std::array<cv::Mat, 3> channels;
	for (size_t i = 0; i < channels.size(); ++i) grey.convertTo(channels[i], CV_8U, kGains[i]);
	cv::Mat colour;
	cv::merge(channels.data(), channels.size(), colour);
	return colour;
}
}  // namespace

/** A renderer, and what it saw last: a robot that stands for minutes sees the same light in each frame, only the noise is new. */
class CameraRecorder::Eye
{
   public:
	explicit Eye(const CameraRecorder& r)
	    : renderer_(r.world_, r.model_, r.renderer_options_, r.effects_options_),
	      effects_(r.model_.width_px(), r.model_.height_px(), r.effects_options_)
	{
	}

	GreyImage see(const Renderer::Motion& T_WC, const Exposure& exposure)
	{
		const Pose3 open = T_WC(0);
		if (exposure.black || !same(open, T_WC(0.5)) || !same(open, T_WC(1))) return renderer_.render(T_WC, exposure);
		if (!still_ || !same(open, *still_))
		{
			radiance_ = renderer_.radiance(open);
			still_ = open;
		}
		return effects_.apply(radiance_, exposure);
	}

   private:
	Renderer renderer_;
	ImageEffects effects_;
	std::optional<Pose3> still_;
	RadianceImage radiance_;
};

CameraRecorder::CameraRecorder(const Motion& motion, const World& world, const Rig& rig, uint64_t seed)
    : motion_(motion),
      world_(world),
      options_(rig.camera),
      renderer_options_(rig.renderer),
      effects_options_(rig.image_effects),
      model_(rig.camera.model()),
      T_OC_actual_(Mounting(rig.camera.pose, rig.camera.pose_error, "camera").actual)
{
	if (options_.exposure_steps.size() % 2 != 0) throw Error("[camera] exposure_steps: expected pairs of time (s) and factor");
	if (1e-3 * options_.exposure_ms > 1 / options_.rate_hz)
		throw Error("[camera] exposure_ms: must not be longer than the interval of images");
	std::mt19937_64 generator = randomSource(seed, "camera noise");
	for (int64_t i = 0; i < count(); ++i) noise_seeds_.push_back(generator());
}

int64_t CameraRecorder::count() const
{
	const double room_s = motion_.duration_s() - 1e-3 * (options_.phase_ms + 0.5 * options_.exposure_ms);
	return room_s < 0 ? 0 : static_cast<int64_t>(std::floor(room_s * options_.rate_hz + 1e-9)) + 1;
}

int64_t CameraRecorder::stamp_ns(int64_t i) const
{
	return motion_.stamp_ns(time_s(i)) - nanoseconds(1e-3 * options_.time_offset_ms);
}

std::string CameraRecorder::fileName(int64_t i) const
{
	return RawlogWriter::imageName(options_.label, stamp_ns(i), options_.format == CameraOptions::Format::png ? "png" : "jpg");
}

Exposure CameraRecorder::exposure(int64_t i) const
{
	const double t_s = time_s(i);
	Exposure exposure;
	for (size_t k = 0; k < options_.exposure_steps.size(); k += 2)
		if (t_s >= options_.exposure_steps[k]) exposure.brightness = options_.exposure_steps[k + 1];
	exposure.black = t_s >= options_.black_from_s && t_s < options_.black_to_s;
	exposure.noise_seed = noise_seeds_[static_cast<size_t>(i)];
	return exposure;
}

void CameraRecorder::writeImage(Eye& eye, int64_t i, const std::string& path) const
{
	const double exposure_s = 1e-3 * options_.exposure_ms, open_s = time_s(i) - 0.5 * exposure_s;
	GreyImage image = eye.see([&](double s) { return motion_.at(open_s + s * exposure_s).T_WO * T_OC_actual_; }, exposure(i));
	cv::Mat pixels(image.height_px, image.width_px, CV_8UC1, image.pixels.data());
	if (options_.colour) pixels = inWarmLight(pixels);
	std::vector<int> parameters;
	if (options_.format == CameraOptions::Format::jpg) parameters = {cv::IMWRITE_JPEG_QUALITY, options_.jpeg_quality};
	if (!cv::imwrite(path, pixels, parameters)) throw Error(path + ": cannot write this image; check the folder and the free space");
}

void CameraRecorder::work(const std::string& folder, Queue& queue, const std::function<bool(double)>& progress) const
{
	Eye eye(*this);
	while (!queue.stop)
	{
		const int64_t i = queue.next++;
		if (i >= count()) return;
		writeImage(eye, i, folder + "/" + fileName(i));
		if (progress && !progress(static_cast<double>(i + 1) / static_cast<double>(count()))) queue.stop = true;
	}
}

int64_t CameraRecorder::record(const std::string& folder, int threads, const std::function<bool(double)>& progress) const
{
	Queue queue;
	std::vector<std::exception_ptr> errors(static_cast<size_t>(std::max(1, threads)));
	const auto guardedWork = [&](size_t worker, const std::function<bool(double)>& report)
	{
		try
		{
			work(folder, queue, report);
		}
		catch (...)
		{
			errors[worker] = std::current_exception();
			queue.stop = true;
		}
	};
	std::vector<std::thread> helpers;
	for (size_t worker = 1; worker < errors.size(); ++worker) helpers.emplace_back(guardedWork, worker, nullptr);
	guardedWork(0, progress);
	for (std::thread& helper : helpers) helper.join();
	for (const std::exception_ptr& error : errors)
		if (error) std::rethrow_exception(error);
	// Whoever took a number has finished it.
	return std::min(queue.next.load(), count());
}

int64_t CameraRecorder::take(const std::string& folder, const std::string& images_from) const
{
	namespace fs = std::filesystem;
	for (int64_t i = 0; i < count(); ++i)
	{
		const std::string from = images_from + "/" + fileName(i), to = folder + "/" + fileName(i);
		std::error_code error;
		fs::remove(to, error);
		fs::create_hard_link(from, to, error);
		if (error) fs::copy_file(from, to, error);
		if (error)
			throw Error(from + ": this image cannot be taken over (" + error.message() +
			            "); it must be of a run with the same route and camera");
	}
	return count();
}
}  // namespace viwo::sim
