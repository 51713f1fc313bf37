#include "CameraFiles.h"

#include <mrpt/config/CConfigFile.h>
#include <mrpt/img/TCamera.h>
#include <viwo/core/Error.h>
#include <viwo/rawlog/RawlogWriter.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "YamlMap.h"

namespace viwo
{
namespace
{
/** What camera_time_offset_s of a rig may be. */
constexpr double kLargestShift_s = 10;

/** A matrix as a list of rows. */
std::vector<double> rowsOf(const YamlMap& yaml, const std::string& key)
{
	std::vector<double> values;
	const YAML::Node rows = yaml[key];
	if (!rows.IsSequence() || rows.size() != 4) yaml.fail(key, "not a matrix of 4 rows");
	for (const auto& row : rows)
		for (const double value : yaml.numbers(key, row, 4, 4)) values.push_back(value);
	return values;
}

/** ROS's "key: {rows, cols, data}". */
std::vector<double> dataOf(const YamlMap& yaml, const std::string& key, size_t min_count, size_t max_count)
{
	const auto matrix = yaml.map(key);
	if (!matrix) yaml.fail(key, "missing");
	return yaml.numbers(key, (*matrix)["data"], min_count, max_count);
}

std::string camerasIn(const YamlMap& file)
{
	std::string names;
	for (int i = 0; i < 10; ++i)
		if (const std::string name = "cam" + std::to_string(i); file.map(name)) names += (names.empty() ? "" : ", ") + name;
	return names.empty() ? "it has none" : "it has " + names;
}
}  // namespace

KalibrCamera readKalibrCamera(const std::string& path, const std::string& camera)
{
	const YamlMap file = YamlMap::load(path);
	const auto yaml = file.map(camera);
	if (!yaml) file.fail(camera, "no such camera; " + camerasIn(file));
	if (const std::string model = yaml->word("camera_model"); model != "pinhole")
		yaml->fail("camera_model", "'" + model + "' is not known here; calibrate it as pinhole-radtan or pinhole-equi");
	const auto distortion = lensModel(*yaml, "distortion_model");
	KalibrCamera result;
	const bool is_ideal = distortion == CameraModel::Distortion::none;
	const auto coefficients = is_ideal ? std::vector<double>() : yaml->numbers("distortion_coeffs", (*yaml)["distortion_coeffs"], 4, 4);
	result.model = pinholeModel(*yaml, yaml->numbers("resolution", (*yaml)["resolution"], 2, 2),
	                            yaml->numbers("intrinsics", (*yaml)["intrinsics"], 4, 4), distortion, coefficients);
	if ((*yaml)["T_cam_imu"]) result.T_CB = yaml->rigidTransform("T_cam_imu", rowsOf(*yaml, "T_cam_imu"));
	result.time_offset_s = (*yaml)["timeshift_cam_imu"] ? yaml->number("timeshift_cam_imu") : 0;
	if (std::abs(result.time_offset_s) > kLargestShift_s)
		yaml->fail("timeshift_cam_imu", "not between -10 and 10 s, as a rig's clocks are; check that both were stamped by one computer");
	return result;
}

CameraModel readRosCameraInfo(const std::string& path)
{
	const YamlMap yaml = YamlMap::load(path);
	const auto K = dataOf(yaml, "camera_matrix", 9, 9);
	std::vector<double> coefficients = dataOf(yaml, "distortion_coefficients", 0, 14);
	CameraModel::Distortion distortion = CameraModel::Distortion::plumb_bob;
	if (yaml.word("distortion_model") != "rational_polynomial") distortion = lensModel(yaml, "distortion_model");
	const size_t most = distortion == CameraModel::Distortion::kannala_brandt ? 4 : 5;
	if (std::any_of(coefficients.begin() + static_cast<std::ptrdiff_t>(std::min(most, coefficients.size())), coefficients.end(),
	                [](double k) { return k != 0; }))
		yaml.fail("distortion_coefficients", "more than " + std::to_string(most) + " of them are not 0; calibrate with fewer");
	coefficients.resize(distortion == CameraModel::Distortion::none ? 0 : std::min(most, coefficients.size()));
	return pinholeModel(yaml, {yaml.number("image_width"), yaml.number("image_height")}, {K[0], K[4], K[2], K[5]}, distortion, coefficients,
	                    {"image_width, image_height", "camera_matrix"});
}

CameraModel readMrptCamera(const std::string& path)
{
	if (!std::filesystem::is_regular_file(path)) throw Error(path + ": no such file; give the INI that MRPT's camera-calib saved");
	mrpt::config::CConfigFile file;
	try
	{
		file.setFileName(path);
	}
	catch (const std::exception&)
	{
		throw Error(path + ": not an INI file; give the one that MRPT's camera-calib saved");
	}
	if (!file.sectionExists("CAMERA_PARAMS"))
		throw Error(path + ": no section [CAMERA_PARAMS]; give the INI that MRPT's camera-calib saved");
	// Up to MRPT 2.1 there was one model, which had no name.
	if (!file.keyExists("CAMERA_PARAMS", "distortion_model")) file.write("CAMERA_PARAMS", "distortion_model", std::string("plumb_bob"));
	file.discardSavingChanges();  // which it would otherwise do to the user's file when it goes out of scope
	mrpt::img::TCamera camera;
	try
	{
		camera.loadFromConfigFile("CAMERA_PARAMS", file);
	}
	catch (const std::exception&)
	{
		throw Error(path + ": [CAMERA_PARAMS] is not complete; it needs resolution, fx, fy, cx, cy, dist");
	}
	try
	{
		return fromMrpt(camera);
	}
	catch (const Error& e)
	{
		throw Error(path + ": " + e.what());
	}
}
}  // namespace viwo
