#include "RawlogAssembler.h"

#include "OutputNames.h"

#include <viwo/core/Error.h>
#include <viwo/core/Time.h>
#include <viwo/rawlog/RawlogWriter.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace viwo
{
namespace
{
namespace fs = std::filesystem;

enum class Kind
{
	imu,
	odometry,
	image
};

struct Event
{
	int64_t t_ns;
	Kind kind;
	size_t index;
};

std::vector<Event> inOrder(const Recording& recording)
{
	std::vector<Event> events;
	for (size_t i = 0; i < recording.imu.size(); ++i) events.push_back({recording.imu[i].t_ns, Kind::imu, i});
	for (size_t i = 0; i < recording.odometry.size(); ++i) events.push_back({recording.odometry[i].t_ns, Kind::odometry, i});
	for (size_t i = 0; i < recording.images.size(); ++i) events.push_back({recording.images[i].t_ns, Kind::image, i});
	// An image comes after the samples of its own time, which an estimator needs to process it.
	std::sort(events.begin(), events.end(),
	          [](const Event& a, const Event& b) {
		          return a.t_ns != b.t_ns ? a.t_ns < b.t_ns : a.kind != b.kind ? a.kind < b.kind : a.index < b.index;
	          });
	return events;
}

struct PlanarPose
{
	double x_m = 0, y_m = 0, yaw_rad = 0;
};

std::vector<PlanarPose> integrate(const std::vector<TwistSample>& samples)
{
	std::vector<PlanarPose> poses(samples.size());
	for (size_t i = 1; i < samples.size(); ++i)
	{
		const double dt_s = secondsBetween(samples[i - 1].t_ns, samples[i].t_ns);
		const double v = 0.5 * (samples[i - 1].twist.v_m_s + samples[i].twist.v_m_s);
		const double w = 0.5 * (samples[i - 1].twist.w_rad_s + samples[i].twist.w_rad_s);
		const PlanarPose& last = poses[i - 1];
		const double middle = last.yaw_rad + 0.5 * w * dt_s;
		poses[i] = {last.x_m + v * dt_s * std::cos(middle), last.y_m + v * dt_s * std::sin(middle), last.yaw_rad + w * dt_s};
	}
	return poses;
}

std::string extensionOf(const std::string& path)
{
	const std::string extension = fs::path(path).extension().string();
	return extension.empty() ? "png" : extension.substr(1);
}

void copyImage(const std::string& from, const std::string& to)
{
	std::error_code error;
	if (!fs::is_regular_file(from, error)) throw Error(from + ": missing image file");
	fs::copy_file(from, to, fs::copy_options::overwrite_existing, error);
	if (error) throw Error(to + ": cannot copy the image " + from + " here: " + error.message());
}

void requireSize(const Recording& recording)
{
	if (recording.images.empty()) return;
	const auto [width, height] = imageSize(recording.images.front().path);
	if (width == recording.camera.width_px() && height == recording.camera.height_px()) return;
	throw Error(recording.images.front().path + ": " + std::to_string(width) + "x" + std::to_string(height) +
	            " pixels, but the calibration is for " + std::to_string(recording.camera.width_px()) + "x" +
	            std::to_string(recording.camera.height_px()));
}
}  // namespace

std::pair<int, int> imageSize(const std::string& path)
{
	std::error_code error;
	if (!fs::is_regular_file(path, error)) throw Error(path + ": missing image file");
	const cv::Mat image = cv::imread(path, cv::IMREAD_UNCHANGED);
	if (image.empty()) throw Error(path + ": cannot be decoded as an image");
	return {image.cols, image.rows};
}

ImportResult writeRecording(const Recording& recording, const ImportJob& job)
{
	requireSize(recording);
	const std::vector<Event> events = inOrder(recording);
	if (events.empty()) throw Error(job.folder + ": nothing to write, no observation was found");
	const std::vector<PlanarPose> odometry_poses = integrate(recording.odometry);

	RawlogWriter writer(job.rawlog_path);
	for (size_t done = 0; done < events.size(); ++done)
	{
		const size_t i = events[done].index;
		switch (events[done].kind)
		{
			case Kind::imu:
				writer.write(makeImu(recording.imu[i], recording.T_OB));
				break;
			case Kind::odometry:
			{
				const TwistSample& sample = recording.odometry[i];
				const PlanarPose& pose = odometry_poses[i];
				writer.write(makeOdometry(sample.t_ns, sample.twist, {}, pose.x_m, pose.y_m, pose.yaw_rad));
				break;
			}
			case Kind::image:
			{
				const ImageFile& image = recording.images[i];
				const std::string extension = extensionOf(image.path);
				copyImage(image.path, writer.imagePath("CAM", image.t_ns, extension));
				writer.write(
				    makeImage(image.t_ns, recording.camera, recording.T_OC, RawlogWriter::imageName("CAM", image.t_ns, extension)));
				break;
			}
		}
		if (!job.proceed(static_cast<double>(done + 1) / static_cast<double>(events.size())))
			throw Error("interrupted: " + job.rawlog_path + " was not written");
	}
	writer.close();

	ImportResult result;
	result.images = recording.images.size();
	result.imu_samples = recording.imu.size();
	result.odometry_samples = recording.odometry.size();
	result.ground_truth_poses = recording.ground_truth.size();
	result.duration_s = secondsBetween(events.front().t_ns, events.back().t_ns);
	if (!recording.ground_truth.empty())
	{
		result.ground_truth_path = besideRawlog(job.rawlog_path, kGroundTruthEnding);
		recording.ground_truth.saveTum(result.ground_truth_path);
	}
	result.notes = putAsideOthers(job.rawlog_path, {result.ground_truth_path});
	return result;
}
}  // namespace viwo
