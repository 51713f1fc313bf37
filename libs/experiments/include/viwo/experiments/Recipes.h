#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace viwo::experiments
{
/** A rawlog with its truth, and how it is made. */
struct LogRecipe
{
	std::string name;                    //!< for messages and folders
	std::string program;                 //!< viwo-sim, viwo-import or another that makes a log, -o X.rawlog
	std::vector<std::string> arguments;  //!< all but -o
	std::string content;                 //!< of all inputs: logs of the same content are the same log
	bool cached = true;                  //!< false: made anew every time
	/** A log that this one is made of; it stands before the arguments. */
	std::shared_ptr<const LogRecipe> made_of;
	/** A log that has the same images; they are taken from there. */
	std::shared_ptr<const LogRecipe> same_images;
	double cost_s = 1;  //!< about how long it takes
};

/** Whether a log keeps its images when these are overruled: section.key=value of wheels and IMU. */
bool cameraIsBlindTo(const std::vector<std::string>& overrides);

/** A drive that is simulated. */
struct SimulatedDrive
{
	std::string name;   //!< short, e.g. "corridor"
	std::string world;  //!< names of files of share/viwo
	std::string route;
	std::vector<std::string> overrides;  //!< section.key=value of route and rig
	std::string rig = "turtlebot2";
	std::shared_ptr<const SimulatedDrive> same_images = nullptr;  //!< a drive with the same images, of which this one takes them over

	/** @param what added to the name. */
	SimulatedDrive with(const std::string& what, const std::vector<std::string>& more) const;
	LogRecipe log(uint64_t seed) const;
	std::string worldPath() const;
	std::string routePath() const;
	std::string rigPath() const;
};

/** A run of viwo-odometry on a log. */
struct RunRecipe
{
	RunRecipe(LogRecipe of_log) : log(std::move(of_log)) {}

	LogRecipe log;
	std::string mode = "viwo";
	std::string variant;                 //!< told apart from other runs of that mode on that log
	std::vector<std::string> overrides;  //!< section.key=value of the configuration
	std::string config;                  //!< a file of share/viwo/config_files/viwo-odometry; empty: the default
	std::string rig;                     //!< path of a rig.ini to go by; empty: what the log says
	double from_s = 0;                   //!< of the log, from its first stamp
	double to_s = 0;                     //!< 0: to its end
	double cost_s = 1;                   //!< about how long it takes
	bool alone = false;                  //!< nothing else runs meanwhile
	bool loaded = false;                 //!< all other cores are busy meanwhile

	std::string name() const { return log.name + "-" + mode + (variant.empty() ? "" : "-" + variant); }
};

/** A run of viwo-calibrate estimate on a log. */
struct CalibrationRecipe
{
	LogRecipe log;
	std::string start;  //!< path of the rig.ini to start from
	double cost_s = 1;  //!< about how long it takes
};
}  // namespace viwo::experiments
