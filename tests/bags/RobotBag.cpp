#include "RobotBag.h"

#include "TempFolder.h"
#include "TestBag.h"

#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <viwo/core/MrptPose.h>
#include <viwo/core/Trajectory.h>
#include <viwo/rawlog/MrptTime.h>
#include <viwo/rawlog/RawlogReader.h>
#include <viwo/rawlog/RawlogWriter.h>

#include <cmath>
#include <set>
#include <sstream>

namespace viwo::testing
{
namespace
{
using namespace mrpt::obs;

ros::Time rosTime(int64_t t_ns)
{
	ros::Time time;
	return time.fromNSec(static_cast<uint64_t>(t_ns));
}

class RobotBag
{
   public:
	RobotBag(const std::string& path, const RobotBagOptions& options) : bag_(path, rosbag::bagmode::Write), options_(options)
	{
		bag_.setCompression(rosbag::compression::LZ4);
	}

	void add(const CObservation& observation)
	{
		const int64_t t_ns = nanosecondsOf(observation.timestamp);
		if (const auto* image = dynamic_cast<const CObservationImage*>(&observation)) addImage(*image, t_ns);
		if (const auto* imu = dynamic_cast<const CObservationIMU*>(&observation)) addImu(*imu, t_ns);
		if (const auto* odometry = dynamic_cast<const CObservationOdometry*>(&observation)) addOdometry(*odometry, t_ns);
		if (const auto* scan = dynamic_cast<const CObservation2DRangeScan*>(&observation)) addScan(*scan, t_ns);
	}

	void addTruth(const Trajectory& truth)
	{
		for (const StampedPose& pose : truth.poses())
		{
			auto message = stampedAt<geometry_msgs::PoseStamped>(rosTime(pose.t_ns), "world");
			fill(message.pose, pose.T);
			bag_.write("/ground_truth", rosTime(pose.t_ns), message);
		}
	}

	void close() { bag_.close(); }

   private:
	static void fill(geometry_msgs::Pose& message, const Pose3& T)
	{
		message.position.x = T.p.x(), message.position.y = T.p.y(), message.position.z = T.p.z();
		message.orientation.w = T.R.w(), message.orientation.x = T.R.x(), message.orientation.y = T.R.y(), message.orientation.z = T.R.z();
	}

	/** @param latency_ms until the recorder has it: images and scans take their time. */
	template <class Message>
	void record(const std::string& topic, int64_t t_ns, int64_t latency_ms, const Message& message)
	{
		bag_.write(topic, rosTime(t_ns + latency_ms * 1000000), message);
	}

	/** Each driver publishes the pose of its sensor once. */
	void placeOnce(const std::string& frame, int64_t t_ns, const mrpt::poses::CPose3D& pose)
	{
		if (!placed_.insert(frame).second) return;
		tf2_msgs::TFMessage frames;
		frames.transforms = {transform("base_link", frame, fromMrpt(pose))};
		record("/tf_static", t_ns, 0, frames);
	}

	void addImage(const CObservationImage& image, int64_t t_ns)
	{
		placeOnce("camera", t_ns, image.cameraPose);
		auto picture = stampedAt<sensor_msgs::CompressedImage>(rosTime(t_ns), "camera");
		const std::string bytes = readFile(image.image.getExternalStorageFileAbsolutePath());
		picture.format = "jpeg";
		picture.data.assign(bytes.begin(), bytes.end());
		record("/camera/image_raw/compressed", t_ns, 30, picture);

		const CameraModel camera = fromMrpt(image.cameraParams);
		auto info = stampedAt<sensor_msgs::CameraInfo>(rosTime(t_ns), "camera");
		info.width = static_cast<uint32_t>(camera.width_px()), info.height = static_cast<uint32_t>(camera.height_px());
		info.distortion_model = camera.distortion() == CameraModel::Distortion::kannala_brandt ? "equidistant" : "plumb_bob";
		info.D.assign(camera.coefficients().begin(), camera.coefficients().end());
		info.K = {camera.fx_px(), 0, camera.cx_px(), 0, camera.fy_px(), camera.cy_px(), 0, 0, 1};
		info.R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
		info.P = {camera.fx_px(), 0, camera.cx_px(), 0, 0, camera.fy_px(), camera.cy_px(), 0, 0, 0, 1, 0};
		record("/camera/camera_info", t_ns, 30, info);
	}

