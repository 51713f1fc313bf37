#include <viwo/sfm/StructureFromMotion.h>

#include <algorithm>
#include <cmath>

#include "BundleAdjustment.h"
#include "Scene.h"
#include "Tracks.h"
#include "TwoView.h"

namespace viwo
{
namespace
{
using namespace sfm;
constexpr size_t kMinFrames = 5;
constexpr int kAdjustmentRounds = 3;
constexpr double kGrossFactor = 3;         // before adjustment
constexpr double kMinInverseDepth = 1e-3;  // of the unit homogeneous vector: farther points have no position worth telling

struct StartingPair
{
	int frame = -1;
	double parallax_rad = 0;
	std::vector<Correspondence> pairs;
	SfmStatus status = SfmStatus::few_correspondences;
};

/** The frame that, with the last one, promises the best geometry: much parallax over many tracks. */
StartingPair chooseReference(const std::vector<Track>& tracks, int last, const SfmOptions& options)
{
	StartingPair best;
	double best_score = 0;
	for (int k = 0; k < last; ++k)
	{
		std::vector<Correspondence> pairs = correspondences(tracks, k, last);
		if (static_cast<int>(pairs.size()) < options.min_correspondences) continue;
		const double parallax = rotationFreeParallax_rad(pairs);
		if (best.status == SfmStatus::few_correspondences) best.status = SfmStatus::not_enough_parallax;
		best.parallax_rad = std::max(best.parallax_rad, parallax);
		if (parallax < options.min_parallax_rad) continue;
		const double score = parallax * std::sqrt(static_cast<double>(pairs.size()));
		if (score <= best_score) continue;
		best_score = score;
		best = {k, parallax, std::move(pairs), SfmStatus::ok};
	}
	return best;
}

void triangulateNew(Scene& scene)
{
	for (ScenePoint& point : scene.points)
		if (!point.X) point.X = triangulate(point.track, scene.T_r_ck);
}

/** Places the frame from the points seen so far, starting at its neighbour's pose (and the prior's turn between the two). */
bool placeFrame(Scene& scene, int frame, int neighbour, const std::vector<Eigen::Quaterniond>& prior, const SfmOptions& options)
{
	Pose3 guess = scene.T_r_ck[static_cast<size_t>(neighbour)].value();
	if (!prior.empty()) guess.R = guess.R * prior[static_cast<size_t>(neighbour)].conjugate() * prior[static_cast<size_t>(frame)];
	const AdjustmentSettings settings{options.sigma_rad, options.max_iterations};
	const std::optional<Pose3> T = resect(scene, frame, guess, options.min_correspondences / 2, settings);
	if (!T) return false;
	scene.T_r_ck[static_cast<size_t>(frame)] = T;
	triangulateNew(scene);
	return true;
}

bool placeAllFrames(Scene& scene, const std::vector<Eigen::Quaterniond>& prior, const SfmOptions& options)
{
	triangulateNew(scene);
	for (int k = scene.reference + 1; k < scene.scale_frame; ++k)
		if (!placeFrame(scene, k, k - 1, prior, options)) return false;
	for (int k = scene.reference - 1; k >= 0; --k)
		if (!placeFrame(scene, k, k + 1, prior, options)) return false;
	return true;
}

/** Adjusts, takes out what is false, and again. */
bool adjustWithoutOutliers(Scene& scene, const SfmOptions& options)
{
	const AdjustmentSettings settings{options.sigma_rad, options.max_iterations};
	removeFalsePoints(scene, kGrossFactor * options.outlier_sigmas * options.sigma_rad);
	for (int round = 0; round < kAdjustmentRounds; ++round)
	{
		removeVaguePoints(scene, options.sigma_rad);
		if (!adjust(scene, settings)) return false;
		if (removeOutliers(scene, options.outlier_sigmas * options.sigma_rad) == 0) break;
		if (round + 1 == kAdjustmentRounds && !adjust(scene, settings)) return false;
	}
	const auto count = std::count_if(scene.points.begin(), scene.points.end(), [](const ScenePoint& p) { return p.X.has_value(); });
	return count >= options.min_points && rms_rad(scene) <= options.max_rms_sigmas * options.sigma_rad;
}

void report(const Scene& scene, SfmResult& result)
{
	const Pose3 T_c0_r = scene.T_r_ck.front().value().inverse();
	for (const auto& T : scene.T_r_ck) result.T_c0_ck.push_back(T_c0_r * T.value());
	for (const ScenePoint& point : scene.points)
	{
		if (!point.X || point.X->w() < kMinInverseDepth) continue;
		const Eigen::Vector3d p_r = point.X->head<3>() / point.X->w();
		result.points.push_back({point.track.id, T_c0_r * p_r});
	}
	result.rms_rad = rms_rad(scene);
}
}  // namespace

const char* toString(SfmStatus status)
{
	switch (status)
	{
		case SfmStatus::ok:
			return "ok";
		case SfmStatus::too_few_frames:
			return "too few frames";
		case SfmStatus::few_correspondences:
			return "few correspondences";
		case SfmStatus::not_enough_parallax:
			return "not enough parallax";
		case SfmStatus::essential_failed:
			return "no relative pose fits";
		case SfmStatus::pnp_failed:
			return "a frame cannot be placed";
		case SfmStatus::ba_failed:
			return "bundle adjustment failed";
	}
	return "unknown";
}

SfmResult StructureFromMotion::reconstruct(const std::vector<FeatureFrame>& frames,
                                           const std::vector<Eigen::Quaterniond>& R_c0_ck_prior) const
{
	SfmResult result;
	if (frames.size() < kMinFrames) return result;
	const std::vector<Eigen::Quaterniond> prior = R_c0_ck_prior.size() == frames.size() ? R_c0_ck_prior : std::vector<Eigen::Quaterniond>();
	const int last = static_cast<int>(frames.size()) - 1;
	const std::vector<Track> tracks = collectTracks(frames);

	const StartingPair start = chooseReference(tracks, last, options_);
	result.status = start.status;
	result.parallax_rad = start.parallax_rad;
	if (start.status != SfmStatus::ok) return result;
	result.reference = start.frame;
	result.correspondences = static_cast<int>(start.pairs.size());

	std::optional<Eigen::Quaterniond> R_prior;
	if (!prior.empty()) R_prior = prior[static_cast<size_t>(start.frame)].conjugate() * prior.back();
	const std::optional<Pose3> T_r_last = relativePose(start.pairs, R_prior, options_.sigma_rad, options_.outlier_sigmas);
	result.status = SfmStatus::essential_failed;
	if (!T_r_last) return result;

	Scene scene;
	scene.T_r_ck.resize(frames.size());
	scene.reference = start.frame;
	scene.scale_frame = last;
	scene.T_r_ck[static_cast<size_t>(start.frame)] = Pose3();
	scene.T_r_ck.back() = T_r_last;
	for (const Track& track : tracks) scene.points.push_back({track, std::nullopt});
	result.status = SfmStatus::pnp_failed;
	if (!placeAllFrames(scene, prior, options_)) return result;

	result.status = SfmStatus::ba_failed;
	if (!adjustWithoutOutliers(scene, options_)) return result;
	report(scene, result);
	result.interval_covariance = intervalCovariance(scene, std::max(options_.sigma_rad, result.rms_rad));
	if (result.interval_covariance.size() > 0) result.status = SfmStatus::ok;
	return result;
}
}  // namespace viwo
