#pragma once

#include <viwo/core/AtomicFile.h>
#include <viwo/odometry/Odometry.h>
#include <viwo/odometry/OdometryRun.h>

#include <map>
#include <set>
#include <string>

namespace viwo
{
/** The files of a run that grow with it. */
class RunOutputs
{
   public:
	/** @throws Error when the folder cannot be made or written. */
	RunOutputs(const std::string& dir, PoseFrame frame);

	void add(const FrameEstimate& estimate, const Calibration& calibration, const Pose3& T_BC);
	void add(const NavState& state, const Calibration& calibration, const Pose3& T_BC);
	void add(const std::vector<LandmarkPoint>& landmarks, double max_deviation);
	/** The newest view of a key frame is kept, and all landmarks that any of its views names. */
	void add(const std::vector<KeyFrameView>& key_frames);

	/** Writes landmarks.ply, landmark_observations.csv, keyframes.csv, and gives all files their names. */
	void commit();

	int poses() const { return poses_; }
	double pathLength_m() const { return path_length_m_; }
	/** The first frame that had a pose. */
	const FrameEstimate& first() const { return first_; }
	int64_t firstPose_ns() const { return first_.t_ns; }
	int64_t lastPose_ns() const { return last_pose_ns_; }

   private:
	Pose3 inFrame(const Pose3& T_WB, const Calibration& calibration, const Pose3& T_BC) const;

	std::string dir_;
	PoseFrame frame_;
	AtomicFile trajectory_, imu_rate_, covariance_;
	std::map<uint64_t, LandmarkPoint> landmarks_;
	std::map<int64_t, Pose3> key_frames_;                 //!< T_WC by stamp
	std::map<uint64_t, std::set<int64_t>> observations_;  //!< key frames that saw a landmark
	int poses_ = 0;
	double path_length_m_ = 0;
	Eigen::Vector3d last_p_WO_ = Eigen::Vector3d::Zero();
	FrameEstimate first_;
	int64_t last_pose_ns_ = 0, last_imu_rate_ns_ = 0;
};
}  // namespace viwo
