#pragma once

#include <viwo/core/Trajectory.h>
#include <viwo/evaluation/Json.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace viwo
{
/** The pose of the robot at one time as seen from that at another: what a person measured, or matched by hand. */
struct Relation
{
	int64_t from_ns = 0, to_ns = 0;
	double x_m = 0, y_m = 0, yaw_rad = 0;
};

/** Lines `t1 t2 x y z roll pitch yaw` (s, m, rad); '#' lines and blank lines are skipped, z, roll and pitch are not used.
 *  @throws Error naming file and line: unreadable, too few words, no number; no relation at all.
 */
std::vector<Relation> loadRelations(const std::string& path);

/** Original stamps, in microseconds, to those of the rawlog, in nanoseconds. */
using StampTable = std::map<int64_t, int64_t>;

/** Rounded. */
constexpr int64_t toMicroseconds(int64_t t_ns)
{
	return (t_ns + (t_ns < 0 ? -500 : 500)) / 1000;
}

/** CSV with the header `rawlog_ns,original_s`, as an import of a log with repaired stamps writes it. @throws Error naming file and line. */
StampTable loadStampTable(const std::string& path);

/** Figures of the errors of all relations. */
struct RelationFigures
{
	double mean = 0, deviation = 0, max = 0;  //!< of absolute errors; deviation of the population
	double rms = 0;
};

/** Errors of a trajectory against measured relative poses. */
struct RelationErrors
{
	size_t relations = 0;  //!< given
	size_t evaluated = 0;  //!< of these, with both poses in the trajectory
	RelationFigures translation_m, rotation_deg;
};

/** Which poses the relations are between. */
struct RelationOptions
{
	int64_t tolerance_ns = 2000;  //!< between a relation's time and that of a pose
	StampTable stamps;            //!< the relations have original stamps, the trajectory those of the rawlog; empty: the same
	Pose3 T_OS;                   //!< the relations are between poses of S, a frame on the robot; identity: of O itself
};

/** Relation error after Kuemmerle et al., "On measuring the accuracy of SLAM algorithms", Autonomous Robots 27 (2009): the error of each
 *  relation is ref^-1 * estimate; its translation and its rotation are judged apart. Needs no common frame.
 *  @throws Error when no relation has both of its poses.
 */
RelationErrors relationErrors(const std::vector<Relation>& relations, const Trajectory& trajectory, const RelationOptions& options = {});

/** Keys trans_mean_m, trans_deviation_m, trans_max_m, trans_rms_m, rot_..._deg, relations, evaluated. */
Json toJson(const RelationErrors& errors);
}  // namespace viwo
