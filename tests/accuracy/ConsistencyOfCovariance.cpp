#include "Groups.h"

#include <viwo/evaluation/Consistency.h>
#include <viwo/odometry/OdometryOptions.h>

#include <cmath>
#include <sstream>

#include "Drives.h"

namespace viwo::accuracy
{
namespace
{
constexpr int kRuns = 20;

std::string setting(const std::string& key, double value)
{
	std::ostringstream text;
	text << key << "=" << value;
	return text.str();
}

/** Slope of the simulated floor for each mm of its height (sim::FloorOptions). */
constexpr double kSlope_deg_mm = 0.2;

/** A robot that errs as the estimator's configuration says: scales and track of the wheels drawn from their priors, noise of the wheels and
 * of the IMU of its densities, a floor that tilts the robot as the plane factor has it. Its left and right scales are independent, so their
 * mean has 1/sqrt(2) of the deviation of each and their difference sqrt(2) of it. (Side slip there is none in the simulator.) */
std::vector<RunRecipe> runs()
{
	const NoiseOptions noise = OdometryOptions().estimator.noise;
	const PriorOptions priors = OdometryOptions().estimator.priors;
	const SimulatedDrive drive{
	    "free",
	    "lobby",
	    "lobby_free",
	    {"lidar.enabled=false", "route.duration_s=45", "wheels.radius_error=0", "wheels.left_right_difference=0", "wheels.track_error=0",
	     setting("wheels.radius_deviation", priors.wheel_scale / std::sqrt(2)),
	     setting("wheels.left_right_deviation", priors.wheel_scale * std::sqrt(2)),
	     setting("wheels.track_deviation", priors.track_relative), setting("wheels.noise_m_s_sqrtHz", noise.wheels.s0_m_s_sqrtHz),
	     setting("wheels.noise_per_speed_sqrtHz", noise.wheels.k_sqrtHz),
	     setting("imu.acc_noise_m_s2_sqrtHz", noise.imu.acc_noise_m_s2_sqrtHz),
	     setting("imu.gyro_noise_rad_s_sqrtHz", noise.imu.gyro_noise_rad_s_sqrtHz),
	     setting("floor.height_rms_mm", priors.plane_factor_tilt_deg / kSlope_deg_mm)}};
	return runsOf(drive, kRuns);
}

Row within(const std::string& name, const Nees& nees, const std::string& detail)
{
	Row row = atMost(name, nees.average(), 2, "", detail);
	row.min = 0.5;
	return row;
}

void accumulate(Nees& sum, const Nees& more)
{
	sum.sum += more.sum;
	sum.degrees_of_freedom += more.degrees_of_freedom;
	sum.poses += more.poses;
}

class ConsistencyOfCovariance : public Group
{
   public:
	using Group::Group;
	std::vector<std::string> bars() const override;
	void plan(Runner& runner) const override;
	std::vector<Row> judge(const Runner& runner) const override;
};

std::vector<std::string> ConsistencyOfCovariance::bars() const
{
	return {"consistency over 20 runs: ANEES of position per degree of freedom", "consistency over 20 runs: ANEES of yaw"};
}

void ConsistencyOfCovariance::plan(Runner& runner) const
{
	wantAll(runner, runs());
}

std::vector<Row> ConsistencyOfCovariance::judge(const Runner& runner) const
{
	Nees position, yaw;
	std::vector<double> positions, yaws;
	size_t invalid = 0;
	for (const RunRecipe& run : runs())
	{
		const Outcome outcome = runner.outcome(run);
		if (outcome.failed()) throw Error(outcome.error);
		const auto covariances = loadCovariances(outcome.file("trajectory_covariance.csv"));
		const viwo::Consistency c = consistency(outcome.truth(), outcome.trajectory(), covariances, EvaluationOptions().max_gap_s);
		accumulate(position, c.position);
		accumulate(yaw, c.yaw);
		invalid += c.invalid;
		positions.push_back(c.position.average());
		yaws.push_back(c.yaw.average());
	}
	const std::string note = invalid == 0 ? "" : "; " + std::to_string(invalid) + " covariances are not positive definite";
	return {within(bars()[0], position, listOf("each run", positions, 1, "") + note),
	        within(bars()[1], yaw, listOf("each run", yaws, 1, ""))};
}
}  // namespace

std::unique_ptr<Group> consistencyOfCovariance(const Settings& settings)
{
	return std::make_unique<ConsistencyOfCovariance>(settings);
}
}  // namespace viwo::accuracy
