#pragma once

#include <viwo/core/Calibration.h>
#include <viwo/core/FeatureFrame.h>
#include <viwo/core/ImuSample.h>
#include <viwo/core/NavState.h>
#include <viwo/core/WheelSample.h>
#include <viwo/estimator/EstimatorOptions.h>

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace viwo
{
enum class Status
{
	waiting,        //!< nothing to work with yet, or without the IMU nothing that carries on: no pose
	initialising,   //!< gathering data for the first pose, or for a new start: no pose
	from_wheels,    //!< poses from wheels and IMU; landmarks are not known well enough yet
	tracking,       //!< camera, IMU and (unless mode vio) wheels
	dead_reckoning  //!< camera lost: IMU and wheels carry on; or IMU or window lost: the wheels carry on
};

const char* toString(Status status);

/** A change of status, with its cause in words. */
struct StatusChange
{
	int64_t t_ns = 0;
	Status from = Status::waiting, to = Status::waiting;
	std::string cause;
};

/** What one frame gave. */
struct FrameEstimate
{
	int64_t t_ns = 0;
	bool has_pose = false;
	Status status = Status::waiting;
	NavState state;  //!< of B in W
	Pose3 T_WO;
	/** Of T_WO relative to the first pose, over new starts too: position in W's axes (m), rotation vector in O's axes (rad, right
	 * perturbation): x y z roll pitch yaw. */
	Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
	bool slip = false;
	bool standing = false;
	int landmarks = 0;  //!< of known depth, in the window
	int features = 0;
};

/** A landmark of the window. */
struct LandmarkPoint
{
	uint64_t id = 0;
	Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
	double depth_deviation = 0;  //!< relative deviation of the inverse depth
};

/** A key frame of the window, and which landmarks it sees. */
struct KeyFrameView
{
	int64_t t_ns = 0;
	Pose3 T_WC;
	std::vector<uint64_t> landmarks;  //!< ids, rising
};

/** What has happened so far. */
struct EstimatorCounters
{
	int frames = 0;
	int keyframes = 0;
	int slip_events = 0;
	int reinitializations = 0;  //!< windows lost
	int standstills = 0;
	int imu_gaps = 0;  //!< holes in the stream, however many frames they spoil
	int wheel_gaps = 0;
};

/** Calibration as estimated so far. */
struct CalibrationEstimate
{
	Pose3 T_BC;
	WheelIntrinsics wheels;
	double plane_tilt_x_rad = 0, plane_tilt_y_rad = 0, plane_height_m = 0;
};

/** Sliding-window estimator of Niu et al., Sec. 4 to 6: samples and tracks in, states out. Knows no image, no file and no clock.
 *  Deterministic; throws nothing: how it went is in the status.
 */
class Estimator
{
   public:
	/** Called with the name of a stage at its begin and at its end, for profiling. */
	using StageHook = std::function<void(const char* stage, bool begin)>;

	Estimator(const EstimatorOptions& options, const Calibration& calibration);
	~Estimator();
	Estimator(const Estimator&) = delete;
	Estimator& operator=(const Estimator&) = delete;

	/** Stamps strictly increasing per sensor; others are ignored and false is returned. */
	bool addImu(const ImuSample& sample);
	bool addWheels(const WheelSample& sample);

	/** The next frame; what IMU and wheels there are up to its stamp must have been added. An empty frame asks for a pose at that time. One
	 * that is not later than the last is ignored. Where the IMU does not reach it, the wheels alone give its pose, and without wheels there
	 * is none.
	 */
	FrameEstimate addFrame(const FeatureFrame& frame);

	/** R_Cprev_Ccur from the gyro between two stamps, less the estimated bias; identity where the IMU does not cover them. */
	Eigen::Quaterniond predictCameraRotation(int64_t t_prev_ns, int64_t t_cur_ns) const;

	/** The last frame's state carried on by the IMU: one state per IMU sample in (t_after_ns, t_until_ns], before the next frame is added.
	 */
	std::vector<NavState> propagate(int64_t t_after_ns, int64_t t_until_ns) const;

	Status status() const;
	const std::vector<StatusChange>& statusChanges() const;
	const EstimatorCounters& counters() const;
	/** Landmarks of the window, in W. */
	std::vector<LandmarkPoint> landmarks() const;
	/** Key frames of the window, oldest first. */
	std::vector<KeyFrameView> keyFrames() const;
	CalibrationEstimate calibration() const;

	void setStageHook(StageHook hook);

   private:
	struct Impl;
	std::unique_ptr<Impl> impl_;
};
}  // namespace viwo
