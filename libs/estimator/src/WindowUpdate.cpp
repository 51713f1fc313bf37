#include "WindowUpdate.h"

#include "ImuPreintegration.h"
#include "WheelPreintegration.h"
#include "residuals/BlockAlgebra.h"
#include "residuals/LinearPrior.h"
#include "residuals/RandomWalkResidual.h"

#include <viwo/core/Scalars.h>
#include <viwo/core/Time.h>

#include <algorithm>
#include <cmath>

namespace viwo
{
namespace
{
/** VINS-Mono states its parallax threshold at this focal length. */
constexpr double kReferenceFocal_px = 460;
/** Without images, frames are kept at this spacing. */
constexpr double kBlindKeyframe_s = 0.5;
/** Below this distance the floor is the same. */
constexpr double kSameFloor_m = 1e-3;

bool touches(const Factor& factor, const std::vector<double*>& blocks)
{
	return std::any_of(factor.blocks.begin(), factor.blocks.end(),
	                   [&](double* b) { return std::find(blocks.begin(), blocks.end(), b) != blocks.end(); });
}

/** The floor drifts with the distance driven: from here on the window's factors are on a new plane state, tied to the old one by the drift.
 */
void walkPlane(Window& w, double distance_m, std::vector<double*>& eliminated)
{
	if (!w.options.usePlaneFactor() || w.options.factors.plane_pairwise || distance_m < kSameFloor_m) return;
	const PriorOptions& p = w.options.priors;
	const double sigma_tilt_rad = p.plane_walk_tilt_deg_sqrtm * kDegree * std::sqrt(distance_m);
	const double sigma_height_m = p.plane_walk_height_m_sqrtm * std::sqrt(distance_m);
	double* const old_plane = w.plane().data();
	const std::array<double, 3> value = w.plane();
	w.current_plane = 1 - w.current_plane;
	w.plane() = value;
	const auto walk = std::make_shared<RandomWalkResidual>(Eigen::Vector3d(sigma_tilt_rad, sigma_tilt_rad, sigma_height_m));
	w.start_priors.push_back({walk, nullptr, {old_plane, w.plane().data()}});
	eliminated.push_back(old_plane);
}

void marginalizeOldest(Window& w)
{
	Frame& oldest = *w.frames.front();
	std::vector<double*> blocks{oldest.pose.data(), oldest.motion.data()};
	for (auto& [id, landmark] : w.landmarks.all())
		if (landmark.in_use && &landmark.anchor() == &oldest) blocks.push_back(&landmark.inverse_depth_1_m);
	const auto& wheels = w.frames[1]->interval.wheels;
	const double distance_m = wheels ? wheels->distance_m() : (w.frames[1]->state().T_WB.p - oldest.state().T_WB.p).norm();
	walkPlane(w, distance_m, blocks);
	marginalizeBlocks(w, blocks);
	w.landmarks.eraseAnchoredIn(oldest);
	w.frames.pop_front();
	w.frames.front()->interval = {};
	w.frames.front()->imu_factor.reset();
	w.frames.front()->wheel_factor.reset();
}

/** Removes a frame and what it saw; if the prior holds its states, they are eliminated from it. */
void removeFrame(Window& w, size_t index)
{
	w.landmarks.forget(*w.frames[index], w.T_BC_pose());
	const std::unique_ptr<Frame> frame = std::move(w.frames[index]);
	w.frames.erase(w.frames.begin() + static_cast<std::ptrdiff_t>(index));
	marginalizeBlocks(w, {frame->pose.data(), frame->motion.data()});
}

void mergeSecondLatest(Window& w)
{
	const size_t second = w.frames.size() - 2;
	Frame& latest = w.latest();
	Interval merged = w.frames[second]->interval;
	if (merged.imu) merged.imu->append(*latest.interval.imu);
	if (merged.wheels) merged.wheels->append(*latest.interval.wheels);
	latest.interval = merged;
	latest.imu_factor.reset();
	latest.wheel_factor.reset();
	removeFrame(w, second);
}

/** Whether the intervals before and after the second-latest frame can be composed: the same sensors speak in both. */
bool mergeable(const Window& w)
{
	const Interval &one = w.frames[w.frames.size() - 2]->interval, &two = w.latest().interval;
	return (one.imu || one.wheels) && !one.imu == !two.imu && !one.wheels == !two.wheels;
}

/** The frame kept for its time before this one goes, and its measurements become a link between its neighbours. */
void marginalizeTimed(Window& w, size_t index)
{
	w.landmarks.forget(*w.frames[index], w.T_BC_pose());
	marginalizeBlocks(w, {w.frames[index]->pose.data(), w.frames[index]->motion.data()});
	Frame& next = *w.frames[index + 1];
	next.interval = {};
	next.imu_factor.reset();
	next.wheel_factor.reset();
	w.frames.erase(w.frames.begin() + static_cast<std::ptrdiff_t>(index));
}
}  // namespace

void marginalizeBlocks(Window& w, const std::vector<double*>& blocks)
{
	Marginalizer marginalizer;
	bool any = false;
	for (const Factor& factor : collectFactors(w))
	{
		const bool is_prior = factor.cost == w.prior;
		const bool touching = touches(factor, blocks);
		if (touching || is_prior) marginalizer.add(factor);
		any = any || touching;
	}
	if (!any) return;
	for (double* block : blocks) marginalizer.eliminate(block);
	const MarginalizationResult result = marginalizer.run();
	w.start_priors.erase(std::remove_if(w.start_priors.begin(), w.start_priors.end(), [&](const Factor& f) { return touches(f, blocks); }),
	                     w.start_priors.end());
	w.prior = result.usable() ? result.makeCost() : nullptr;
	w.prior_blocks = result.usable() ? result.blocks : std::vector<double*>();
}

bool isKeyframe(const Window& w, const Frame& frame, const Frame& previous)
{
	const double interval_s = secondsBetween(previous.t_ns, frame.t_ns);
	if (frame.features.features.empty()) return interval_s >= kBlindKeyframe_s;
	const Eigen::Quaterniond R_CB = w.T_BC_pose().R.conjugate();
	const Eigen::Quaterniond R_BpBc = poseFromBlock(previous.pose.data()).R.conjugate() * poseFromBlock(frame.pose.data()).R;
	const Eigen::Quaterniond R_CpCc = R_CB * R_BpBc * R_CB.conjugate();
	double sum_rad = 0;
	int common = 0;
	auto p = previous.features.features.begin();
	for (const FeatureObservation& f : frame.features.features)
	{
		while (p != previous.features.features.end() && p->id < f.id) ++p;
		if (p == previous.features.features.end()) break;
		if (p->id != f.id) continue;
		sum_rad += (R_CpCc * f.bearing_C).cross(p->bearing_C).norm();
		++common;
	}
	if (common < w.options.window.keyframe_min_tracked) return true;
	return sum_rad / common * kReferenceFocal_px >= w.options.window.keyframe_parallax_px;
}

void thinOutWaitingFrames(Window& w)
{
	if (w.frames.size() <= static_cast<size_t>(w.options.window.keyframes)) return;
	const size_t second = w.frames.size() - 2;
	const Frame& before = *w.frames[second - 1];
	const bool short_enough = secondsBetween(before.t_ns, w.latest().t_ns) <= w.options.window.max_interval_s;
	if (mergeable(w) && short_enough && !isKeyframe(w, *w.frames[second], before))
	{
		mergeSecondLatest(w);
		return;
	}
	w.landmarks.forget(*w.frames.front(), w.T_BC_pose());
	w.frames.pop_front();
	w.frames.front()->interval = {};
}

void dropFramesBeforeWheels(Window& w)
{
	size_t first = w.frames.size() - 1;
	while (first > 0 && w.frames[first]->interval.wheels) --first;
	if (first + 1 == w.frames.size()) return;
	for (; first > 0; --first)
	{
		w.landmarks.forget(*w.frames.front(), w.T_BC_pose());
		w.frames.pop_front();
	}
	w.frames.front()->interval = {};
}

Fate advanceWindow(Window& w)
{
	if (w.frames.size() < 3) return Fate::kept_growing;
	const size_t second = w.frames.size() - 2;
	Frame& candidate = *w.frames[second];
	const Frame& before = *w.frames[second - 1];
	const bool full = w.frames.size() > static_cast<size_t>(w.options.window.keyframes);
	candidate.keyframe = candidate.keyframe || !mergeable(w) || isKeyframe(w, candidate, before);
	if (candidate.keyframe)
	{
		if (!full) return Fate::kept_growing;
		marginalizeOldest(w);
		return Fate::kept_oldest_marginalized;
	}
	if (secondsBetween(before.t_ns, w.latest().t_ns) <= w.options.window.max_interval_s)
	{
		mergeSecondLatest(w);
		return Fate::merged;
	}
	candidate.timed = true;
	if (before.timed)
		marginalizeTimed(w, second - 1);
	else if (full)
		marginalizeOldest(w);
	return Fate::kept_timed;
}
}  // namespace viwo
