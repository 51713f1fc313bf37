#pragma once

#include <viwo/core/Pose3.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace viwo
{
/** Sum of the intervals between increasing stamps, holes left out: those longer than max_gap_s and than three usual intervals, s. */
double coveredDuration_s(const std::vector<int64_t>& stamps_ns, double max_gap_s);
/** A pose and its time. */
struct StampedPose
{
	int64_t t_ns = 0;
	Pose3 T;
};

/** Poses in increasing order of time. Text format TUM: `t x y z qx qy qz qw`, t in Unix seconds with 9 decimals. */
class Trajectory
{
   public:
	/** Reads a TUM file: '#' lines and blank lines skipped, quaternions within 1 % of unit norm normalised.
	 *  @throws Error naming file and line: unreadable, not eight numbers, NaN, zero quaternion, stamps not increasing, no pose at all.
	 */
	static Trajectory loadTum(const std::string& path);

	/** Written to a temporary name and renamed. @throws Error when the file cannot be written. */
	void saveTum(const std::string& path) const;

	/** Appends; t_ns must be later than the last. */
	void push_back(const StampedPose& pose);

	/** Pose at t_ns: positions linearly, rotations by slerp; nothing outside of the span or inside a gap longer than max_gap_s. */
	std::optional<Pose3> at(int64_t t_ns, double max_gap_s) const;

	/** Length of the polyline through the positions, m. */
	double length_m() const;

	const std::vector<StampedPose>& poses() const { return poses_; }
	bool empty() const { return poses_.empty(); }
	size_t size() const { return poses_.size(); }

   private:
	std::vector<StampedPose> poses_;
};
}  // namespace viwo
