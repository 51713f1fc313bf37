#pragma once

#include <viwo/core/Calibration.h>
#include <viwo/core/NavState.h>
#include <viwo/estimator/InitializerOptions.h>
#include <viwo/sfm/StructureFromMotion.h>

#include <vector>

#include "Belief.h"
#include "GyroBiasAlignment.h"
#include "ImuPreintegration.h"
#include "ScaleAlignment.h"
#include "WheelPreintegration.h"

namespace viwo
{
enum class InitializerStatus
{
	ok,
	no_reconstruction,  //!< SfmResult is not ok, or the intervals do not match its frames
	bad_gyro_bias,      //!< too large, or vision's turns do not fit the gyroscope's
	ill_conditioned,
	bad_gravity,
	negative_scale,
	bad_residual
};

const char* toString(InitializerStatus status);

struct InitializerResult
{
	InitializerStatus status = InitializerStatus::no_reconstruction;
	GyroBiasResult gyro;
	ScaleResult alignment;
};

/** Vision-aligned initialisation (Niu et al. Sec. 5): turns a reconstruction up to scale into metric states. Deterministic, never throws.
 */
class Initializer
{
   public:
	/** @param calibration with the belief's T_BC. @param belief at whose biases and wheels the intervals are integrated. */
	Initializer(const Calibration& calibration, const Belief& belief, double gravity_m_s2, const InitializerOptions& options)
	    : calibration_(calibration), belief_(belief), gravity_m_s2_(gravity_m_s2), options_(options)
	{
	}

	/** @param imu one an interval between the reconstruction's frames; left re-propagated at the gyroscope bias found.
	 *  @param wheels the same, or empty.
	 */
	InitializerResult align(const SfmResult& sfm, std::vector<ImuPreintegration>& imu,
	                        const std::vector<WheelPreintegration>& wheels) const;

	/** States of all frames in W: z up, O of frame `origin` at the position and yaw of T_WO_origin (its roll and pitch are the measured
	 * ones). Accelerometer biases are those the intervals were integrated at.
	 *  @param result of align() with status ok. @param imu as align() left them.
	 */
	std::vector<NavState> navStates(const InitializerResult& result, const std::vector<ImuPreintegration>& imu, size_t origin,
	                                const Pose3& T_WO_origin = {}) const;

   private:
	Pose3 poseOfC0(const InitializerResult& result, size_t origin, const Pose3& T_WO_origin) const;

	Calibration calibration_;
	Belief belief_;
	double gravity_m_s2_;
	InitializerOptions options_;
};
}  // namespace viwo
