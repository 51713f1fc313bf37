#include <mrpt/config/CConfigFile.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <viwo/core/Error.h>
#include <viwo/sim/Mounting.h>
#include <viwo/sim/Rig.h>

#include <algorithm>

namespace viwo::sim
{
CameraModel CameraOptions::model() const
{
	std::array<double, 5> c{};
	if (coefficients.size() > c.size()) throw Error("[camera] coefficients: at most five numbers");
	std::copy(coefficients.begin(), coefficients.end(), c.begin());
	return {width_px, height_px, fx_px, fy_px, cx_px, cy_px, distortion, c};
}

std::vector<OptionsSection> Rig::sections()
{
	return {{"floor", &floor},       {"vibration", &vibration},         {"imu", &imu},    {"wheels", &wheels}, {"camera", &camera},
	        {"renderer", &renderer}, {"image_effects", &image_effects}, {"lidar", &lidar}};
}

Calibration Rig::nominalCalibration() const
{
	Calibration c;
	c.T_OB = Mounting(imu.pose, imu.pose_error, "imu").nominal;
	c.T_OC = Mounting(camera.pose, camera.pose_error, "camera").nominal;
	c.camera = camera.model();
	c.wheels.track_m = wheels.track_m;
	return c;
}

Calibration Rig::actualCalibration(const Motion& motion, uint64_t seed) const
{
	Calibration c = nominalCalibration();
	c.T_OB = Mounting(imu.pose, imu.pose_error, "imu").actual;
	c.T_OC = Mounting(camera.pose, camera.pose_error, "camera").actual;
	c.wheels = WheelModel(motion, wheels, seed).actual();
	return c;
}

namespace
{
void overrule(const std::string& word, const std::vector<OptionsSection>& sections)
{
	const size_t equals = word.find('='), dot = word.find('.');
	if (equals == std::string::npos || dot == std::string::npos || dot > equals)
		throw Error("--set " + word + ": expected section.key=value, e.g. wheels.radius_error=0");
	const std::string name = word.substr(0, dot);
	const auto section = std::find_if(sections.begin(), sections.end(), [&](const OptionsSection& s) { return s.name == name; });
	if (section == sections.end())
	{
		std::string names;
		for (const OptionsSection& s : sections) names += (names.empty() ? "" : ", ") + s.name;
		throw Error("--set " + word + ": there is no section " + name + "; sections: " + names);
	}
	mrpt::config::CConfigFileMemory memory;
	memory.write(name, word.substr(dot + 1, equals - dot - 1), word.substr(equals + 1));
	try
	{
		section->options->loadFromConfigFile(memory, name);
	}
	catch (const Error& e)
	{
		throw Error(std::string("--set ") + e.what());
	}
}

/** So that a route given as a rig does not pass for a rig of defaults. */
void requireSection(const std::string& path, const std::vector<OptionsSection>& sections, const char* kind)
{
	const mrpt::config::CConfigFile file(path);
	if (std::none_of(sections.begin(), sections.end(), [&](const OptionsSection& s) { return file.sectionExists(s.name); }))
		throw Error(path + ": this is not a " + kind + " file, it has no section [" + sections.front().name + "]");
}
}  // namespace

void loadRun(const std::string& rig_ini, const std::string& route_ini, const std::vector<std::string>& overrides, Rig& rig, Route& route)
{
	// Each file may hold the other's sections too, as the one written beside a log does.
	Rig unused_rig;
	Route unused_route;
	std::vector<OptionsSection> sections = rig.sections(), route_file_sections = unused_rig.sections();
	std::vector<OptionsSection> rig_file_sections = sections;
	rig_file_sections.push_back({"route", &unused_route});
	route_file_sections.push_back({"route", &route});
	loadOptions(rig_ini, rig_file_sections);
	loadOptions(route_ini, route_file_sections);
	requireSection(rig_ini, sections, "rig");
	sections = {{"route", &route}};
	requireSection(route_ini, sections, "route");
	sections = rig.sections();
	sections.push_back({"route", &route});
	for (const std::string& word : overrides) overrule(word, sections);
}
}  // namespace viwo::sim
