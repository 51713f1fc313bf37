#pragma once

#include <viwo/rawlog/RawlogReader.h>

#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <string>
#include <vector>

namespace viwo::testing
{
/** All observations of a rawlog by class, in the order of the file's stamps. */
struct RawlogContent
{
	std::vector<mrpt::obs::CObservationImage::Ptr> images;
	std::vector<mrpt::obs::CObservationIMU::Ptr> imu;
	std::vector<mrpt::obs::CObservationOdometry::Ptr> odometry;

	explicit RawlogContent(const std::string& path)
	{
		RawlogReader reader(path);
		while (const auto observation = reader.next())
		{
			if (auto image = std::dynamic_pointer_cast<mrpt::obs::CObservationImage>(observation)) images.push_back(image);
			if (auto sample = std::dynamic_pointer_cast<mrpt::obs::CObservationIMU>(observation)) imu.push_back(sample);
			if (auto twist = std::dynamic_pointer_cast<mrpt::obs::CObservationOdometry>(observation)) odometry.push_back(twist);
		}
	}
};
}  // namespace viwo::testing
