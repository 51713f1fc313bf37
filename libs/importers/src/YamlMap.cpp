#include "YamlMap.h"

#include <viwo/core/Error.h>
#include <viwo/core/NumberText.h>
#include <viwo/rawlog/RawlogWriter.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

namespace viwo
{
YamlMap YamlMap::load(const std::string& path)
{
	std::ifstream file(path);
	if (!file) throw Error(path + ": cannot be read; check its name, and that the recording is complete");
	std::string text;
	// OpenCV's "%YAML:1.0" is no directive that a YAML parser knows.
	for (std::string line; std::getline(file, line);) text += (line[0] == '%' ? std::string() : line) + "\n";
	YAML::Node root;
	try
	{
		root = YAML::Load(text);
	}
	catch (const YAML::Exception& e)
	{
		throw Error(path + ":" + std::to_string(e.mark.line + 1) + ": not valid YAML");
	}
	if (!root.IsMap()) throw Error(path + ": not a description of sensors (no keys)");
	return {path, "", root};
}

std::optional<YamlMap> YamlMap::map(const std::string& key) const
{
	const YAML::Node node = node_[key];
	if (!node || !node.IsMap()) return std::nullopt;
	return YamlMap(path_, prefix_ + key + ": ", node);
}

void YamlMap::fail(const std::string& key, const std::string& what) const
{
	throw Error(path_ + ": " + prefix_ + key + ": " + what);
}

std::string YamlMap::word(const std::string& key) const
{
	const YAML::Node node = node_[key];
	if (!node || !node.IsScalar()) fail(key, "missing");
	return node.as<std::string>();
}

double YamlMap::number(const std::string& key) const
{
	const auto value = optionalNumber(key);
	if (!value) fail(key, node_[key] && node_[key].IsScalar() ? "'" + word(key) + "' is not a finite number" : "a number is missing");
	return *value;
}

std::optional<double> YamlMap::optionalNumber(const std::string& key) const
{
	double value = 0;
	const YAML::Node node = node_[key];
	if (!node || !node.IsScalar() || !YAML::convert<double>::decode(node, value) || !std::isfinite(value)) return std::nullopt;
	return value;
}

std::vector<double> YamlMap::numbers(const std::string& key, const YAML::Node& node, size_t min_count, size_t max_count) const
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
		fail(key, counted(values.size(), "number") + " instead of " + std::to_string(min_count));
	return values;
}

Pose3 YamlMap::rigidTransform(const std::string& key, const std::vector<double>& rows) const
{
	const auto& v = rows;
	Eigen::Matrix3d R;
	R << v[0], v[1], v[2], v[4], v[5], v[6], v[8], v[9], v[10];
	if ((R * R.transpose() - Eigen::Matrix3d::Identity()).norm() > 1e-3 || R.determinant() < 0)
		fail(key, "its rotation is not orthonormal");
	if (std::abs(v[12]) + std::abs(v[13]) + std::abs(v[14]) + std::abs(v[15] - 1) > 1e-6)
		fail(key, "its last row is not 0 0 0 1; a matrix is given row by row, with the translation in the last column");
	return {Eigen::Quaterniond(R).normalized(), Eigen::Vector3d(v[3], v[7], v[11])};
}

CameraModel::Distortion lensModel(const YamlMap& yaml, const std::string& key)
{
	const std::string name = yaml.word(key);
	if (name == "radial-tangential" || name == "radtan" || name == "plumb_bob") return CameraModel::Distortion::plumb_bob;
	if (name == "equidistant" || name == "equi" || name == "fisheye" || name == "kannala_brandt")
		return CameraModel::Distortion::kannala_brandt;
	if (name == "none") return CameraModel::Distortion::none;
	yaml.fail(key, "'" + name + "' is not known; radial-tangential and equidistant are");
}

CameraModel pinholeModel(const YamlMap& yaml, const std::vector<double>& size_px, const std::vector<double>& focal_and_centre_px,
                         CameraModel::Distortion distortion, const std::vector<double>& coefficients, const PinholeKeys& keys)
{
	const auto& f = focal_and_centre_px;
	for (const double n_px : size_px)
		if (!(n_px >= 1 && n_px <= 1e5) || n_px != std::floor(n_px)) yaml.fail(keys.size, "not a size in whole pixels");
	if (f[0] <= 0 || f[1] <= 0) yaml.fail(keys.focal_and_centre, "focal length not above 0");
	std::array<double, 5> k{};
	std::copy(coefficients.begin(), coefficients.end(), k.begin());
	const CameraModel camera(static_cast<int>(size_px[0]), static_cast<int>(size_px[1]), f[0], f[1], f[2], f[3], distortion, k);
	try
	{
		return fromMrpt(toMrpt(camera));  // as an image of a rawlog will be judged
	}
	catch (const Error& e)
	{
		yaml.fail(keys.focal_and_centre, e.what());
	}
}
}  // namespace viwo
