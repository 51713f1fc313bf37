#pragma once

#include <viwo/sim/Rig.h>

#include <functional>
#include <memory>
#include <string>

namespace viwo::sim
{
/** How a simulation is carried out; but for the images it changes no file. */
struct SimulationRunOptions
{
	bool images = true;  //!< false: a log without a camera
	/** Folder of another run's images that are taken over instead of rendering: it must have had the same world, route, camera, floor,
	 * vibration and seed, but may have had other wheels or another IMU. */
	std::string images_from;
	int threads = 1;  //!< that render; the files do not depend on it
	/** Called from the calling thread with the part that is done, 0 to 1; false ends the run: what is finished is kept as a shorter log. */
	std::function<bool(double fraction)> progress;
};

/** What a simulation wrote. */
struct SimulationResult
{
	std::string rawlog, ground_truth, configuration;  //!< paths of what was written
	double duration_s = 0;
	double length_m = 0;
	int64_t images = 0, imu = 0, odometry = 0, scans = 0;
	bool interrupted = false;
};

/** A robot that drives a route through a world and records a rawlog, with its exact ground truth beside it. Same inputs and seed, same
 * bytes. */
class Simulation
{
   public:
	/** @throws Error for options that do not fit together. */
	Simulation(World world, const Route& route, const Rig& rig, uint64_t seed);
	~Simulation();

	const Motion& motion() const { return motion_; }

	/** Writes `X.rawlog`, `X_Images/`, `X_ground_truth.tum` (T_WO at 200 Hz, W the simulated world) and `X_simulation.ini` (all options).
	 *  Entries are in order of arrival: stamps of different sensors may go back by their latencies.
	 *  @param rawlog_path must end in ".rawlog". @throws Error when a file cannot be written.
	 */
	SimulationResult run(const std::string& rawlog_path, const SimulationRunOptions& options = {});

   private:
	class Recorder;

	World world_;
	Route route_;
	Rig rig_;
	uint64_t seed_;
	Motion motion_;
};
}  // namespace viwo::sim
