#pragma once

#include <viwo/core/Trajectory.h>

#include <optional>
#include <string>
#include <vector>

namespace viwo
{
/** Text formats of trajectories; doc/formats/trajectories.md defines them. */
enum class TrajectoryFormat
{
	tum,    //!< t x y z qx qy qz qw
	kitti,  //!< the upper 3x4 of T, row by row; times in a file of their own
	euroc,  //!< t_ns,x,y,z,qw,qx,qy,qz
	mrpt,   //!< CPose3DInterpolator: t x y z yaw pitch roll
	g2o     //!< VERTEX_SE3:QUAT and EDGE_SE3:QUAT between neighbours (read: VERTEX_SE2 too); stamps in a file of their own
};

/** "tum", "kitti", "euroc", "mrpt", "g2o"; nothing for any other word. */
std::optional<TrajectoryFormat> trajectoryFormat(const std::string& word);

/** By the extension: .tum, .kitti, .csv (EuRoC), .mrpt, .g2o. */
std::optional<TrajectoryFormat> trajectoryFormatOf(const std::string& path);

/** Where the stamps of a trajectory without any are written: `X_kitti_times.txt` (seconds, a line a pose), `X_g2o_stamps.csv` (`id,t_ns`).
 *  Empty for formats that have them. Neither is a name that another program of viwo writes.
 */
std::string stampsPathOf(const std::string& path, TrajectoryFormat format);

/** Where they are read: what stampsPathOf() says, or, where there is only that, `X_times.txt` and `X_stamps.csv` as others name them. */
std::string existingStampsPathOf(const std::string& path, TrajectoryFormat format);

/** @param stamps_path for formats without stamps; empty: existingStampsPathOf(). @throws Error naming file and line. */
Trajectory loadTrajectory(const std::string& path, TrajectoryFormat format, const std::string& stamps_path = {});

/** Writes the stamps, too, where the format has none. @throws Error when a file cannot be written. */
void saveTrajectory(const std::string& path, TrajectoryFormat format, const Trajectory& trajectory);

/** Poses at t0 + k / rate_hz, interpolated; none within gaps longer than max_gap_s. */
Trajectory resampled(const Trajectory& trajectory, double rate_hz, double max_gap_s);

/** Poses at the stamps of another trajectory, interpolated; none where there is nothing to interpolate between. */
Trajectory resampledLike(const Trajectory& trajectory, const Trajectory& other, double max_gap_s);

/** T_Wb of T_Wa. */
Trajectory inOtherFrame(const Trajectory& T_Wa, const Pose3& T_ab);
}  // namespace viwo
