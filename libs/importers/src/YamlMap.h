#pragma once

#include <viwo/core/CameraModel.h>
#include <viwo/core/Pose3.h>

#include <yaml-cpp/yaml.h>

#include <optional>
#include <string>
#include <vector>

namespace viwo
{
/** A map of a YAML file, whose messages name file and key. All its functions throw Error. */
class YamlMap
{
   public:
	/** OpenCV's "%YAML:1.0" is passed over. @throws Error: cannot be read, not valid YAML, no keys at its top. */
	static YamlMap load(const std::string& path);

	/** The map under a key, if there is one. */
	std::optional<YamlMap> map(const std::string& key) const;

	YAML::Node operator[](const std::string& key) const { return node_[key]; }

	/** Throws Error("<file>: <key>: <what>"). */
	[[noreturn]] void fail(const std::string& key, const std::string& what) const;

	std::string word(const std::string& key) const;
	double number(const std::string& key) const;
	/** Nothing where it is missing or not finite. */
	std::optional<double> optionalNumber(const std::string& key) const;
	std::vector<double> numbers(const std::string& key, const YAML::Node& node, size_t min_count, size_t max_count) const;

	/** Of the 16 numbers of a homogeneous matrix, row by row. @throws Error where it is no rigid transform. */
	Pose3 rigidTransform(const std::string& key, const std::vector<double>& rows) const;

	const std::string& path() const { return path_; }

   private:
	YamlMap(std::string path, std::string prefix, YAML::Node node)
	    : path_(std::move(path)), prefix_(std::move(prefix)), node_(std::move(node))
	{
	}

	std::string path_, prefix_;
	YAML::Node node_;
};

/** The distortion under its many names: radtan, equidistant, ... @throws Error for others. */
CameraModel::Distortion lensModel(const YamlMap& yaml, const std::string& key);

/** Under which keys a message names what is wrong. */
struct PinholeKeys
{
	std::string size = "resolution", focal_and_centre = "intrinsics";
};

/** @param size_px width, height. @param focal_and_centre_px fx fy cx cy. @throws Error naming the key: what fromMrpt() would not take. */
CameraModel pinholeModel(const YamlMap& yaml, const std::vector<double>& size_px, const std::vector<double>& focal_and_centre_px,
                         CameraModel::Distortion distortion, const std::vector<double>& coefficients, const PinholeKeys& keys = {});
}  // namespace viwo
