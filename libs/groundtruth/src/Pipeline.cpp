#include "Pipeline.h"

#include "Refinement.h"

#include <viwo/core/Error.h>
#include <viwo/core/Scalars.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <numeric>

namespace viwo::gt
{
namespace
{
constexpr size_t kHoldoutStride = 10;
constexpr double kContradiction = 30;  // chi2 of a registration that the graph does not believe
/** Errors of ranges that depend on range, incidence and surface are common to many scans: averaging does not make them smaller. */
constexpr double kSystematic_m = 0.008;
constexpr double kLeastScale = 0.004;  // deviation of odometry's scale

double quantile(std::vector<double> values, double fraction)
{
	if (values.empty()) return 0;
	std::sort(values.begin(), values.end());
	return values[std::min(values.size() - 1, static_cast<size_t>(fraction * static_cast<double>(values.size())))];
}

HoldoutErrors compareHoldout(const std::vector<FinalPose>& poses, const std::function<bool(size_t)>& held_out)
{
	std::vector<double> metres, degrees;
	for (size_t i = 0; i < poses.size(); ++i)
	{
		if (!held_out(i) || !poses[i].matched) continue;
		const Pose2 d = between(*poses[i].matched, poses[i].T);
		metres.push_back(d.p.norm());
		degrees.push_back(std::abs(d.yaw) * 180 / M_PI);
	}
	return {metres.size(), quantile(metres, 0.5), quantile(metres, 0.95), quantile(degrees, 0.5), quantile(degrees, 0.95)};
}

/** Angle by which most surfaces stand off the axes, in (-45, 45] deg: from the mean of four times the directions of their normals. */
double offAxes_rad(const KeyScans& keys)
{
	double sine = 0, cosine = 0;
	for (size_t k = 0; k < keys.size(); ++k)
		for (const OrientedPoint& point : keys.clouds[k])
		{
			if (!point.hasNormal()) continue;
			const double angle = 4 * (std::atan2(point.n.y(), point.n.x()) + keys.poses[k].yaw);
			sine += std::sin(angle);
			cosine += std::cos(angle);
		}
	return std::atan2(sine, cosine) / 4;
}

void turnMap(double angle_rad, Solution& solution)
{
	const Pose2 T(0, 0, angle_rad);
	Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
	R.topLeftCorner<2, 2>() = T.R();
	for (Pose2& pose : solution.keys.poses) pose = T * pose;
	for (FinalPose& pose : solution.poses)
	{
		pose.T = T * pose.T;
		pose.covariance = R * pose.covariance * R.transpose();
	}
}

/** The loops that the caller put in: from and to the keys next to those scans. */
std::vector<GraphEdge> handMade(const std::vector<HandMadeLoop>& loops, const KeyScans& keys, const FrontEndResult& front_end)
{
	std::vector<GraphEdge> edges;
	for (const HandMadeLoop& loop : loops)
	{
		if (loop.from >= front_end.scans.size() || loop.to >= front_end.scans.size()) throw Error("loop by hand: there is no such scan");
		const auto keyOf = [&](size_t scan)
		{
			const auto after = std::upper_bound(keys.scan.begin(), keys.scan.end(), scan);
			return static_cast<size_t>(std::max<std::ptrdiff_t>(0, after - keys.scan.begin() - 1));
		};
		GraphEdge edge;
		edge.a = keyOf(loop.from);
		edge.b = keyOf(loop.to);
		if (edge.a == edge.b) throw Error("loop by hand: both scans belong to one key scan");
		const auto T_key_scan = [&](size_t key, size_t scan)
		{ return between(front_end.scans[keys.scan[key]].T, front_end.scans[scan].T); };
		edge.T_ab = T_key_scan(edge.a, loop.from) * Pose2(loop.x_m, loop.y_m, loop.yaw_rad) * T_key_scan(edge.b, loop.to).inverse();
		edge.information = Eigen::Vector3d(1e4, 1e4, 1e5).asDiagonal();
		edge.kind = GraphEdge::Kind::loop;
		edge.kernel = 1;
		edges.push_back(edge);
	}
	return edges;
}

std::vector<GraphEdge> odometryEdges(const std::vector<GraphEdge>& edges)
{
	std::vector<GraphEdge> kept;
	for (const GraphEdge& edge : edges)
		if (edge.kind == GraphEdge::Kind::odometry) kept.push_back(edge);
	return kept;
}

std::vector<FinalPose> frontEndPoses(const FrontEndResult& front_end)
{
	std::vector<FinalPose> poses;
	for (const TrackedScan& scan : front_end.scans)
	{
		FinalPose pose;
		pose.T = scan.T;
		pose.flag = scan.flag;
		poses.push_back(pose);
	}
	return poses;
}

/** A scale that real wheels can have. */
double plausible(const std::optional<double>& scale)
{
	return scale && *scale > 0.8 && *scale < 1.25 ? *scale : 1;
}

/** What the log itself says of its odometry. */
MotionCalibration calibrationOf(const OdometryCalibration& found, const FrontEndResult& front_end)
{
	return {plausible(found.distance_scale), plausible(found.turn_scale), found.distance_walk, found.gyro_bias_rad_s,
	        front_end.contradicted};
}

/** The systematic errors of the ranges are in the ways by scans too. */
CommonErrors commonErrors(const OdometryCalibration& found)
{
	if (!found.distance_scale_deviation) return {};
	return {std::hypot(*found.distance_scale_deviation, kLeastScale)};
}

/** Key scans that registrations tie to the most part of the map in all directions: beyond a corridor a place can be seen ever so well, its
 *  distance to the rest is still odometry's. */
std::vector<bool> tiedToMost(const std::vector<GraphEdge>& edges, const std::vector<Pose2>& poses)
{
	std::vector<size_t> part(poses.size());  // the least key that a key is tied to, by way of others
	std::iota(part.begin(), part.end(), size_t{0});
	const auto root = [&part](size_t k)
	{
		while (part[k] != k) k = part[k] = part[part[k]];
		return k;
	};
	for (const GraphEdge& edge : edges)
	{
		if (edge.kind == GraphEdge::Kind::odometry || chi2(edge, poses) > kContradiction) continue;
		if (!holdsAllDirections(edge)) continue;
		const size_t a = root(edge.a), b = root(edge.b);
		part[std::max(a, b)] = std::min(a, b);
	}
	std::vector<size_t> size(poses.size(), 0);
	for (size_t k = 0; k < poses.size(); ++k) ++size[root(k)];
	const auto largest = static_cast<size_t>(std::max_element(size.begin(), size.end()) - size.begin());
	std::vector<bool> tied(poses.size());
	for (size_t k = 0; k < poses.size(); ++k) tied[k] = root(k) == largest;
	return tied;
}

/** Whether a position is known well enough for its distance from the first pose. */
bool isSure(const FinalPose& pose, const Pose2& first, const GraphOptions& options)
{
	Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
	solver.computeDirect(pose.covariance.topLeftCorner<2, 2>(), Eigen::EigenvaluesOnly);
	const double limit_m = std::max(options.good_deviation_m, options.good_deviation_per_m * (pose.T.p - first.p).norm());
	return solver.eigenvalues()[1] <= square(limit_m);
}

/** A scan that lies well on its map does not make a good pose where the map itself is loose. */
void takeBackGood(const GraphOptions& options, Solution& solution)
{
	const std::vector<bool> tied = tiedToMost(solution.edges, solution.keys.poses);
	size_t key = 0;
	for (size_t i = 0; i < solution.poses.size(); ++i)
	{
		while (key + 1 < solution.keys.size() && solution.keys.scan[key + 1] <= i) ++key;
		FinalPose& pose = solution.poses[i];
		if (pose.flag == PoseFlag::good && (!tied[key] || !isSure(pose, solution.poses.front().T, options)))
			pose.flag = PoseFlag::degenerate;
	}
}

/** Chain edges that no scan supports: without them the refined graph could fall apart. */
void keepTogether(const std::vector<GraphEdge>& chain, std::vector<GraphEdge>& kept)
{
	for (GraphEdge edge : chain)
	{
		if (edge.kind != GraphEdge::Kind::scan) continue;
		edge.information = edge.information * 1e-3 + 1e-3 * Eigen::Matrix3d::Identity();
		kept.push_back(edge);
	}
}
}  // namespace

Solution solve(const Session& session, const GroundTruthRunOptions& run, const std::function<bool(double, const std::string&)>& progress)
{
	const GroundTruthOptions& options = run.options;
	const MotionModel uncalibrated(session, options.odometry);
	const Scales scales(session.range_noise_m);
	const auto held_out = [&](size_t i) { return run.holdout && i % kHoldoutStride == kHoldoutStride - 1; };
	const auto stage = [&](double begin, double end, const std::string& what)
	{ return [=, &progress](double fraction) { return progress(begin + fraction * (end - begin), what); }; };

	Solution solution;
	FrontEndResult front_end = trackScans(
	    session, uncalibrated, options, scales, [&](size_t i) { return !held_out(i); }, stage(0.1, 0.4, "tracking"));
	if (front_end.keys.empty())
		throw Error(run.rawlogs.front() + ": none of the " + std::to_string(session.scans.size()) +
		            " scans has enough valid beams on surfaces; check [scan] min_range_m and max_range_m");
	solution.window_searches = front_end.searches;
	solution.contradicted = front_end.contradicted.size();
	const OdometryCalibration found = calibrateOdometry(session, frontEndPoses(front_end));
	MotionCalibration calibration = calibrationOf(found, front_end);
	const MotionModel far(session, options.odometry, calibration);
	// From scan to scan, jitter of the stamps and quantisation weigh more than what grows with the way.
	calibration.distance_walk.reset();
	const MotionModel near(session, options.odometry, calibration);
	KeyScans& keys = solution.keys = keyScansOf(front_end);
	std::vector<GraphEdge> chain = chainEdges(keys, front_end, far, options.graph);
	std::vector<GraphEdge> kept = odometryEdges(chain);
	keepTogether(chain, kept);
	const std::vector<GraphEdge> by_hand = handMade(run.extra_loops, keys, front_end);
	chain.insert(chain.end(), by_hand.begin(), by_hand.end());

	LoopCloser closer(keys, chain, options, scales);
	solution.loops = closer.close(run.threads, stage(0.4, 0.6, "closing loops"));
	GyroTurns& gyro = solution.gyro = gyroTurns(keys, session, far, options.odometry);
	solution.edges = refineKeys(keys, kept, gyro, options, scales, run.threads, stage(0.6, 0.85, "refining"));
	const std::vector<Eigen::Matrix3d> covariances = graphCovariances(solution.edges, keys.poses, gyro, commonErrors(found));
	solution.poses = placeAllScans(session, front_end, keys, covariances, near, options, scales, held_out, run.threads,
	                               stage(0.85, 0.95, "placing scans"));
	for (size_t i = 1; i < solution.poses.size(); ++i)
		solution.poses[i].covariance.diagonal().head<2>().array() += kSystematic_m * kSystematic_m;
	if (run.holdout) solution.holdout = compareHoldout(solution.poses, held_out);
	solution.calibration = calibrateOdometry(session, solution.poses);
	takeBackGood(options.graph, solution);
	if (run.align_axes) turnMap(-offAxes_rad(keys), solution);
	return solution;
}
}  // namespace viwo::gt
