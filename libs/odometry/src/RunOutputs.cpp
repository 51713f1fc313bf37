#include "RunOutputs.h"

#include <mrpt/core/format.h>
#include <viwo/core/Error.h>
#include <viwo/core/PoseRows.h>
#include <viwo/core/TimeText.h>

#include <filesystem>

namespace viwo
{
namespace
{
std::string madeFolder(const std::string& dir)
{
	std::error_code error;
	std::filesystem::create_directories(dir, error);
	if (error) throw Error(dir + ": cannot make this folder (" + error.message() + "); choose another with -o");
	return dir;
}

void writePose(std::ostream& out, int64_t t_ns, const Pose3& T)
{
	out << formatSeconds(t_ns) << " " << poseRow(T) << "\n";
}

void writeCovarianceHeader(std::ostream& out)
{
	static const char* const names[] = {"x", "y", "z", "roll", "pitch", "yaw"};
	out << "# frame: O relative to the first pose; position in W's axes (m), rotation vector in O's axes (rad, R <- R Exp(d)): x y z roll "
	       "pitch yaw\n";
	out << "t_s";
	for (int i = 0; i < 6; ++i)
		for (int j = i; j < 6; ++j) out << "," << names[i] << "_" << names[j];
	out << ",flag\n";
}

void writeLandmarks(const std::string& path, const std::map<uint64_t, LandmarkPoint>& landmarks)
{
	AtomicFile file(path);
	file.stream()
	    << "ply\nformat ascii 1.0\ncomment landmarks in W, m\nelement vertex " << landmarks.size()
	    << "\nproperty float x\nproperty float y\nproperty float z\nproperty float depth_deviation\nproperty uint id\nend_header\n";
	for (const auto& [id, point] : landmarks)
		file.stream() << mrpt::format("%.4f %.4f %.4f %.4f ", point.p_W.x(), point.p_W.y(), point.p_W.z(), point.depth_deviation) << id
		              << "\n";
	file.commit();
}

void writeKeyFrames(const std::string& path, const std::map<int64_t, Pose3>& key_frames)
{
	AtomicFile file(path);
	file.stream() << "# camera (optical axes) in W, m\nt_ns,x,y,z,qx,qy,qz,qw\n";
	for (const auto& [t_ns, T] : key_frames)
		file.stream() << t_ns
		              << mrpt::format(",%.9f,%.9f,%.9f,%.12f,%.12f,%.12f,%.12f\n", T.p.x(), T.p.y(), T.p.z(), T.R.x(), T.R.y(), T.R.z(),
		                              T.R.w());
	file.commit();
}

/** Of the landmarks in landmarks.ply. */
void writeObservations(const std::string& path, const std::map<uint64_t, LandmarkPoint>& landmarks,
                       const std::map<uint64_t, std::set<int64_t>>& observations)
{
	AtomicFile file(path);
	file.stream() << "landmark_id,t_ns\n";
	for (const auto& [id, stamps] : observations)
		if (landmarks.count(id) > 0)
			for (const int64_t t_ns : stamps) file.stream() << id << "," << t_ns << "\n";
	file.commit();
}
}  // namespace

RunOutputs::RunOutputs(const std::string& dir, PoseFrame frame)
    : dir_(madeFolder(dir)),
      frame_(frame),
      trajectory_(dir + "/trajectory.tum"),
      imu_rate_(dir + "/trajectory_imu_rate.tum"),
      covariance_(dir + "/trajectory_covariance.csv")
{
	writeCovarianceHeader(covariance_.stream());
}

Pose3 RunOutputs::inFrame(const Pose3& T_WB, const Calibration& calibration, const Pose3& T_BC) const
{
	switch (frame_)
	{
		case PoseFrame::B:
			return T_WB;
		case PoseFrame::C:
			return T_WB * T_BC;
		case PoseFrame::O:
			break;
	}
	return T_WB * calibration.T_BO();
}

void RunOutputs::add(const FrameEstimate& estimate, const Calibration& calibration, const Pose3& T_BC)
{
	if (!estimate.has_pose) return;
	writePose(trajectory_.stream(), estimate.t_ns, inFrame(estimate.state.T_WB, calibration, T_BC));
	covariance_.stream() << formatSeconds(estimate.t_ns);
	for (int i = 0; i < 6; ++i)
		for (int j = i; j < 6; ++j) covariance_.stream() << mrpt::format(",%.6e", estimate.covariance(i, j));
	covariance_.stream() << "," << toString(estimate.status) << "\n";

	if (poses_ == 0) first_ = estimate;
	if (poses_ > 0) path_length_m_ += (estimate.T_WO.p - last_p_WO_).norm();
	last_p_WO_ = estimate.T_WO.p;
	last_pose_ns_ = estimate.t_ns;
	++poses_;
}

void RunOutputs::add(const NavState& state, const Calibration& calibration, const Pose3& T_BC)
{
	if (state.t_ns <= last_imu_rate_ns_) return;
	last_imu_rate_ns_ = state.t_ns;
	writePose(imu_rate_.stream(), state.t_ns, inFrame(state.T_WB, calibration, T_BC));
}

void RunOutputs::add(const std::vector<LandmarkPoint>& landmarks, double max_deviation)
{
	for (const LandmarkPoint& point : landmarks)
		if (point.depth_deviation < max_deviation) landmarks_[point.id] = point;
}

void RunOutputs::add(const std::vector<KeyFrameView>& key_frames)
{
	for (const KeyFrameView& view : key_frames)
	{
		key_frames_[view.t_ns] = view.T_WC;
		for (const uint64_t id : view.landmarks) observations_[id].insert(view.t_ns);
	}
}

void RunOutputs::commit()
{
	trajectory_.commit();
	imu_rate_.commit();
	covariance_.commit();
	writeLandmarks(dir_ + "/landmarks.ply", landmarks_);
	writeKeyFrames(dir_ + "/keyframes.csv", key_frames_);
	writeObservations(dir_ + "/landmark_observations.csv", landmarks_, observations_);
}
}  // namespace viwo
