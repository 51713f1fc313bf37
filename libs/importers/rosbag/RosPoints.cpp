#include "RosInstance.h"
#include "RosMessages.h"

#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <sensor_msgs/PointCloud2.h>
#include <viwo/core/MrptPose.h>
#include <viwo/core/NumberText.h>
#include <viwo/rawlog/MrptTime.h>

#include <cmath>
#include <cstring>

namespace viwo
{
namespace
{
size_t offsetOf(const sensor_msgs::PointCloud2& cloud, const char* name, const std::string& topic)
{
	for (const auto& field : cloud.fields)
		if (field.name == name && field.datatype == sensor_msgs::PointField::FLOAT32 && field.offset + 4 <= cloud.point_step)
			return field.offset;
	throw UnusableTopic(topic, std::string("its points have no ") + name + " of 32-bit floating point");
}

float floatAt(const uint8_t* bytes)
{
	float value = 0;
	std::memcpy(&value, bytes, sizeof value);
	return value;
}
}  // namespace

mrpt::obs::CObservation::Ptr cloudObservation(const rosbag::MessageInstance& message, int64_t t_ns, const Pose3& T_OS,
                                              const std::string& label)
{
	const auto ros = instance<sensor_msgs::PointCloud2>(message);
	const std::string& topic = message.getTopic();
	if (ros->is_bigendian) throw UnusableTopic(topic, "points of big-endian byte order");
	const size_t x = offsetOf(*ros, "x", topic), y = offsetOf(*ros, "y", topic), z = offsetOf(*ros, "z", topic);
	const size_t rows = ros->height, columns = ros->width;
	if (rows * ros->row_step > ros->data.size() || columns * ros->point_step > ros->row_step)
		throw Error(topic + ": a cloud of " + std::to_string(rows * columns) + " points has only " + counted(ros->data.size(), "byte") +
		            ": damaged");

	const auto points = mrpt::maps::CSimplePointsMap::Create();
	points->reserve(rows * columns);
	for (size_t row = 0; row < rows; ++row)
		for (size_t column = 0; column < columns; ++column)
		{
			const uint8_t* point = ros->data.data() + row * ros->row_step + column * ros->point_step;
			const float p[3] = {floatAt(point + x), floatAt(point + y), floatAt(point + z)};
			// No return is NaN.
			if (std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2])) points->insertPointFast(p[0], p[1], p[2]);
		}
	points->mark_as_modified();

	const auto cloud = mrpt::obs::CObservationPointCloud::Create();
	cloud->timestamp = mrptTime(t_ns);
	cloud->sensorLabel = label;
	cloud->sensorPose = toMrpt(T_OS);
	cloud->pointcloud = points;
	return cloud;
}
}  // namespace viwo
