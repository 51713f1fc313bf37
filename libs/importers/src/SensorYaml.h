#pragma once

#include <viwo/core/CameraModel.h>
#include <viwo/core/Pose3.h>

#include <optional>
#include <string>

namespace viwo
{
/** What an ASL sensor.yaml says; what the file does not have stays empty. */
struct SensorYaml
{
	Pose3 T_BS;  //!< sensor in the body frame
	std::optional<double> gyro_noise_rad_s_sqrtHz, gyro_walk_rad_s2_sqrtHz, acc_noise_m_s2_sqrtHz, acc_walk_m_s3_sqrtHz;
};

/** @throws Error naming the file: unreadable, not YAML, no T_BS of 16 numbers, or one that is no rigid transform. */
SensorYaml readSensorYaml(const std::string& path);

/** The camera in a sensor.yaml. @throws Error naming file and key: a camera model other than pinhole, a distortion other than
 * radial-tangential and equidistant, wrong counts of numbers.
 */
CameraModel readCameraYaml(const std::string& path);
}  // namespace viwo
