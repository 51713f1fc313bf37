#include <mrpt/core/format.h>
#include <viwo/core/AtomicFile.h>
#include <viwo/core/Error.h>
#include <viwo/core/PoseRows.h>
#include <viwo/core/Ranking.h>
#include <viwo/core/Time.h>
#include <viwo/core/TimeText.h>
#include <viwo/core/Trajectory.h>

#include <algorithm>

namespace viwo
{
double coveredDuration_s(const std::vector<int64_t>& stamps_ns, double max_gap_s)
{
	std::vector<double> intervals_s;
	for (size_t i = 1; i < stamps_ns.size(); ++i) intervals_s.push_back(secondsBetween(stamps_ns[i - 1], stamps_ns[i]));
	if (intervals_s.empty()) return 0;
	std::vector<double> sorted = intervals_s;
	const double limit_s = std::max(max_gap_s, 3 * upperMedian(sorted));
	double sum_s = 0;
	for (const double interval_s : intervals_s)
		if (interval_s <= limit_s) sum_s += interval_s;
	return sum_s;
}

Trajectory Trajectory::loadTum(const std::string& path)
{
	TextRows rows(path, TextRows::Split::blanks);
	Trajectory trajectory;
	while (rows.next())
	{
		rows.expectWords(8, false, "a TUM trajectory has t x y z qx qy qz qw, with blanks between");
		const Eigen::Vector3d p(rows.number(1), rows.number(2), rows.number(3));
		appendPose(rows, {rows.seconds_ns(0), Pose3(rows.rotation(7, 4, 5, 6), p)}, trajectory);
	}
	if (trajectory.empty()) throw Error(path + ": no pose in this trajectory");
	return trajectory;
}

void appendPose(const TextRows& rows, const StampedPose& pose, Trajectory& trajectory)
{
	if (!trajectory.empty() && pose.t_ns <= trajectory.poses().back().t_ns)
		rows.fail("stamp not later than that of the pose before; sort the file by time and remove doubles");
	trajectory.push_back(pose);
}

std::string poseRow(const Pose3& T)
{
	return mrpt::format("%.9f %.9f %.9f %.12f %.12f %.12f %.12f", T.p.x(), T.p.y(), T.p.z(), T.R.x(), T.R.y(), T.R.z(), T.R.w());
}

void Trajectory::saveTum(const std::string& path) const
{
	AtomicFile file(path);
	for (const auto& pose : poses_) file.stream() << formatSeconds(pose.t_ns) << " " << poseRow(pose.T) << "\n";
	file.commit();
}

void Trajectory::push_back(const StampedPose& pose)
{
	if (!poses_.empty() && pose.t_ns <= poses_.back().t_ns)
		throw Error("trajectory: pose at " + formatSeconds(pose.t_ns) + " s is not later than the last, at " +
		            formatSeconds(poses_.back().t_ns) + " s");
	poses_.push_back(pose);
}

std::optional<Pose3> Trajectory::at(int64_t t_ns, double max_gap_s) const
{
	const auto after =
	    std::lower_bound(poses_.begin(), poses_.end(), t_ns, [](const StampedPose& pose, int64_t t) { return pose.t_ns < t; });
	if (after == poses_.end()) return std::nullopt;
	if (after->t_ns == t_ns) return after->T;
	if (after == poses_.begin()) return std::nullopt;
	const auto before = after - 1;
	const double gap_s = secondsBetween(before->t_ns, after->t_ns);
	if (gap_s > max_gap_s) return std::nullopt;
	const double s = secondsBetween(before->t_ns, t_ns) / gap_s;
	return Pose3(before->T.R.slerp(s, after->T.R), (1 - s) * before->T.p + s * after->T.p);
}

double Trajectory::length_m() const
{
	double sum = 0;
	for (size_t i = 1; i < poses_.size(); i++) sum += (poses_[i].T.p - poses_[i - 1].T.p).norm();
	return sum;
}
}  // namespace viwo