	void addImu(const CObservationIMU& imu, int64_t t_ns)
	{
		placeOnce("imu", t_ns, imu.sensorPose);
		auto message = stampedAt<sensor_msgs::Imu>(rosTime(t_ns), "imu");
		message.orientation_covariance[0] = -1;  // ROS' way of saying that there is none
		message.linear_acceleration.x = imu.get(IMU_X_ACC), message.linear_acceleration.y = imu.get(IMU_Y_ACC);
		message.linear_acceleration.z = imu.get(IMU_Z_ACC);
		message.angular_velocity.x = imu.get(IMU_WX), message.angular_velocity.y = imu.get(IMU_WY);
		message.angular_velocity.z = imu.get(IMU_WZ);
		record("/imu/data", t_ns, 1, message);
	}

	void addOdometry(const CObservationOdometry& odometry, int64_t t_ns)
	{
		if (options_.four_wheels) return addJoints(odometry, t_ns);
		auto message = stampedAt<nav_msgs::Odometry>(rosTime(t_ns), "odom");
		message.child_frame_id = "base_link";
		message.twist.twist.linear.x = odometry.velocityLocal.vx, message.twist.twist.angular.z = odometry.velocityLocal.omega;
		const double yaw_rad = odometry.odometry.phi();
		message.pose.pose.position.x = odometry.odometry.x(), message.pose.pose.position.y = odometry.odometry.y();
		message.pose.pose.orientation.w = std::cos(yaw_rad / 2), message.pose.pose.orientation.z = std::sin(yaw_rad / 2);
		record("/odom", t_ns, 2, message);
	}

	/** The front wheels are a thousandth smaller than the rear ones, and turn by as much more. */
	void addJoints(const CObservationOdometry& odometry, int64_t t_ns)
	{
		const double tick_rad = 2 * M_PI / options_.ticks_per_revolution;
		const double left_rad = tick_rad * odometry.encoderLeftTicks, right_rad = tick_rad * odometry.encoderRightTicks;
		auto state = stampedAt<sensor_msgs::JointState>(rosTime(t_ns), "");
		state.name = {"arm", "rear_right_wheel", "front_left_wheel", "rear_left_wheel", "front_right_wheel"};
		state.position = {0.3, 0.9995 * right_rad, 1.0005 * left_rad, 0.9995 * left_rad, 1.0005 * right_rad};
		record("/joint_states", t_ns, 2, state);
	}

	void addScan(const CObservation2DRangeScan& scan, int64_t t_ns)
	{
		placeOnce("laser", t_ns, scan.sensorPose);
		auto message = stampedAt<sensor_msgs::LaserScan>(rosTime(t_ns), "laser");
		const size_t beams = scan.getScanSize();
		message.angle_min = -scan.aperture / 2, message.angle_max = scan.aperture / 2;
		message.angle_increment = scan.aperture / static_cast<float>(beams - 1);
		message.range_min = 0.01f, message.range_max = scan.maxRange;
		for (size_t i = 0; i < beams; ++i)
			message.ranges.push_back(scan.getScanRangeValidity(i) ? scan.getScanRange(i) : scan.maxRange + 1);
		record("/scan", t_ns, 45, message);
	}

	rosbag::Bag bag_;
	RobotBagOptions options_;
	std::set<std::string> placed_;
};
}  // namespace

void writeRobotBag(const std::string& rawlog, const std::string& truth_tum, const std::string& bag_path, const RobotBagOptions& options)
{
	RobotBag bag(bag_path, options);
	RawlogReader reader(rawlog);
	while (const auto observation = reader.next()) bag.add(*observation);
	if (!truth_tum.empty()) bag.addTruth(Trajectory::loadTum(truth_tum));
	bag.close();
}

std::string fourWheelMap(double wheel_radius_m, double track_m, bool with_truth)
{
	std::ostringstream map;
	if (with_truth) map << "[general]\nground_truth = /ground_truth\n\n";
	map << "[CAM]\ntopic = /camera/image_raw/compressed\ncamera_info = /camera/camera_info\n\n[IMU]\ntopic = "
	       "/imu/data\n\n[ODOMETRY]\ntopic = /joint_states\nleft_joints = front_left_wheel rear_left_wheel\nright_joints = "
	       "front_right_wheel rear_right_wheel\nwheel_radius_m = "
	    << wheel_radius_m << "\ntrack_m = " << track_m << "\n";
	return map.str();
}
}  // namespace viwo::testing
