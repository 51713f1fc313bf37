#pragma once

#include <viwo/core/FeatureFrame.h>
#include <viwo/core/Options.h>
#include <viwo/core/Pose3.h>

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace viwo
{
/** Angles on the unit sphere of bearings: one pixel is 1/f rad. */
struct SfmOptions : Options<SfmOptions>
{
	double sigma_rad = 2e-3;
	double min_parallax_rad = 0.01;
	int min_correspondences = 20;
	int min_points = 20;
	double max_rms_sigmas = 2.5;
	double outlier_sigmas = 4;
	int max_iterations = 50;

	template <class Visitor>
	void visit(Visitor& v)
	{
		v("sigma_rad", sigma_rad, "standard deviation of a tracked bearing, per axis (pixel noise / focal length)", 1e-6, 0.1);
		v("min_parallax_rad", min_parallax_rad,
		  "70th percentile of the angles between two frames' bearings that no rotation explains, at least", 0.0, 1.0);
		v("min_correspondences", min_correspondences, "tracks that two frames must share", 8, 1000);
		v("min_points", min_points, "points that the reconstruction must have", 8, 1000);
		v("max_rms_sigmas", max_rms_sigmas, "reprojection error after adjustment over sigma_rad, at most", 0.1, 100.0);
		v("outlier_sigmas", outlier_sigmas, "an observation farther off than this is taken out", 1.0, 100.0);
		v("max_iterations", max_iterations, "of the bundle adjustment", 1, 1000);
	}
};

enum class SfmStatus
{
	ok,
	too_few_frames,
	few_correspondences,  //!< no earlier frame shares enough tracks with the last
	not_enough_parallax,  //!< standing, turning on the spot, or all is far away
	essential_failed,     //!< no relative pose that enough tracks agree with
	pnp_failed,           //!< a frame between could not be placed
	ba_failed             //!< bundle adjustment did not converge to a small error
};

const char* toString(SfmStatus status);

/** A point of the reconstruction. */
struct SfmPoint
{
	uint64_t id = 0;
	Eigen::Vector3d p_c0 = Eigen::Vector3d::Zero();  //!< in the first camera frame, units of the reconstruction
};

/** Motion of the camera up to scale. Meaningful when status is ok. */
struct SfmResult
{
	SfmStatus status = SfmStatus::too_few_frames;
	std::vector<Pose3> T_c0_ck;    //!< one a frame; positions up to one common scale
	std::vector<SfmPoint> points;  //!< by id
	/** Joint covariance of the motion from each frame k to the next, 6(n-1) square: of interval k rows 6k..6k+5 are [dp, dphi], position of
	 * c(k+1) in ck's axes (units of the reconstruction) and right perturbation of R_ck_ck+1, for the larger of sigma_rad and the measured
	 * residual.
	 */
	Eigen::MatrixXd interval_covariance;
	double rms_rad = 0;       //!< per axis, after adjustment, without outliers
	double parallax_rad = 0;  //!< of the pair that the reconstruction starts from
	int reference = -1;       //!< the earlier frame of that pair; the later is the last
	int correspondences = 0;  //!< of that pair
};

/** Vision-only reconstruction of a short window, as VINS-Mono (Qin et al. 2018, Sec. V-A) and Niu et al. Sec. 5.1 start: relative pose of
 *  the pair with most parallax, triangulation, resection of the other frames, bundle adjustment. Deterministic.
 */
class StructureFromMotion
{
   public:
	explicit StructureFromMotion(const SfmOptions& options) : options_(options) {}

	/** @param frames at least 5, in order of time.
	 *  @param R_c0_ck_prior one a frame, e.g. integrated from the gyroscope, or empty. Only a starting point: the result is vision's own.
	 */
	SfmResult reconstruct(const std::vector<FeatureFrame>& frames, const std::vector<Eigen::Quaterniond>& R_c0_ck_prior = {}) const;

   private:
	SfmOptions options_;
};
}  // namespace viwo
