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
#include <optional>
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
	int64_t t_ns = 0;  //!< by the IMU's clock: the frame's stamp and the camera's offset; never goes back where that does
	bool has_pose = false;
	Status status = Status::waiting;
	NavState state;  //!< of B in W
	Pose3 T_WO;
	/** Of T_WO relative to the first pose, over new starts too, and without what T_BO itself may be off: position in W's axes (m), rotation
	 * vector in O's axes (rad, right perturbation): x y z roll pitch yaw. */
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
	Pose3 T_BO;
	double camera_time_offset_s = 0, wheel_time_offset_s = 0;  //!< on top of what stamps had added: t_IMU = t_CAM + t_d = t_WHEEL + t_w
	double plane_tilt_x_rad = 0, plane_tilt_y_rad = 0, plane_height_m = 0;
};

/** Standard deviations of what is estimated; what is not has none. */
struct CalibrationDeviations
{
	using Vector6 = Eigen::Matrix<double, 6, 1>;

	std::optional<Vector6> T_BC;            //!< position in B (m), rotation about C's axes (rad)
	std::optional<Eigen::Vector3d> wheels;  //!< k_left, k_right, track_m
	std::optional<Vector6> T_BO;            //!< position along O's axes (m; z is held: planar motion does not show it), rotation about them
	std::optional<double> camera_time_offset_s, wheel_time_offset_s;
	/** Whether the motion has shown enough of it. Until then it is held where it was. */
	bool lever_arm_started = false, yaw_started = false, camera_offset_started = false, wheel_offset_started = false;
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

	/** A frame's stamp by the IMU's clock, as far as the offset is known. */
	int64_t imuTimeOf(int64_t t_frame_ns) const;
	/** How far IMU and wheels must reach, by their own clocks, for a frame with this stamp. */
	int64_t imuNeededFor(int64_t t_frame_ns) const;
	int64_t wheelsNeededFor(int64_t t_frame_ns) const;

	/** The next frame; what IMU and wheels there are as far as imuNeededFor() and wheelsNeededFor() ask for must have been added. An empty
	 * frame asks for a pose at that time. One that is not later than the last is ignored. Where the IMU does not reach it, the wheels alone
	 * give its pose, and without wheels there is none.
	 */
	FrameEstimate addFrame(const FeatureFrame& frame);

	/** R_Cprev_Ccur from the gyro between two frames' stamps, less the estimated bias; identity where the IMU does not cover them. */
	Eigen::Quaterniond predictCameraRotation(int64_t t_prev_ns, int64_t t_cur_ns) const;

	/** The last frame's state carried on by the IMU: one state per IMU sample in (t_after_ns, t_until_ns], in the IMU's clock, before the
	 * next frame is added.
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
	/** Costs about as much as a frame's covariance. */
	CalibrationDeviations calibrationDeviations() const;
	/** The calibration given, with T_OB as estimated so far where that is switched on. */
	const Calibration& calibrationInUse() const;

	void setStageHook(StageHook hook);

   private:
	struct Impl;
	std::unique_ptr<Impl> impl_;
};
}  // namespace viwo
