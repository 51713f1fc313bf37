#include <mrpt/config/CConfigFile.h>
#include <mrpt/obs/CObservationImage.h>
#include <viwo/core/Error.h>
#include <viwo/core/MountingPose.h>
#include <viwo/core/MrptPose.h>
#include <viwo/rawlog/RawlogWriter.h>
#include <viwo/rawlog/RigFile.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace viwo
{
namespace
{
constexpr const char* kCamera = "CAMERA_PARAMS";  // MRPT's name for it
constexpr const char* kImu = "IMU";
constexpr const char* kWheels = "ODOMETRY";

/** To a billionth, so that 90 degrees stay 90 degrees. */
double rounded(double value)
{
	return std::round(value * 1e9) / 1e9 + 0.0;
}

std::vector<OptionsSection> sectionsOf(RigFile& rig)
{
	std::vector<OptionsSection> sections;
	if (rig.camera) sections.push_back({kCamera, &*rig.camera});
	if (rig.imu) sections.push_back({kImu, &*rig.imu});
	if (rig.wheels) sections.push_back({kWheels, &*rig.wheels});
	return sections;
}

std::set<std::string> sectionNames(const std::string& path)
{
	std::vector<std::string> names;
	mrpt::config::CConfigFile(path).getAllSections(names);
	return {names.begin(), names.end()};
}
}  // namespace

Pose3 MountedSensor::pose() const
{
	return mountingPose({x_m, y_m, z_m}, {yaw_deg, pitch_deg, roll_deg});
}

void MountedSensor::setPose(const Pose3& T_OS)
{
	const mrpt::poses::CPose3D pose = toMrpt(T_OS);
	x_m = rounded(pose.x());
	y_m = rounded(pose.y());
	z_m = rounded(pose.z());
	yaw_deg = rounded(pose.yaw() / kDegree);
	pitch_deg = rounded(pose.pitch() / kDegree);
	roll_deg = rounded(pose.roll() / kDegree);
}

CameraModel RigCamera::model() const
{
	const auto fail = [](const std::string& what) { return Error("[" + std::string(kCamera) + "] " + what); };
	const auto isSize = [](double n) { return n >= 1 && n <= 1e5 && n == std::floor(n); };
	if (resolution_px.size() != 2 || !isSize(resolution_px[0]) || !isSize(resolution_px[1]))
		throw fail("resolution: expected width and height in pixels, e.g. 640 480");
	if (fx_px <= 0 || fy_px <= 0) throw fail("fx, fy: the focal length is not above 0");
	const bool is_fisheye = distortion == CameraModel::Distortion::kannala_brandt;
	const size_t n = coefficients.size();
	if (distortion == CameraModel::Distortion::plumb_bob ? n != 4 && n != 5 : is_fisheye && n != 4)
		throw fail("dist: " + std::to_string(n) + " coefficients; " + (is_fisheye ? "kannala_brandt has 4" : "plumb_bob has 5"));
	std::array<double, 5> k{};
	if (distortion != CameraModel::Distortion::none) std::copy(coefficients.begin(), coefficients.end(), k.begin());
	return {static_cast<int>(resolution_px[0]), static_cast<int>(resolution_px[1]), fx_px, fy_px, cx_px, cy_px, distortion, k};
}

void RigCamera::setModel(const CameraModel& model)
{
	resolution_px = {static_cast<double>(model.width_px()), static_cast<double>(model.height_px())};
	fx_px = model.fx_px();
	fy_px = model.fy_px();
	cx_px = model.cx_px();
	cy_px = model.cy_px();
	distortion = model.distortion();
	const auto count = distortion == CameraModel::Distortion::kannala_brandt ? 4 : 5;  // MRPT wants some of an ideal lens, too
	coefficients.assign(model.coefficients().begin(), model.coefficients().begin() + count);
}

RigFile RigFile::load(const std::string& path)
{
	RigFile rig{RigCamera(), RigImu(), RigWheels(), path};
	loadOptions(path, sectionsOf(rig));
	const std::set<std::string> there = sectionNames(path);
	if (there.count(kCamera) == 0) rig.camera.reset();
	if (there.count(kImu) == 0) rig.imu.reset();
	if (there.count(kWheels) == 0) rig.wheels.reset();
	if (!rig.camera && !rig.imu && !rig.wheels)
		throw Error(path + ": no calibration in it: it has none of the sections [CAMERA_PARAMS], [IMU], [ODOMETRY]");
	try
	{
		if (rig.camera) rig.camera->model();
	}
	catch (const Error& e)
	{
		throw Error(path + ": " + e.what());
	}
	return rig;
}

void RigFile::save(const std::string& path, const std::string& header) const
{
	RigFile copy = *this;
	saveOptions(path, sectionsOf(copy), header);
}

void RigFile::apply(mrpt::obs::CObservation& observation) const
{
	if (camera && observation.sensorLabel == camera->mounting.label)
	{
		observation.setSensorPose(toMrpt(camera->mounting.pose()));
		if (auto* const image = dynamic_cast<mrpt::obs::CObservationImage*>(&observation)) image->cameraParams = toMrpt(camera->model());
	}
	if (imu && observation.sensorLabel == imu->mounting.label) observation.setSensorPose(toMrpt(imu->mounting.pose()));
}
}  // namespace viwo
