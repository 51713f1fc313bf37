#include <viwo/core/Error.h>
#include <viwo/frontend/FeatureTracker.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "Brightness.h"
#include "CornerDetector.h"
#include "EpipolarGate.h"
#include "OpticalFlow.h"
#include "ReferencePatch.h"

namespace viwo
{
namespace
{
constexpr int kClaheTiles = 8;
constexpr double kGainTolerance = 0.005;       // below this the optical flow's bias is under 0.02 px
constexpr double kCrowdedShare = 0.5;          // of min_distance_px
constexpr float kLargestMagnification = 2.5f;  // of area; beyond, and below the inverse, reference and image differ in detail
constexpr double kBlurredShare = 0.5;          // of the corners: when more look changed, it is the image that is, by blur or light
constexpr int kSmallestSide_px = 20;           // of the pyramid level on which brightness is compared

struct Track
{
	FeatureObservation observation;
	cv::Point2f pixel;
	std::optional<ReferencePatch> reference = std::nullopt;  //!< none only when references are switched off
};

std::string sizeText(const cv::Size& s)
{
	return std::to_string(s.width) + "x" + std::to_string(s.height);
}

cv::Mat loadMask(const cv::Mat& given, const std::string& path, const cv::Size& size)
{
	cv::Mat mask = given;
	if (mask.empty() && !path.empty())
	{
		mask = cv::imread(path, cv::IMREAD_GRAYSCALE);
		if (mask.empty()) throw Error("image mask '" + path + "' cannot be read: give an image file in mask_path, or leave it empty");
	}
	if (mask.empty()) return mask;
	if (mask.type() != CV_8UC1 || mask.size() != size)
		throw Error("image mask " + (path.empty() ? std::string() : "'" + path + "' ") + "is " + sizeText(mask.size()) +
		            " while the camera has " + sizeText(size) + ": give an 8-bit grey image of the camera's size");
	return mask.clone();
}
}  // namespace

class FeatureTracker::Impl
{
   public:
	Impl(const CameraModel& camera, const TrackerOptions& options, const cv::Mat& mask)
	    : camera_(camera),
	      options_(options),
	      size_(camera.width_px(), camera.height_px()),
	      detector_(size_, options, loadMask(mask, options.mask_path, size_)),
	      clahe_(cv::createCLAHE(options.clahe_clip, cv::Size(kClaheTiles, kClaheTiles)))
	{
	}

	FeatureFrame track(int64_t t_ns, const cv::Mat& grey, const std::optional<Eigen::Quaterniond>& R_Cprev_Ccur)
	{
		stats_ = {};
		FeatureFrame frame;
		frame.t_ns = t_ns;
		stats_.usable = isUsable(grey);
		if (!stats_.usable)
		{
			reset();
			return frame;
		}
		FlowImage current(conditioned(grey), options_);
		if (!previous_.empty())
		{
			matchBrightness(current);
			follow(current, R_Cprev_Ccur);
		}
		detect(current);
		previous_ = std::move(current);
		frame.features.reserve(tracks_.size());
		for (const Track& t : tracks_) frame.features.push_back(t.observation);
		return frame;
	}

	void reset()
	{
		tracks_.clear();
		previous_ = {};
	}

	const TrackerStats& stats() const { return stats_; }

   private:
	bool isUsable(const cv::Mat& grey) const
	{
		if (grey.empty()) return false;
		if (grey.type() != CV_8UC1 || grey.size() != size_)
			throw Error("image is " + sizeText(grey.size()) + (grey.type() == CV_8UC1 ? "" : " and not 8-bit grey") +
			            " while the calibration is for " + sizeText(size_) + " grey: give the calibration of these images");
		return hasLight(grey, options_.dark_level, options_.overexposed_share);
	}

	/** A copy, because the caller may reuse its buffer. */
	cv::Mat conditioned(const cv::Mat& grey) const
	{
		cv::Mat result;
		if (options_.clahe)
			clahe_->apply(grey, result);
		else
			grey.copyTo(result);
		return result;
	}

