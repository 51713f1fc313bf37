#pragma once

#include "PoseGraph.h"
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

/** What is known of odometry and gyroscope of this very log. */
struct MotionCalibration
{
	double distance_scale = 1, turn_scale = 1;  //!< factors on odometry's ways and turns
	/** Standard deviation of ways, m per square root of a metre, where the log tells; never worse than as configured. */
	std::optional<double> distance_walk;
	/** Of the yaw rate, on top of what was taken off on loading. Unknown: turns are the gyroscope's, their weight is that of odometry's. */
	std::optional<double> gyro_bias_rad_s;
	/** Scans, increasing, that registration has found elsewhere than odometry leads to from the scan before. */
	std::vector<size_t> contradicted;
};

/** What odometry and gyroscope say of motions. */
class MotionModel
{
   public:
	MotionModel(const Session& session, const MotionNoiseOptions& options, const MotionCalibration& calibration = {})
	    : session_(session), options_(options), calibration_(calibration)
	{
	}

	/** Nothing where there is no odometry for either scan, or where scans contradict it in between. */
	std::optional<Motion2> between(size_t a, size_t b) const;

	/** By the gyroscope, where there is one whose bias is known; a and b are left to the caller. */
	std::optional<GyroTurn> turnByGyro(size_t a, size_t b) const;

	/** Mean over the scan's neighbours; zero where unknown. */
	Twist2 twistAt(size_t scan) const;

   private:
	bool contradicted(size_t a, size_t b) const;

	const Session& session_;
	const MotionNoiseOptions options_;
	const MotionCalibration calibration_;
};
}  // namespace viwo::gt
