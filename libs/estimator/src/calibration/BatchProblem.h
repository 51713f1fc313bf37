#pragma once

#include "FactorSet.h"
#include "LandmarkMap.h"
#include "calibration/BatchStates.h"

#include <vector>

namespace viwo
{
enum class BatchGroup
{
	prior,
	image,
	imu,
	wheels,
	floor,
	reference
};

struct BatchFactor
{
	Factor factor;
	BatchGroup group = BatchGroup::prior;
};

/** How much the measurements are trusted in this round. */
struct BatchTrust
{
	double pixel_sigma_px = 1;  //!< of one sighting
	/** How much more the mean of a track's errors varies than that of independent ones would: its sightings are weighed down by it. */
	double track_factor = 1;
	double outlier_px = 5;  //!< mean error that throws a landmark out
};

/** All factors of the log but the priors of the rig, in a fixed order. Landmarks are triangulated anew: those of the map are replaced.
 * Wheel factors of frames that are marked as slipping are left out. */
std::vector<BatchFactor> collectBatch(const BatchCalibrationInput& input, const BatchCalibrationOptions& options,
                                      const EstimatorOptions& estimator, const BatchTrust& trust, const std::vector<bool>& slipping,
                                      BatchStates& states, LandmarkMap& landmarks);

LandmarkMap::Settings batchLandmarkSettings(const BatchCalibrationInput& input, const EstimatorOptions& estimator, const BatchTrust& trust);
}  // namespace viwo
