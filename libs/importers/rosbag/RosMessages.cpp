#include "RosMessages.h"

#include "RosInstance.h"

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationGPS.h>
#include <nav_msgs/Odometry.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/LaserScan.h>
#include <sensor_msgs/NavSatFix.h>
#include <tf2_msgs/TFMessage.h>
#include <viwo/core/MrptPose.h>
#include <viwo/core/Time.h>
#include <viwo/rawlog/MrptTime.h>
#include <viwo/rawlog/RawlogWriter.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace viwo
{
namespace
{
template <class Vector>
Eigen::Vector3d vectorOf(const Vector& v)
{
	return {v.x, v.y, v.z};
}

/** Nothing unless its length is one, within 1 %. */
template <class Quaternion>
std::optional<Eigen::Quaterniond> rotationOf(const Quaternion& q)
{
	const Eigen::Quaterniond R(q.w, q.x, q.y, q.z);
	if (!(std::abs(R.norm() - 1) < 0.01)) return std::nullopt;
	return R.normalized();
}
}  // namespace

RosHeader readHeader(const rosbag::MessageInstance& message)
{
	// The first field of all types that are read here; behind it in nav_msgs/Odometry the name of the child frame.
	std::vector<uint8_t> bytes(message.size());
	ros::serialization::OStream out(bytes.data(), static_cast<uint32_t>(bytes.size()));
	message.write(out);
	ros::serialization::IStream in(bytes.data(), static_cast<uint32_t>(bytes.size()));
	std_msgs::Header header;
	ros::serialization::deserialize(in, header);
	RosHeader result{stamp_ns(header.stamp), stamp_ns(message.getTime()), header.frame_id, {}};
	if (message.isType<nav_msgs::Odometry>()) ros::serialization::deserialize(in, result.child_frame);
	return result;
}

ImuSample readImu(const rosbag::MessageInstance& message, int64_t t_ns)
{
	const auto imu = instance<sensor_msgs::Imu>(message);
	return {t_ns, vectorOf(imu->linear_acceleration), vectorOf(imu->angular_velocity)};
}

mrpt::math::TTwist2D readTwist(const rosbag::MessageInstance& message, const std::optional<Pose3>& T_SO)
{
	const bool is_odometry = message.isType<nav_msgs::Odometry>();
	const auto twist =
	    is_odometry ? instance<nav_msgs::Odometry>(message)->twist.twist : instance<geometry_msgs::TwistStamped>(message)->twist;
	if (!T_SO) return {twist.linear.x, twist.linear.y, twist.angular.z};
	const Eigen::Vector3d w_S = vectorOf(twist.angular), v_O_S = vectorOf(twist.linear) + w_S.cross(T_SO->p);
	const Eigen::Vector3d v_O = T_SO->R.conjugate() * v_O_S, w_O = T_SO->R.conjugate() * w_S;
	return {v_O.x(), v_O.y(), w_O.z()};
}

std::optional<Pose3> readPose(const rosbag::MessageInstance& message)
{
	const auto pose = message.isType<nav_msgs::Odometry>() ? instance<nav_msgs::Odometry>(message)->pose.pose
	                                                       : instance<geometry_msgs::PoseStamped>(message)->pose;
	const auto R = rotationOf(pose.orientation);
	if (!R || !vectorOf(pose.position).allFinite()) return std::nullopt;
	return Pose3(*R, vectorOf(pose.position));
}

std::optional<GeodeticPoint> readFix(const rosbag::MessageInstance& message)
{
	const auto fix = instance<sensor_msgs::NavSatFix>(message);
	if (fix->status.status < 0 || !std::isfinite(fix->latitude) || !std::isfinite(fix->longitude)) return std::nullopt;
	// Receivers without a height give NaN.
	return GeodeticPoint{fix->latitude, fix->longitude, std::isfinite(fix->altitude) ? fix->altitude : 0};
}

void readTransforms(const rosbag::MessageInstance& message, const TransformTaker& take)
{
	const auto tf = instance<tf2_msgs::TFMessage>(message);
	for (const auto& transform : tf->transforms)
	{
		const auto R = rotationOf(transform.transform.rotation);
		const Eigen::Vector3d p = vectorOf(transform.transform.translation);
		const bool is_pose = R && p.allFinite();
		take(transform.header.frame_id, transform.child_frame_id, is_pose ? std::optional(Pose3(*R, p)) : std::nullopt);
	}
}

mrpt::obs::CObservation::Ptr imuObservation(const rosbag::MessageInstance& message, int64_t t_ns, const Pose3& T_OB,
                                            const std::string& label)
{
	const auto imu = std::make_shared<mrpt::obs::CObservationIMU>(makeImu(readImu(message, t_ns), T_OB, label));
	const auto ros = instance<sensor_msgs::Imu>(message);
	// REP 145: -1 as the first element says that the sensor gives no orientation.
	const auto R = ros->orientation_covariance[0] == -1 ? std::nullopt : rotationOf(ros->orientation);
	if (R)
	{
		imu->set(mrpt::obs::IMU_ORI_QUAT_W, R->w());
		imu->set(mrpt::obs::IMU_ORI_QUAT_X, R->x());
		imu->set(mrpt::obs::IMU_ORI_QUAT_Y, R->y());
		imu->set(mrpt::obs::IMU_ORI_QUAT_Z, R->z());
	}
	return imu;
}

mrpt::obs::CObservation::Ptr odometryObservation(const rosbag::MessageInstance& message, int64_t t_ns, const std::optional<Pose3>& T_SO,
                                                 const std::string& label)
{
	const mrpt::math::TTwist2D twist = readTwist(message, T_SO);
	const auto odometry =
	    std::make_shared<mrpt::obs::CObservationOdometry>(makeOdometry(t_ns, {twist.vx, twist.omega}, {}, 0, 0, 0, label));
	odometry->velocityLocal.vy = twist.vy;
	if (!message.isType<nav_msgs::Odometry>()) return odometry;
	const double nan = std::numeric_limits<double>::quiet_NaN();
	odometry->odometry = mrpt::poses::CPose2D(nan, nan, nan);
	if (const auto T_WS = readPose(message))
	{
		const Pose3 T_WO = T_SO ? *T_WS * *T_SO : *T_WS;
		odometry->odometry = mrpt::poses::CPose2D(T_WO.p.x(), T_WO.p.y(), yawOf(T_WO.R));
	}
	return odometry;
}

mrpt::obs::CObservation::Ptr fixObservation(const rosbag::MessageInstance& message, int64_t t_ns, const Pose3& T_OA,
                                            const std::string& label)
{
	const auto ros = instance<sensor_msgs::NavSatFix>(message);
	mrpt::obs::gnss::Message_NMEA_GGA gga;
	const int64_t day_ns = t_ns % (86400 * nanoseconds(1));
	gga.fields.UTCTime.hour = static_cast<uint8_t>(day_ns / (3600 * nanoseconds(1)));
	gga.fields.UTCTime.minute = static_cast<uint8_t>(day_ns / (60 * nanoseconds(1)) % 60);
	gga.fields.UTCTime.sec = static_cast<double>(day_ns % (60 * nanoseconds(1))) / kNanosecondsPerSecond;
	gga.fields.latitude_degrees = ros->latitude;
	gga.fields.longitude_degrees = ros->longitude;
	// ROS' altitude is that above the ellipsoid: with no undulation given, MRPT's sum of the two is the same.
	gga.fields.altitude_meters = gga.fields.orthometric_altitude = ros->altitude;
	gga.fields.fix_quality = ros->status.status < 0 ? 0 : ros->status.status == 0 ? 1 : 2;

	const auto gps = std::make_shared<mrpt::obs::CObservationGPS>();
	gps->timestamp = gps->originalReceivedTimestamp = mrptTime(t_ns);
	gps->sensorLabel = label;
	gps->sensorPose = toMrpt(T_OA);
	gps->setMsg(gga);
	return gps;
}

mrpt::obs::CObservation::Ptr scanObservation(const rosbag::MessageInstance& message, int64_t t_ns, const Pose3& T_OL,
                                             const std::string& label)
{
	const auto ros = instance<sensor_msgs::LaserScan>(message);
	if (ros->ranges.empty()) throw UnusableTopic(message.getTopic(), "a scan without ranges");
	std::vector<float> ranges_m(ros->ranges.begin(), ros->ranges.end());
	for (float& range_m : ranges_m)
		if (range_m < ros->range_min) range_m = 0;
	// MRPT's scans run from right to left about their sensor's x axis.
	const double sweep_rad = static_cast<double>(ros->angle_increment) * static_cast<double>(ranges_m.size() - 1);
	if (sweep_rad < 0) std::reverse(ranges_m.begin(), ranges_m.end());
	const double middle_rad = static_cast<double>(ros->angle_min) + 0.5 * sweep_rad;
	const Pose3 T_LM(Eigen::Quaterniond(Eigen::AngleAxisd(middle_rad, Eigen::Vector3d::UnitZ())), Eigen::Vector3d::Zero());
	return std::make_shared<mrpt::obs::CObservation2DRangeScan>(
	    makeScan(t_ns, ranges_m, std::abs(sweep_rad), static_cast<double>(ros->range_max), T_OL * T_LM, label));
}
}  // namespace viwo
