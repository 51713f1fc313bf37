#pragma once

#include <viwo/core/Trajectory.h>

#include <string>
#include <vector>

namespace viwo
{
/** Words that programs of viwo flag poses with: viwo-odometry its status, viwo-groundtruth how far a pose is to be trusted. */
const std::vector<std::string>& knownPoseFlags();

/** Which poses of a trajectory are not to be trusted. */
class PoseFlags
{
   public:
	/** None is bad. */
	PoseFlags() = default;

	/** Reads the columns `t_s` and `flag` of a trajectory_covariance.csv. @param bad words that mark a pose as bad.
	 *  @throws Error: unreadable, no such columns, no stamp in common with the trajectory.
	 */
	static PoseFlags load(const std::string& csv_path, const Trajectory& trajectory, const std::vector<std::string>& bad);

	/** Whether a pose that t_ns is interpolated from is bad. */
	bool isBad(int64_t t_ns, const Trajectory& trajectory) const;

   private:
	std::vector<bool> bad_;  //!< one for each pose; or empty
};
}  // namespace viwo
