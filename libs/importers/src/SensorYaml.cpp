#include "SensorYaml.h"

#include <viwo/core/Error.h>

#include <yaml-cpp/yaml.h>
#include <Eigen/SVD>

#include <cmath>
#include <fstream>
#include <vector>

namespace viwo
{
namespace
{
class YamlFile
{
   public:
	explicit YamlFile(const std::string& path) : path_(path)
	{
		std::ifstream file(path);
		if (!file) throw Error(path + ": cannot be read; check that the folder is a complete recording");
		std::string text;
		// OpenCV's "%YAML:1.0" is no directive that a YAML parser knows.
		for (std::string line; std::getline(file, line);) text += (line[0] == '%' ? std::string() : line) + "\n";
		try
		{
			root_ = YAML::Load(text);
		}
		catch (const YAML::Exception& e)
		{
			throw Error(path + ":" + std::to_string(e.mark.line + 1) + ": not valid YAML");
		}
		if (!root_.IsMap()) throw Error(path + ": not a sensor description (no keys)");
	}

	YAML::Node operator[](const std::string& key) const { return root_[key]; }

	[[noreturn]] void fail(const std::string& key, const std::string& what) const { throw Error(path_ + ": " + key + ": " + what); }

	std::string word(const std::string& key) const
	{
		if (!root_[key] || !root_[key].IsScalar()) fail(key, "missing");
		return root_[key].as<std::string>();
	}

	std::vector<double> numbers(const std::string& key, const YAML::Node& node, size_t min_count, size_t max_count) const
	{
		if (!node || !node.IsSequence()) fail(key, "a list of numbers is missing");
		std::vector<double> values;
		for (const auto& element : node)
		{
			double value = 0;
			if (!element.IsScalar() || !YAML::convert<double>::decode(element, value) || !std::isfinite(value))
				fail(key, "not a list of finite numbers");
			values.push_back(value);
		}
		if (values.size() < min_count || values.size() > max_count)
			fail(key, std::to_string(values.size()) + " numbers instead of " + std::to_string(min_count));
		return values;
	}

	std::optional<double> optionalNumber(const std::string& key) const
	{
		double value = 0;
		const YAML::Node node = root_[key];
		if (!node || !node.IsScalar() || !YAML::convert<double>::decode(node, value)) return std::nullopt;
		return value;
	}

   private:
	std::string path_;
	YAML::Node root_;
};

Pose3 poseOf(const YamlFile& yaml, const std::string& key)
{
	// "T_BS: {cols, rows, data}" in EuRoC; plain lists are met too.
	const YAML::Node node = yaml[key];
	const YAML::Node data = node && node.IsMap() ? node["data"] : node;
	const std::vector<double> v = yaml.numbers(key, data, 16, 16);
	Eigen::Matrix3d R;
	R << v[0], v[1], v[2], v[4], v[5], v[6], v[8], v[9], v[10];
	if ((R * R.transpose() - Eigen::Matrix3d::Identity()).norm() > 1e-3 || R.determinant() < 0)
		yaml.fail(key, "its rotation is not orthonormal");
	return {Eigen::Quaterniond(R).normalized(), Eigen::Vector3d(v[3], v[7], v[11])};
}
}  // namespace

SensorYaml readSensorYaml(const std::string& path)
{
	const YamlFile yaml(path);
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
	const YamlFile yaml(path);
	if (const std::string model = yaml.word("camera_model"); model != "pinhole")
		yaml.fail("camera_model", "'" + model + "' is not known; only pinhole is");
	const auto size = yaml.numbers("resolution", yaml["resolution"], 2, 2);
	const auto f = yaml.numbers("intrinsics", yaml["intrinsics"], 4, 4);
	if (size[0] < 1 || size[1] < 1) yaml.fail("resolution", "not a size in pixels");
	if (f[0] <= 0 || f[1] <= 0) yaml.fail("intrinsics", "focal length not above 0");
	const std::string name = yaml.word("distortion_model");
	CameraModel::Distortion distortion = CameraModel::Distortion::none;
	if (name == "radial-tangential" || name == "radtan" || name == "plumb_bob")
		distortion = CameraModel::Distortion::plumb_bob;
	else if (name == "equidistant" || name == "kannala_brandt")
		distortion = CameraModel::Distortion::kannala_brandt;
	else if (name != "none")
		yaml.fail("distortion_model", "'" + name + "' is not known; radial-tangential and equidistant are");
	std::array<double, 5> coefficients{};
	if (distortion != CameraModel::Distortion::none)
	{
		const size_t most = distortion == CameraModel::Distortion::plumb_bob ? 5 : 4;
		const auto k = yaml.numbers("distortion_coefficients", yaml["distortion_coefficients"], 4, most);
		std::copy(k.begin(), k.end(), coefficients.begin());
	}
	return {static_cast<int>(size[0]), static_cast<int>(size[1]), f[0], f[1], f[2], f[3], distortion, coefficients};
}
}  // namespace viwo
