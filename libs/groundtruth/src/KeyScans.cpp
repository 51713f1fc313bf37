#include "KeyScans.h"

#include <viwo/core/Scalars.h>
#include <viwo/core/Time.h>

#include <algorithm>

namespace viwo::gt
{
namespace
{
/** A pose that nothing tells: wide enough to mean nothing, tight enough to keep the graph in one piece. */
Eigen::Matrix3d weakInformation()
{
	return Eigen::Vector3d(1 / 0.25, 1 / 0.25, 1 / 0.1).asDiagonal();
}

/** Information in the map's axes as one in those of pose T. */
Eigen::Matrix3d inAxesOf(const Pose2& T, const Eigen::Matrix3d& information)
{
	Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
	R.topLeftCorner<2, 2>() = T.R();
	return R.transpose() * information * R;
}
}  // namespace

KeyScans keyScansOf(FrontEndResult& front_end)
{
	KeyScans keys;
	keys.scan = front_end.keys;
	keys.clouds = std::move(front_end.key_clouds);
	for (const size_t i : keys.scan)
	{
		const Pose2& T = front_end.scans[i].T;
		keys.way_m.push_back(keys.poses.empty() ? 0 : keys.way_m.back() + (T.p - keys.poses.back().p).norm());
		keys.poses.push_back(T);
	}
	return keys;
}

std::optional<GraphEdge> odometryEdge(const KeyScans& keys, size_t a, double trust, const MotionModel& motion, const GraphOptions& options)
{
	const auto m = motion.between(keys.scan[a], keys.scan[a + 1]);
	if (!m) return std::nullopt;
	GraphEdge edge;
	edge.a = a;
	edge.b = a + 1;
	edge.T_ab = m->T_ab;
	// Errors of odometry are systematic: over many edges even a little weight would bend what the scans know. Where they leave a direction
	// open, odometry is all there is.
	const double weight = options.odometry_edges ? trust * options.odometry_weight + (1 - trust) * options.odometry_weight_degenerate : 0;
	edge.information = m->information * std::max(weight, 1e-4);
	edge.kind = GraphEdge::Kind::odometry;
	// Wheels slip and robots are pushed: odometry never outvotes scans that know better. Where they do not, a tight kernel would let it go
	// at the first wrong registration.
	edge.kernel = trust < 1 ? 10 : 2;
	return edge;
}

GyroTurns gyroTurns(const KeyScans& keys, const Session& session, const MotionModel& motion, const MotionNoiseOptions& options)
{
	GyroTurns gyro;
	for (size_t k = 0; k + 1 < keys.size(); ++k)
	{
		auto turn = motion.turnByGyro(keys.scan[k], keys.scan[k + 1]);
		if (!turn) continue;
		turn->a = k;
		turn->b = k + 1;
		const double t_s = secondsBetween(session.scans.front().t_ns, session.scans[keys.scan[k]].t_ns);
		turn->bias = static_cast<size_t>(t_s / GyroTurns::kBiasTime_s);
		gyro.turns.push_back(*turn);
	}
	if (!gyro.turns.empty()) gyro.biases_rad_s.assign(gyro.turns.back().bias + 1, 0);
	gyro.walk_rad_s = options.gyro_bias_walk_deg_s * kDegree * std::sqrt(GyroTurns::kBiasTime_s);
	return gyro;
}

std::vector<GraphEdge> chainEdges(const KeyScans& keys, const FrontEndResult& front_end, const MotionModel& motion,
                                  const GraphOptions& options)
{
	std::vector<GraphEdge> edges;
	for (size_t k = 0; k + 1 < keys.size(); ++k)
	{
		const TrackedScan &a = front_end.scans[keys.scan[k]], &b = front_end.scans[keys.scan[k + 1]];
		GraphEdge edge;
		edge.a = k;
		edge.b = k + 1;
		edge.T_ab = between(a.T, b.T);
		edge.information = inAxesOf(a.T, b.information / options.inflation);
		const auto odometry = odometryEdge(keys, k, std::min(a.trust, b.trust), motion, options);
		if (odometry) edges.push_back(*odometry);
		if (!odometry || b.flag == PoseFlag::odometry_only) edge.information += weakInformation();
		edges.push_back(edge);
	}
	return edges;
}
}  // namespace viwo::gt
