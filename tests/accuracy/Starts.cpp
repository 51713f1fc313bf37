#include "Groups.h"

#include <viwo/core/Error.h>
#include <viwo/sim/ImuModel.h>
#include <viwo/sim/Rig.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "Measure.h"

namespace viwo::accuracy
{
namespace
{
constexpr double kAfter_s = 10;

/** Figures of one start, in the order of the bars. */
struct Start
{
	double first_pose_s, tilt_deg, velocity_cm_s, yaw_rate_bias_mrad_s, ate_cm;
};

std::vector<SimulatedDrive> drives()
{
	const std::vector<std::string> overrides = {"lidar.enabled=false", "route.duration_s=13"};
	std::vector<SimulatedDrive> result;
	for (const char* kind : {"straight", "arc", "rotation", "standing"})
		result.push_back({std::string("start-") + kind, "lobby", std::string("start_") + kind, overrides});
	return result;
}

Eigen::Vector3d vectorOf(const Json& j)
{
	return {j[0].get<double>(), j[1].get<double>(), j[2].get<double>()};
}

/** What is true at one time. */
struct Truth
{
	Eigen::Quaterniond R_WO;
	Eigen::Vector3d v_WB_B;  //!< velocity of the IMU, in its own axes
	double yaw_rate_bias_rad_s;

	Truth(const SimulatedDrive& drive, uint64_t seed, int64_t t_ns)
	{
		sim::Rig rig;
		sim::Route route;
		sim::loadRun(drive.rigPath(), drive.routePath(), drive.overrides, rig, route);
		const sim::Motion motion(route, rig.floor, rig.vibration, seed);
		const sim::ImuModel imu(motion, rig.imu, seed);
		const sim::MotionState state = motion.at_ns(t_ns);
		const Pose3 T_OB = imu.T_OB_actual();
		R_WO = state.T_WO.R;
		v_WB_B = (R_WO * T_OB.R).conjugate() * (state.v_WO + R_WO * state.w_O.cross(T_OB.p));
		yaw_rate_bias_rad_s = (T_OB.R * imu.biasAt(secondsBetween(motion.epoch_ns(), t_ns)).gyro_rad_s).z();
	}
};

/** Angle between two verticals. */
double tilt_deg(const Eigen::Quaterniond& R_WO, const Eigen::Quaterniond& R_WO_true)
{
	const Eigen::Vector3d up = R_WO.conjugate() * Eigen::Vector3d::UnitZ(), true_up = R_WO_true.conjugate() * Eigen::Vector3d::UnitZ();
	return std::atan2(up.cross(true_up).norm(), up.dot(true_up)) * 180 / M_PI;
}

Trajectory cut(const Trajectory& trajectory, int64_t from_ns, int64_t to_ns)
{
	Trajectory part;
	for (const StampedPose& pose : trajectory.poses())
		if (pose.t_ns >= from_ns && pose.t_ns <= to_ns) part.push_back(pose);
	return part;
}

double ateAfter_m(const Outcome& outcome, int64_t from_ns)
{
	const int64_t to_ns = from_ns + nanoseconds(kAfter_s);
	const TrajectoryErrors errors =
	    evaluate(cut(outcome.truth(), from_ns, to_ns), cut(outcome.trajectory(), from_ns, to_ns), EvaluationOptions());
	const double required_s = kRequiredCoverage * kAfter_s;
	return errors.matched_duration_s >= required_s ? errors.ate_xyz_m : std::numeric_limits<double>::infinity();
}

Start measure(const SimulatedDrive& drive, uint64_t seed, const Outcome& outcome)
{
	const double never = std::numeric_limits<double>::infinity();
	if (outcome.failed()) return {never, never, never, never, never};
	const Json summary = outcome.summary();
	const Json& first = summary.at("first_pose");
	const int64_t t_ns = first.at("t_ns").get<int64_t>();
	const Truth truth(drive, seed, t_ns);

	const Json& q = first.at("R_WO_xyzw");
	const Eigen::Quaterniond R_WO(q[3].get<double>(), q[0].get<double>(), q[1].get<double>(), q[2].get<double>());
	Start start{};
	start.first_pose_s = summary.at("first_pose_s").get<double>();
	start.tilt_deg = tilt_deg(R_WO, truth.R_WO);
	start.velocity_cm_s = 100 * (vectorOf(first.at("v_WB_in_B_m_s")) - truth.v_WB_B).norm();
	start.yaw_rate_bias_mrad_s = 1000 * std::abs(vectorOf(first.at("gyro_bias_in_O_rad_s")).z() - truth.yaw_rate_bias_rad_s);
	start.ate_cm = 100 * ateAfter_m(outcome, t_ns);
	return start;
}

class Starts : public Group
{
   public:
	using Group::Group;
	std::vector<std::string> bars() const override;
	void plan(Runner& runner) const override;
	std::vector<Row> judge(const Runner& runner) const override;
};

std::vector<std::string> Starts::bars() const
{
	return {"start: time to the first pose", "start: tilt at the first pose", "start: velocity at the first pose",
	        "start: yaw-rate bias at the first pose", "start: ATE of the next 10 s"};
}

void Starts::plan(Runner& runner) const
{
	for (const SimulatedDrive& drive : drives())
		for (int seed = 1; seed <= settings_.seeds; ++seed) runner.want({drive.log(static_cast<uint64_t>(seed))});
}

std::vector<Row> Starts::judge(const Runner& runner) const
{
	struct Bar
	{
		double Start::*figure;
		double limit;
		const char* unit;
	};
	const std::array<Bar, 5> limits = {{{&Start::first_pose_s, 1, "s"},
	                                    {&Start::tilt_deg, 1, "deg"},
	                                    {&Start::velocity_cm_s, 2, "cm/s"},
	                                    {&Start::yaw_rate_bias_mrad_s, 3, "mrad/s"},
	                                    {&Start::ate_cm, 3, "cm"}}};
	std::array<std::vector<double>, 5> all;
	std::array<std::string, 5> details;
	for (const SimulatedDrive& drive : drives())
	{
		std::vector<Start> starts;
		for (int seed = 1; seed <= settings_.seeds; ++seed)
		{
			const RunRecipe run{drive.log(static_cast<uint64_t>(seed))};
			starts.push_back(measure(drive, static_cast<uint64_t>(seed), runner.outcome(run)));
		}
		for (size_t i = 0; i < limits.size(); ++i)
		{
			std::vector<double> figures;
			for (const Start& start : starts) figures.push_back(start.*limits[i].figure);
			details[i] += (details[i].empty() ? "" : "; ") + listOf(drive.name.substr(6), figures, 1, "");
			all[i].insert(all[i].end(), figures.begin(), figures.end());
		}
	}
	std::vector<Row> rows;
	for (size_t i = 0; i < limits.size(); ++i)
		rows.push_back(atMost(bars()[i], worst(all[i]), limits[i].limit, limits[i].unit, details[i]));
	return rows;
}
}  // namespace

std::unique_ptr<Group> starts(const Settings& settings)
{
	return std::make_unique<Starts>(settings);
}
}  // namespace viwo::accuracy