	/** Optical flow takes a change of exposure for motion: give the previous image the brightness of the new one. */
	void matchBrightness(const FlowImage& current)
	{
		int level = std::min(previous_.levels(), current.levels()) - 1;
		while (level > 0 && std::min(current.level(level).rows, current.level(level).cols) < kSmallestSide_px) --level;
		stats_.gain = brightnessRatio(previous_.level(level), current.level(level));
		if (options_.gain_compensation && std::abs(stats_.gain - 1) > kGainTolerance)
			previous_ = FlowImage(withGain(previous_.grey(), stats_.gain), options_);
	}

	void follow(const FlowImage& current, const std::optional<Eigen::Quaterniond>& R_Cprev_Ccur)
	{
		std::vector<Track> expected;
		std::vector<cv::Point2f> from, to;
		for (Track& t : tracks_)
		{
			const std::optional<cv::Point2f> prediction = predicted(t, R_Cprev_Ccur);
			if (!prediction) continue;
			from.push_back(t.pixel);
			to.push_back(*prediction);
			expected.push_back(std::move(t));
		}
		stats_.lost_flow += static_cast<int>(tracks_.size() - expected.size());
		tracks_ = std::move(expected);
		const std::vector<FlowStatus> status = followCorners(previous_, current, from, options_, to);

		std::vector<Track> followed;
		std::vector<BearingPair> pairs;
		for (size_t i = 0; i < tracks_.size(); ++i)
		{
			if (status[i] == FlowStatus::inconsistent) ++stats_.lost_forward_backward;
			const bool inside = status[i] == FlowStatus::tracked && isInside(to[i]);
			if (status[i] == FlowStatus::lost || (status[i] == FlowStatus::tracked && !inside)) ++stats_.lost_flow;
			if (!inside) continue;
			followed.push_back(std::move(tracks_[i]));
			followed.back().pixel = to[i];
		}
		putBack(followed, current.grey());
		for (Track& t : followed)
		{
			const Eigen::Vector3d before = t.observation.bearing_C;
			t.observation = observationAt(t.observation.id, t.pixel);
			pairs.push_back({before, t.observation.bearing_C});
		}
		const std::vector<bool> rigid = gate(pairs, R_Cprev_Ccur);
		tracks_.clear();
		for (size_t i = 0; i < followed.size(); ++i)
		{
			if (!rigid[i])
				++stats_.lost_ransac;
			else if (!detector_.allowed(followed[i].pixel) || isCrowded(followed[i].pixel))
				++stats_.lost_crowded;
			else
				tracks_.push_back(std::move(followed[i]));
		}
		stats_.tracked = static_cast<int>(tracks_.size());
	}

	/** Nothing where the rotation takes the corner out of the image. */
	std::optional<cv::Point2f> predicted(const Track& t, const std::optional<Eigen::Quaterniond>& R_Cprev_Ccur) const
	{
		if (!R_Cprev_Ccur) return t.pixel;
		const Eigen::Vector3d bearing = R_Cprev_Ccur->conjugate() * t.observation.bearing_C;
		const std::optional<Eigen::Vector2d> pixel = camera_.project(bearing);
		if (!pixel || !camera_.contains(*pixel)) return std::nullopt;
		return cv::Point2f(static_cast<float>(pixel->x()), static_cast<float>(pixel->y()));
	}

	bool isInside(const cv::Point2f& p) const { return camera_.contains({p.x, p.y}, options_.border_px); }

	/** Moves corners from where optical flow took them to where their first sight is; those without a likeness are lost. */
	void putBack(std::vector<Track>& followed, const cv::Mat& grey)
	{
		if (options_.reference_px == 0) return;
		std::vector<std::optional<cv::Point2f>> found;
		for (Track& t : followed) found.push_back(t.reference->find(grey, t.pixel, options_));
		const auto changed = std::count_if(found.begin(), found.end(), [&](const auto& f) { return !f || !isInside(*f); });
		if (static_cast<double>(changed) > kBlurredShare * static_cast<double>(found.size())) return;
		std::vector<Track> alike;
		for (size_t i = 0; i < followed.size(); ++i)
		{
			if (!found[i] || !isInside(*found[i])) continue;
			alike.push_back(std::move(followed[i]));
			alike.back().pixel = *found[i];
			renewReference(alike.back(), grey);
		}
		stats_.lost_changed = static_cast<int>(changed);
		followed = std::move(alike);
	}

