#pragma once

#include "Frame.h"

#include <viwo/core/Pose3.h>

#include <Eigen/Core>
#include <map>
#include <memory>
#include <vector>

namespace viwo
{
class ReprojectionResidual;

/** One sighting of a landmark. The factor is made on demand, against the landmark's anchor. */
struct Sighting
{
	Frame* frame = nullptr;
	Eigen::Vector3d bearing_C = Eigen::Vector3d::UnitZ();
	std::shared_ptr<ReprojectionResidual> factor;
};

/** A corner seen by several frames of the window; the first of them is its anchor. */
struct Landmark
{
	uint64_t id = 0;
	std::vector<Sighting> sightings;
	double inverse_depth_1_m = 0;  //!< inverse distance along the anchor's bearing; a solver block
	double deviation = 1e9;        //!< of the inverse depth, relative, given the poses
	bool in_use = false;           //!< has a depth and takes part in the problem
	std::shared_ptr<LocalCost> prior_factor;

	Frame& anchor() const { return *sightings.front().frame; }
};

/** All tracks of the window, ordered by id so that everything made from them is repeatable. */
class LandmarkMap
{
   public:
	struct Settings
	{
		double sigma_rad = 1;  //!< noise of a bearing
		double prior_mean_1_m = 0.25, prior_sigma_1_m = 5;
		double outlier_rad = 1;  //!< mean error that throws a landmark out
		double known_deviation = 0.3;
	};

	explicit LandmarkMap(const Settings& settings) : settings_(settings) {}

	void clear() { landmarks_.clear(); }

	/** Adds the frame's tracks to those that there are. The frame must outlive its sightings. */
	void add(Frame& frame);

	/** Forgets what a frame saw; landmarks anchored there move to their next sighting, with the same point in space. */
	void forget(const Frame& frame, const Pose3& T_BC);

	/** Landmarks anchored in a frame leave with it; their tracks begin anew with later frames. */
	void eraseAnchoredIn(const Frame& frame);

	/** Gives a depth to tracks that two frames or more have seen, from the poses of the frames and the prior of the settings. */
	void triangulate(const Pose3& T_BC);

	/** Refreshes every deviation and throws out landmarks that lie behind a camera or fit badly. @return how many were thrown out. */
	int assess(const Pose3& T_BC);

	/** Landmarks of known depth that this frame sees. */
	int countKnown(const Frame& frame) const;
	/** Landmarks in use, of whatever depth, that this frame sees. */
	int countSeen(const Frame& frame) const;

	std::map<uint64_t, Landmark>& all() { return landmarks_; }
	const std::map<uint64_t, Landmark>& all() const { return landmarks_; }
	const Settings& settings() const { return settings_; }

   private:
	bool estimateDepth(Landmark& landmark, const Pose3& T_BC) const;

	Settings settings_;
	std::map<uint64_t, Landmark> landmarks_;
};
}  // namespace viwo
