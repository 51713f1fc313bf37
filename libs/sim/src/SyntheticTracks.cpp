#include <viwo/sim/RandomSource.h>
#include <viwo/sim/SyntheticTracks.h>

#include <algorithm>
#include <cmath>

namespace viwo::sim
{
namespace
{
using Eigen::Vector2d;
using Eigen::Vector3d;

class Tracker
{
   public:
	Tracker(const Calibration& calibration, const std::vector<Vector3d>& points_W, const TrackOptions& options, uint64_t seed)
	    : calibration_(calibration),
	      points_W_(points_W),
	      options_(options),
	      tracks_(points_W.size()),
	      noise_generator_(randomSource(seed, "track noise")),
	      choice_generator_(randomSource(seed, "track choice"))
	{
		order_.resize(points_W.size());
		for (size_t i = 0; i < order_.size(); ++i) order_[i] = i;
	}

	FeatureFrame track(const Pose3& T_WC, int64_t t_ns)
	{
		FeatureFrame frame;
		frame.t_ns = t_ns;
		// Points are asked in a new order each time, so that new tracks are spread over the image.
		std::shuffle(order_.begin(), order_.end(), choice_generator_);
		std::vector<std::optional<Vector2d>> pixels(points_W_.size());
		for (size_t i = 0; i < points_W_.size(); ++i) pixels[i] = project(T_WC, points_W_[i]);
		size_t live = 0;
		for (size_t i = 0; i < points_W_.size(); ++i)
			if (keep(tracks_[i], pixels[i].has_value())) live++;
		for (const size_t i : order_)
		{
			if (live >= options_.max_features) break;
			if (tracks_[i].id != 0 || !pixels[i]) continue;
			tracks_[i] = {next_id_++, 0};
			live++;
		}
		for (size_t i = 0; i < points_W_.size(); ++i)
			if (tracks_[i].id != 0) frame.features.push_back(observe(tracks_[i], *pixels[i]));
		std::sort(frame.features.begin(), frame.features.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
		return frame;
	}

   private:
	struct Track
	{
		uint64_t id = 0;  //!< 0: not tracked
		int frames = 0;
	};

	std::optional<Vector2d> project(const Pose3& T_WC, const Vector3d& P_W) const
	{
		const Vector3d P_C = T_WC.inverse() * P_W;
		const double range_m = P_C.norm();
		if (range_m < options_.min_range_m || range_m > options_.max_range_m) return std::nullopt;
		const auto pixel = calibration_.camera.project(P_C);
		if (!pixel || !calibration_.camera.contains(*pixel, 4)) return std::nullopt;
		if (options_.visible && !options_.visible(T_WC.p, P_W)) return std::nullopt;
		return pixel;
	}

	bool keep(Track& track, bool in_view)
	{
		if (track.id == 0) return false;
		if (in_view && track.frames < options_.max_track_frames && uniform_(choice_generator_) >= options_.drop_probability) return true;
		track = {};
		return false;
	}

	FeatureObservation observe(Track& track, const Vector2d& exact_pixel)
	{
		track.frames++;
		FeatureObservation feature;
		feature.id = track.id;
		feature.pixel = exact_pixel;
		if (options_.outlier_probability > 0 && uniform_(noise_generator_) < options_.outlier_probability)
			feature.pixel = {uniform_(noise_generator_) * (calibration_.camera.width_px() - 1),
			                 uniform_(noise_generator_) * (calibration_.camera.height_px() - 1)};
		for (int i = 0; i < 2; ++i) feature.pixel[i] += options_.pixel_noise_px * normal_(noise_generator_);
		feature.bearing_C = calibration_.camera.unproject(feature.pixel);
		return feature;
	}

	const Calibration& calibration_;
	const std::vector<Vector3d>& points_W_;
	const TrackOptions& options_;
	std::vector<Track> tracks_;
	std::vector<size_t> order_;
	std::mt19937_64 noise_generator_, choice_generator_;
	std::normal_distribution<double> normal_;
	std::uniform_real_distribution<double> uniform_;
	uint64_t next_id_ = 1;
};
}  // namespace

std::function<bool(const Vector3d&, const Vector3d&)> visibleIn(const World& world)
{
	return [&world](const Vector3d& from_W, const Vector3d& point_W)
	{
		const Vector3d way = point_W - from_W;
		const double range_m = way.norm(), touching_m = 1e-4;
		return range_m > touching_m && !world.castRay(from_W, way / range_m, range_m - touching_m);
	};
}

std::vector<Vector3d> randomRoomPoints(const Vector3d& min_W, const Vector3d& max_W, size_t n, uint64_t seed)
{
	std::mt19937_64 generator = randomSource(seed, "room points");
	std::uniform_real_distribution<double> uniform;
	const Vector3d size = max_W - min_W;
	const double areas[] = {size.y() * size.z(), size.z() * size.x(), size.x() * size.y()};
	std::discrete_distribution<int> face_axis(std::begin(areas), std::end(areas));
	std::vector<Vector3d> points;
	for (size_t i = 0; i < n; ++i)
	{
		const int axis = face_axis(generator);
		Vector3d s;
		for (int k = 0; k < 3; ++k) s[k] = uniform(generator);
		s[axis] = s[axis] < 0.5 ? 0 : 1;
		points.push_back(min_W + size.cwiseProduct(s));
	}
	return points;
}

std::vector<FeatureFrame> makeFeatureFrames(const Motion& motion, const Calibration& calibration, const std::vector<Vector3d>& points_W,
                                            const TrackOptions& options, uint64_t seed)
{
	Tracker tracker(calibration, points_W, options, seed);
	std::vector<FeatureFrame> frames;
	const double end_s = options.end_s < 0 ? motion.duration_s() : std::min(options.end_s, motion.duration_s());
	for (int64_t i = 0;; ++i)
	{
		const double t_s = options.begin_s + static_cast<double>(i) / options.rate_hz;
		if (t_s > end_s + 5e-10) break;
		const int64_t t_ns = motion.stamp_ns(t_s) - nanoseconds(options.clock_offset_s);
		frames.push_back(tracker.track(motion.at(t_s).T_WO * calibration.T_OC, t_ns));
	}
	return frames;
}

std::vector<FeatureFrame> makeFeatureFrames(const Motion& motion, const Calibration& calibration, const std::vector<Vector3d>& points_W,
                                            double pixel_noise_px, uint64_t seed)
{
	TrackOptions options;
	options.pixel_noise_px = pixel_noise_px;
	return makeFeatureFrames(motion, calibration, points_W, options, seed);
}
}  // namespace viwo::sim
