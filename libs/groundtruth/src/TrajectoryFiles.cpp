#include "TrajectoryFiles.h"

#include <mrpt/core/format.h>
#include <viwo/core/AtomicFile.h>
#include <viwo/core/TimeText.h>
#include <viwo/core/Trajectory.h>

namespace viwo::gt
{
namespace
{
/** Upper triangle of x y z roll pitch yaw; what a planar source does not know stays empty. */
std::string covarianceCells(const Eigen::Matrix3d& covariance)
{
	static const int planar[] = {0, 1, -1, -1, -1, 2};
	std::string cells;
	for (int i = 0; i < 6; ++i)
		for (int j = i; j < 6; ++j)
		{
			cells += ",";
			if (planar[i] >= 0 && planar[j] >= 0) cells += mrpt::format("%.6e", covariance(planar[i], planar[j]));
		}
	return cells;
}

void writeCovariances(const std::string& path, const Session& session, const std::vector<FinalPose>& poses)
{
	static const char* const names[] = {"x", "y", "z", "roll", "pitch", "yaw"};
	AtomicFile file(path);
	file.stream()
	    << "# frame: O relative to the first pose; position in the map's axes (m), yaw (rad); z, roll and pitch are not observed\nt_s";
	for (int i = 0; i < 6; ++i)
		for (int j = i; j < 6; ++j) file.stream() << "," << names[i] << "_" << names[j];
	file.stream() << ",flag\n";
	for (size_t i = 0; i < poses.size(); ++i)
		file.stream() << formatSeconds(session.scans[i].t_ns) << covarianceCells(poses[i].covariance) << "," << nameOf(poses[i].flag)
		              << "\n";
	file.commit();
}
}  // namespace

void writeTrajectory(const std::string& dir, const Session& session, const std::vector<FinalPose>& poses)
{
	Trajectory trajectory;
	for (size_t i = 0; i < poses.size(); ++i)
	{
		const Pose2& T = poses[i].T;
		trajectory.push_back({session.scans[i].t_ns, Pose3(Eigen::Quaterniond(Eigen::AngleAxisd(T.yaw, Eigen::Vector3d::UnitZ())),
		                                                   Eigen::Vector3d(T.p.x(), T.p.y(), 0))});
	}
	trajectory.saveTum(dir + "/trajectory.tum");
	writeCovariances(dir + "/trajectory_covariance.csv", session, poses);
}

void writeGraph(const std::string& dir, const Session& session, const KeyScans& keys, const std::vector<GraphEdge>& edges,
                const GyroTurns& gyro)
{
	AtomicFile graph(dir + "/graph.g2o"), stamps(dir + "/graph_stamps.csv");
	stamps.stream() << "id,t_ns\n";
	for (size_t k = 0; k < keys.size(); ++k)
	{
		const Pose2& T = keys.poses[k];
		graph.stream() << mrpt::format("VERTEX_SE2 %zu %.9f %.9f %.9f\n", keys.scan[k], T.p.x(), T.p.y(), T.yaw);
		stamps.stream() << keys.scan[k] << "," << session.scans[keys.scan[k]].t_ns << "\n";
	}
	for (const GraphEdge& e : edges)
	{
		const Eigen::Matrix3d I = gyro.turns.empty() ? e.information : informationOfMany(e);
		graph.stream() << mrpt::format("EDGE_SE2 %zu %zu %.9f %.9f %.9f %.6g %.6g %.6g %.6g %.6g %.6g\n", keys.scan[e.a], keys.scan[e.b],
		                               e.T_ab.p.x(), e.T_ab.p.y(), e.T_ab.yaw, I(0, 0), I(0, 1), I(0, 2), I(1, 1), I(1, 2), I(2, 2));
	}
	for (const GyroTurn& turn : gyro.turns)
		graph.stream() << mrpt::format("EDGE_SE2 %zu %zu 0 0 %.9f 0 0 0 0 0 %.6g\n", keys.scan[turn.a], keys.scan[turn.b],
		                               wrapped(turn.turn_rad - gyro.biases_rad_s[turn.bias] * turn.dt_s), turn.information);
	graph.commit();
	stamps.commit();
}
}  // namespace viwo::gt
