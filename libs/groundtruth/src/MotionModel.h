#pragma once

#include "Registration.h"
#include "ScanCloud.h"
#include "Session.h"

#include <optional>

namespace viwo::gt
{
/** A motion between two scans and how well it is known. */
struct Motion2
{
	Pose2 T_ab;
	Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  //!< of (x, y, yaw), in a's axes
};

/** What odometry and gyroscope say of motions. */
class MotionModel
{
   public:
	/** @param distance_scale, turn_scale factors on odometry's ways and turns. */
	MotionModel(const Session& session, const MotionNoiseOptions& options, double distance_scale = 1, double turn_scale = 1)
	    : session_(session), options_(options), distance_scale_(distance_scale), turn_scale_(turn_scale)
	{
	}

	/** Nothing where there is no odometry for either scan. */
	std::optional<Motion2> between(size_t a, size_t b) const;

	/** Mean over the scan's neighbours; zero where unknown. */
	Twist2 twistAt(size_t scan) const;

	bool hasOdometry() const { return session_.has_odometry; }

   private:
	const Session& session_;
	const MotionNoiseOptions options_;
	double distance_scale_, turn_scale_;
};
}  // namespace viwo::gt