	void renewReference(Track& t, const cv::Mat& grey) const
	{
		const float m = t.reference->magnification();
		if (m < kLargestMagnification && m > 1 / kLargestMagnification) return;
		if (auto fresh = ReferencePatch::at(grey, t.pixel, options_.reference_px)) t.reference = std::move(fresh);
	}

	FeatureObservation observationAt(uint64_t id, const cv::Point2f& pixel) const
	{
		const Eigen::Vector2d exact(pixel.x, pixel.y);
		return {id, exact, camera_.unproject(exact)};
	}

	std::vector<bool> gate(const std::vector<BearingPair>& pairs, const std::optional<Eigen::Quaterniond>& R_Cprev_Ccur) const
	{
		EpipolarGateSettings settings;
		settings.threshold_rad = options_.ransac_px / camera_.meanFocal_px();
		settings.iterations = options_.ransac_iterations;
		settings.seed = static_cast<uint64_t>(options_.seed);
		if (!R_Cprev_Ccur) return agreeWithEssential(pairs, settings);
		settings.threshold_rad = std::max(settings.threshold_rad, options_.rotation_tolerance_rad);
		return agreeWithRotation(pairs, *R_Cprev_Ccur, settings);
	}

	/** tracks_ holds the older ones, which take precedence. */
	bool isCrowded(const cv::Point2f& pixel) const
	{
		const double limit = kCrowdedShare * options_.min_distance_px;
		return std::any_of(tracks_.begin(), tracks_.end(),
		                   [&](const Track& t)
		                   {
			                   const cv::Point2f d = t.pixel - pixel;
			                   return d.dot(d) < limit * limit;
		                   });
	}

	void detect(const FlowImage& current)
	{
		std::vector<cv::Point2f> taken;
		for (const Track& t : tracks_) taken.push_back(t.pixel);
		const int wanted = options_.max_features - static_cast<int>(tracks_.size());
		std::vector<cv::Point2f> fresh = detector_.detect(current.level(1), taken, wanted);
		detector_.refine(current.grey(), fresh);
		for (const cv::Point2f& p : fresh)
		{
			Track t{observationAt(next_id_, p), p};
			if (options_.reference_px > 0 && !(t.reference = ReferencePatch::at(current.grey(), p, options_.reference_px))) continue;
			tracks_.push_back(std::move(t));
			++next_id_;
			++stats_.detected;
		}
	}

	CameraModel camera_;
	TrackerOptions options_;
	cv::Size size_;
	CornerDetector detector_;
	cv::Ptr<cv::CLAHE> clahe_;
	FlowImage previous_;
	std::vector<Track> tracks_;  //!< by increasing id, i.e. the oldest first
	uint64_t next_id_ = 0;
	TrackerStats stats_;
};

FeatureTracker::FeatureTracker(const CameraModel& camera, const TrackerOptions& options, const cv::Mat& mask)
{
	if (camera.width_px() <= 0 || camera.height_px() <= 0 || camera.meanFocal_px() <= 0)
		throw Error(
		    "the camera has no calibration (size or focal length 0): record it in the images' cameraParams or give it in the "
		    "configuration");
	if (options.reference_px > 0 && options.reference_px % 2 == 0)
		throw Error("[tracker] reference_px = " + std::to_string(options.reference_px) +
		            ": the side of a patch with a middle pixel is odd");
	impl_ = std::make_unique<Impl>(camera, options, mask);
}
FeatureTracker::~FeatureTracker() = default;
FeatureTracker::FeatureTracker(FeatureTracker&&) noexcept = default;
FeatureTracker& FeatureTracker::operator=(FeatureTracker&&) noexcept = default;

FeatureFrame FeatureTracker::track(int64_t t_ns, const cv::Mat& grey, const std::optional<Eigen::Quaterniond>& R_Cprev_Ccur)
{
	return impl_->track(t_ns, grey, R_Cprev_Ccur);
}

void FeatureTracker::reset()
{
	impl_->reset();
}

const TrackerStats& FeatureTracker::stats() const
{
	return impl_->stats();
}
}  // namespace viwo
