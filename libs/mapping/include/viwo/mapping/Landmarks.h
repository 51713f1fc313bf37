#pragma once

#include <viwo/core/Trajectory.h>
#include <viwo/mapping/RayScan.h>

#include <string>
#include <vector>

namespace viwo
{
/** A point that viwo-odometry has found. */
struct Landmark
{
	uint64_t id = 0;
	Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
	double depth_deviation = 0;  //!< relative
};

/** Reads landmarks.ply, or any ASCII PLY with x, y, z; `id` and `depth_deviation` are zero where the file has none.
 *  @throws Error naming file and line.
 */
std::vector<Landmark> loadLandmarks(const std::string& ply_path);

/** As .ply (ASCII) or .pcd (ASCII, of PCL), by the name's extension. @throws Error. */
void saveLandmarks(const std::string& path, const std::vector<Landmark>& landmarks);

/** Where the camera was when key frames were taken. */
struct KeyFramePose
{
	int64_t t_ns = 0;
	Pose3 T_WC;
};

/** Reads keyframes.csv. @throws Error naming file and line. */
std::vector<KeyFramePose> loadKeyFrames(const std::string& csv_path);

/** Rays of the landmarks in a folder of viwo-odometry, from the camera at the key frames that saw them: a scan a key frame. Each key frame
 *  and what it saw is moved along from the folder's own trajectory to `trajectory`, which may be a better one in another frame.
 *  @param max_deviation landmarks whose relative deviation of depth is larger are left out.
 *  @throws Error: a file is missing or malformed.
 */
std::vector<RayScan> landmarkRays(const std::string& dir, const Trajectory& trajectory, double max_gap_s, double max_deviation);
}  // namespace viwo
