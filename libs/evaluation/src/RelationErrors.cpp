#include <viwo/core/Error.h>
#include <viwo/core/Scalars.h>
#include <viwo/evaluation/RelationErrors.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace viwo
{
namespace
{
/** x, y (m) and yaw (rad) in the plane. */
struct Planar
{
	double x, y, yaw;
};

/** b seen from a. */
Planar between(const Planar& a, const Planar& b)
{
	const double c = std::cos(a.yaw), s = std::sin(a.yaw), dx = b.x - a.x, dy = b.y - a.y;
	return {c * dx + s * dy, -s * dx + c * dy, std::remainder(b.yaw - a.yaw, 2 * M_PI)};
}

/** S at the pose nearest to a relation's time, if that is near enough. */
std::optional<Planar> poseAt(const Trajectory& trajectory, int64_t t_ns, const RelationOptions& options)
{
	if (!options.stamps.empty())
	{
		const auto found = options.stamps.find(toMicroseconds(t_ns));
		if (found == options.stamps.end()) return std::nullopt;
		t_ns = found->second;
	}
	const std::vector<StampedPose>& poses = trajectory.poses();
	const auto after = std::lower_bound(poses.begin(), poses.end(), t_ns, [](const StampedPose& pose, int64_t t) { return pose.t_ns < t; });
	auto nearest = after;
	if (after == poses.end() || (after != poses.begin() && t_ns - std::prev(after)->t_ns <= after->t_ns - t_ns))
	{
		if (after == poses.begin()) return std::nullopt;
		nearest = std::prev(after);
	}
	if (std::abs(nearest->t_ns - t_ns) > options.tolerance_ns) return std::nullopt;
	const Pose3 T = nearest->T * options.T_OS;
	return Planar{T.p.x(), T.p.y(), yawOf(T.R)};
}

RelationFigures figuresOf(const std::vector<double>& errors)
{
	RelationFigures f;
	const double n = static_cast<double>(errors.size());
	for (const double e : errors)
	{
		f.mean += e / n;
		f.rms += e * e / n;
		f.max = std::max(f.max, e);
	}
	// About the mean, not from the squares: a deviation far below the mean keeps its digits.
	for (const double e : errors) f.deviation += square(e - f.mean) / n;
	f.deviation = std::sqrt(f.deviation);
	f.rms = std::sqrt(f.rms);
	return f;
}
}  // namespace

RelationErrors relationErrors(const std::vector<Relation>& relations, const Trajectory& trajectory, const RelationOptions& options)
{
	RelationErrors result;
	result.relations = relations.size();
	std::vector<double> metres, degrees;
	for (const Relation& relation : relations)
	{
		const auto from = poseAt(trajectory, relation.from_ns, options), to = poseAt(trajectory, relation.to_ns, options);
		if (!from || !to) continue;
		const Planar error = between({relation.x_m, relation.y_m, relation.yaw_rad}, between(*from, *to));
		metres.push_back(std::hypot(error.x, error.y));
		degrees.push_back(std::abs(error.yaw) / kDegree);
	}
	if (metres.empty())
		throw Error("none of the " + std::to_string(relations.size()) +
		            " relations has both of its poses in the trajectory; a log with repaired stamps needs its table (--stamps)");
	result.evaluated = metres.size();
	result.translation_m = figuresOf(metres);
	result.rotation_deg = figuresOf(degrees);
	return result;
}

Json toJson(const RelationErrors& errors)
{
	Json json = {{"relations", errors.relations}, {"evaluated", errors.evaluated}};
	const auto add = [&json](const std::string& what, const std::string& unit, const RelationFigures& f)
	{
		json[what + "_mean_" + unit] = f.mean;
		json[what + "_deviation_" + unit] = f.deviation;
		json[what + "_max_" + unit] = f.max;
		json[what + "_rms_" + unit] = f.rms;
	};
	add("trans", "m", errors.translation_m);
	add("rot", "deg", errors.rotation_deg);
	return json;
}
}  // namespace viwo
