#include "SensorYaml.h"

#include <vector>

#include "YamlMap.h"

namespace viwo
{
namespace
{
Pose3 poseOf(const YamlMap& yaml, const std::string& key)
{
	// "T_BS: {cols, rows, data}" in EuRoC; plain lists are met too.
	const YAML::Node node = yaml[key];
	const YAML::Node data = node && node.IsMap() ? node["data"] : node;
	const std::vector<double> v = yaml.numbers(key, data, 16, 16);
	return yaml.rigidTransform(key, v);
}
}  // namespace

SensorYaml readSensorYaml(const std::string& path)
{
	const YamlMap yaml = YamlMap::load(path);
	SensorYaml sensor;
	sensor.T_BS = poseOf(yaml, "T_BS");
	sensor.gyro_noise_rad_s_sqrtHz = yaml.optionalNumber("gyroscope_noise_density");
	sensor.gyro_walk_rad_s2_sqrtHz = yaml.optionalNumber("gyroscope_random_walk");
	sensor.acc_noise_m_s2_sqrtHz = yaml.optionalNumber("accelerometer_noise_density");
	sensor.acc_walk_m_s3_sqrtHz = yaml.optionalNumber("accelerometer_random_walk");
	return sensor;
}

CameraModel readCameraYaml(const std::string& path)
{
	const YamlMap yaml = YamlMap::load(path);
	if (const std::string model = yaml.word("camera_model"); model != "pinhole")
		yaml.fail("camera_model", "'" + model + "' is not known; only pinhole is");
	const auto size = yaml.numbers("resolution", yaml["resolution"], 2, 2);
	const auto f = yaml.numbers("intrinsics", yaml["intrinsics"], 4, 4);
	const auto distortion = lensModel(yaml, "distortion_model");
	std::vector<double> coefficients;
	if (distortion != CameraModel::Distortion::none)
	{
		const size_t most = distortion == CameraModel::Distortion::plumb_bob ? 5 : 4;
		coefficients = yaml.numbers("distortion_coefficients", yaml["distortion_coefficients"], 4, most);
	}
	return pinholeModel(yaml, size, f, distortion, coefficients);
}
}  // namespace viwo
