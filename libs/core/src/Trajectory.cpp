#include <viwo/core/AtomicFile.h>
#include <viwo/core/Error.h>
#include <viwo/core/Time.h>
#include <viwo/core/TimeText.h>
#include <viwo/core/Trajectory.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

namespace viwo
{
namespace
{
[[noreturn]] void failAt(const std::string& path, int line_number, const std::string& what)
{
	throw Error(path + ":" + std::to_string(line_number) + ": " + what);
}

double parseField(const std::string& word, const std::string& path, int line_number)
{
	const char* begin = word.data() + (word[0] == '+' ? 1 : 0);
	const char* end = word.data() + word.size();
	double value = 0;
	const auto result = std::from_chars(begin, end, value);
	if (result.ec != std::errc() || result.ptr != end || !std::isfinite(value))
		failAt(path, line_number, "'" + word + "' is not a finite number");
	return value;
}

StampedPose parseLine(const std::string& line, const std::string& path, int line_number)
{
	std::istringstream stream(line);
	std::vector<std::string> words;
	for (std::string word; stream >> word;) words.push_back(word);
	if (words.size() != 8)
		failAt(path, line_number,
		       std::to_string(words.size()) + " columns; a TUM trajectory has the eight: t x y z qx qy qz qw, with spaces between");
	const auto t_ns = parseSeconds(words[0]);
	if (!t_ns) failAt(path, line_number, "'" + words[0] + "' is not a time in seconds");
	double v[7];
	for (size_t i = 0; i < 7; i++) v[i] = parseField(words[i + 1], path, line_number);
	const Eigen::Quaterniond q(v[6], v[3], v[4], v[5]);
	if (std::abs(q.norm() - 1) > 0.01) failAt(path, line_number, "the quaternion (columns 5 to 8) has not unit length");
	return {*t_ns, Pose3(q.normalized(), Eigen::Vector3d(v[0], v[1], v[2]))};
}
}  // namespace

double coveredDuration_s(const std::vector<int64_t>& stamps_ns, double max_gap_s)
{
	std::vector<double> intervals_s;
	for (size_t i = 1; i < stamps_ns.size(); ++i) intervals_s.push_back(secondsBetween(stamps_ns[i - 1], stamps_ns[i]));
	if (intervals_s.empty()) return 0;
	std::vector<double> sorted = intervals_s;
	std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), sorted.end());
	const double limit_s = std::max(max_gap_s, 3 * sorted[sorted.size() / 2]);
	double sum_s = 0;
	for (const double interval_s : intervals_s)
		if (interval_s <= limit_s) sum_s += interval_s;
	return sum_s;
}

Trajectory Trajectory::loadTum(const std::string& path)
{
	std::ifstream file(path);
	if (!file || file.peek() == std::ifstream::traits_type::eof())
		throw Error(path + ": cannot read this trajectory, or it is empty; check its name");
	Trajectory trajectory;
	int line_number = 0;
	for (std::string line; std::getline(file, line);)
	{
		line_number++;
		const size_t begin = line.find_first_not_of(" \t\r");
		if (begin == std::string::npos || line[begin] == '#') continue;
		const StampedPose pose = parseLine(line, path, line_number);
		if (!trajectory.empty() && pose.t_ns <= trajectory.poses_.back().t_ns)
			failAt(path, line_number, "stamp not later than that of the pose before; sort the file by time and remove doubles");
		trajectory.poses_.push_back(pose);
	}
	if (trajectory.empty()) throw Error(path + ": no pose in this trajectory");
	return trajectory;
}

void Trajectory::saveTum(const std::string& path) const
{
	AtomicFile file(path);
	for (const auto& pose : poses_)
	{
		const auto& p = pose.T.p;
		const auto& q = pose.T.R;
		char text[256];
		std::snprintf(text, sizeof text, " %.9f %.9f %.9f %.12f %.12f %.12f %.12f\n", p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
		file.stream() << formatSeconds(pose.t_ns) << text;
	}
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
