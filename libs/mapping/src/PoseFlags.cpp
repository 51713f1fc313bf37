#include <viwo/core/CsvTable.h>
#include <viwo/core/Error.h>
#include <viwo/mapping/PoseFlags.h>

#include <algorithm>

namespace viwo
{
namespace
{
/** The first pose at or after t_ns. */
size_t indexFrom(int64_t t_ns, const Trajectory& trajectory)
{
	const auto& poses = trajectory.poses();
	const auto at = std::lower_bound(poses.begin(), poses.end(), t_ns, [](const StampedPose& pose, int64_t t) { return pose.t_ns < t; });
	return static_cast<size_t>(at - poses.begin());
}
}  // namespace

const std::vector<std::string>& knownPoseFlags()
{
	static const std::vector<std::string> words{"good", "degenerate", "odometry_only", "tracking", "from_wheels", "dead_reckoning"};
	return words;
}

PoseFlags PoseFlags::load(const std::string& csv_path, const Trajectory& trajectory, const std::vector<std::string>& bad)
{
	CsvTable table(csv_path, {"t_s", "flag"});
	PoseFlags flags;
	flags.bad_.assign(trajectory.size(), false);
	size_t matched = 0;
	while (table.next())
	{
		const int64_t t_ns = table.seconds_ns(0);
		const size_t i = indexFrom(t_ns, trajectory);
		if (i == trajectory.size() || trajectory.poses()[i].t_ns != t_ns) continue;
		++matched;
		flags.bad_[i] = std::find(bad.begin(), bad.end(), table.cell(1)) != bad.end();
	}
	if (matched == 0) throw Error(csv_path + ": no stamp is that of a pose; the flags belong to another trajectory");
	return flags;
}

bool PoseFlags::isBad(int64_t t_ns, const Trajectory& trajectory) const
{
	if (bad_.empty()) return false;
	const size_t i = indexFrom(t_ns, trajectory);
	if (i < bad_.size() && trajectory.poses()[i].t_ns == t_ns) return bad_[i];
	return (i < bad_.size() && bad_[i]) || (i > 0 && bad_[i - 1]);
}
}  // namespace viwo
