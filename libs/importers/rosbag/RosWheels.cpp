#include "RosWheels.h"

#include "RosInstance.h"

#include <sensor_msgs/JointState.h>
#include <viwo/core/Joined.h>
#include <viwo/core/NumberText.h>
#include <viwo/core/Ranking.h>
#include <viwo/core/Time.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <set>
#include <utility>

namespace viwo
{
namespace
{
/** A step is no wheel's when it is this many times those around it, and more than these. */
constexpr double kJumpFactor = 3, kJumpTravel_m = 0.1, kJumpSpeed_m_s = 3;
/** Of angles within one turn: drivers round them. */
constexpr double kRounding_rad = 0.01;
/** Steps on either side that it is compared with: two that jump, to a wrong value and back, do not outvote the others. */
constexpr size_t kNeighbours = 3;

/** Of all these joints; nothing where one of them is absent, or has no such value. */
std::optional<std::vector<double>> valuesOf(const sensor_msgs::JointState& state, const std::vector<double>& values,
                                            const std::vector<std::string>& joints)
{
	std::vector<double> found;
	for (const std::string& joint : joints)
	{
		const auto at = static_cast<size_t>(std::find(state.name.begin(), state.name.end(), joint) - state.name.begin());
		if (at >= state.name.size() || at >= values.size() || !std::isfinite(values[at])) return std::nullopt;
		found.push_back(values[at]);
	}
	return found;
}

WheelTwist twistOf(const std::vector<double>& rates_rad_s, size_t left_joints, const TopicMapping& mapping)
{
	const auto middle = rates_rad_s.begin() + static_cast<std::ptrdiff_t>(left_joints);
	const auto speed_m_s = [&](auto begin, auto end)
	{ return mapping.wheel_radius_m * std::accumulate(begin, end, 0.0) / static_cast<double>(end - begin); };
	const double left_m_s = speed_m_s(rates_rad_s.begin(), middle), right_m_s = speed_m_s(middle, rates_rad_s.end());
	return {0.5 * (left_m_s + right_m_s), (right_m_s - left_m_s) / mapping.track_m};
}

[[noreturn]] void refuse(const RosBagFile& bag, const TopicMapping& mapping, const std::set<std::string>& there)
{
	for (const auto& [key, joints] : {std::pair("left_joints", mapping.left_joints), std::pair("right_joints", mapping.right_joints)})
		for (const std::string& joint : jointsOf(joints))
			if (there.count(joint) == 0)
				throw Error(bag.name() + ": [" + mapping.label + "] " + key + " = " + joints + ": " + mapping.topic + " has no joint " +
				            joint + "; it has: " + (there.empty() ? "none" : joined(there)));
	throw Error(bag.name() + ": [" + mapping.label + "]: no message of " + mapping.topic +
	            " has positions or velocities of all left_joints and right_joints; leave it out by a --map");
}

/** How far a joint turned from one reading to the next, and how fast. */
struct Step
{
	double travel_m, speed_m_s;
};

bool isJump(const std::vector<Step>& steps, size_t at)
{
	std::vector<double> travels_m, speeds_m_s;
	const size_t begin = at - std::min(at, kNeighbours), end = std::min(steps.size(), at + kNeighbours + 1);
	for (size_t i = begin; i < end; ++i)
	{
		if (i == at) continue;
		travels_m.push_back(steps[i].travel_m), speeds_m_s.push_back(steps[i].speed_m_s);
	}
	if (travels_m.empty()) return false;
	return steps[at].travel_m > kJumpFactor * upperMedian(travels_m) + kJumpTravel_m &&
	       steps[at].speed_m_s > kJumpFactor * upperMedian(speeds_m_s) + kJumpSpeed_m_s;
}
}  // namespace

RosWheels::RosWheels(const RosBagFile& bag, const TopicMapping& mapping, bool record_time)
{
	read(bag, mapping, record_time);
	sortByStamp(angles_rad_);
	sortByStamp(rates_rad_s_);
	unwrapTurns();
	addSamples(mapping);
	angles_rad_.clear(), rates_rad_s_.clear();
}

void RosWheels::read(const RosBagFile& bag, const TopicMapping& mapping, bool record_time)
{
	std::vector<std::string> joints = jointsOf(mapping.left_joints);
	left_joints_ = joints.size();
	for (const std::string& joint : jointsOf(mapping.right_joints)) joints.push_back(joint);
	std::set<std::string> there;
	bag.visit({mapping.topic},
	          [&](const rosbag::MessageInstance& message)
	          {
		          const auto state = instance<sensor_msgs::JointState>(message);
		          there.insert(state->name.begin(), state->name.end());
		          const int64_t t_ns = stampOf(readHeader(message), record_time);
		          if (auto angles_rad = valuesOf(*state, state->position, joints))
			          angles_rad_.push_back({t_ns, std::move(*angles_rad)});
		          else if (auto rates_rad_s = valuesOf(*state, state->velocity, joints))
			          rates_rad_s_.push_back({t_ns, std::move(*rates_rad_s)});
		          return true;
	          });
	if (angles_rad_.empty() && rates_rad_s_.empty()) refuse(bag, mapping, there);
}

void RosWheels::sortByStamp(std::vector<Reading>& readings)
{
	std::stable_sort(readings.begin(), readings.end(), [](const Reading& a, const Reading& b) { return a.t_ns < b.t_ns; });
	const auto end = std::unique(readings.begin(), readings.end(), [](const Reading& a, const Reading& b) { return a.t_ns == b.t_ns; });
	same_stamp_ += static_cast<size_t>(readings.end() - end);
	readings.erase(end, readings.end());
}

void RosWheels::unwrapTurns()
{
	if (angles_rad_.empty()) return;
	for (size_t joint = 0; joint < angles_rad_.front().values.size(); ++joint)
	{
		const auto [low, high] =
		    std::minmax_element(angles_rad_.begin(), angles_rad_.end(),
		                        [joint](const Reading& a, const Reading& b) { return a.values[joint] < b.values[joint]; });
		if (high->values[joint] - low->values[joint] > 2 * M_PI + kRounding_rad) continue;
		double turned_rad = 0;
		for (size_t i = 1; i < angles_rad_.size(); ++i)
		{
			double& angle_rad = angles_rad_[i].values[joint];
			const double step_rad = angle_rad + turned_rad - angles_rad_[i - 1].values[joint];
			if (std::abs(step_rad) > M_PI)
			{
				turned_rad -= std::copysign(2 * M_PI, step_rad);
				++unwrapped_;
			}
			angle_rad += turned_rad;
		}
	}
}

std::vector<bool> RosWheels::findJumps(double wheel_radius_m) const
{
	std::vector<bool> jumps(angles_rad_.size());
	if (angles_rad_.empty()) return jumps;
	for (size_t joint = 0; joint < angles_rad_.front().values.size(); ++joint)
	{
		std::vector<Step> steps;
		for (size_t i = 1; i < angles_rad_.size(); ++i)
		{
			const double travel_m = wheel_radius_m * std::abs(angles_rad_[i].values[joint] - angles_rad_[i - 1].values[joint]);
			steps.push_back({travel_m, travel_m / secondsBetween(angles_rad_[i - 1].t_ns, angles_rad_[i].t_ns)});
		}
		for (size_t i = 0; i < steps.size(); ++i)
			if (isJump(steps, i)) jumps[i + 1] = true;
	}
	return jumps;
}

void RosWheels::addSamples(const TopicMapping& mapping)
{
	const std::vector<bool> jumps = findJumps(mapping.wheel_radius_m);
	jumps_ = static_cast<size_t>(std::count(jumps.begin(), jumps.end(), true));
	for (size_t i = 1; i < angles_rad_.size(); ++i)
	{
		if (jumps[i]) continue;
		const Reading &before = angles_rad_[i - 1], &now = angles_rad_[i];
		std::vector<double> rates_rad_s(now.values.size());
		for (size_t joint = 0; joint < rates_rad_s.size(); ++joint)
			rates_rad_s[joint] = (now.values[joint] - before.values[joint]) / secondsBetween(before.t_ns, now.t_ns);
		samples_.push_back({now.t_ns, twistOf(rates_rad_s, left_joints_, mapping)});
	}
	for (const Reading& reading : rates_rad_s_) samples_.push_back({reading.t_ns, twistOf(reading.values, left_joints_, mapping)});
	std::stable_sort(samples_.begin(), samples_.end(), [](const StampedTwist& a, const StampedTwist& b) { return a.t_ns < b.t_ns; });
}

std::optional<WheelTwist> RosWheels::at(int64_t t_ns) const
{
	const auto sample =
	    std::lower_bound(samples_.begin(), samples_.end(), t_ns, [](const StampedTwist& s, int64_t t) { return s.t_ns < t; });
	if (sample == samples_.end() || sample->t_ns != t_ns) return std::nullopt;
	return sample->twist;
}

std::vector<std::string> RosWheels::notes() const
{
	std::vector<std::string> notes;
	if (same_stamp_ > 0) notes.push_back("left out: " + counted(same_stamp_, "message") + " with the stamp of another one");
	if (unwrapped_ > 0) notes.push_back("angles that stay within one turn: " + counted(unwrapped_, "jump") + " of a whole turn taken off");
	if (jumps_ > 0)
		notes.push_back("left out: " + counted(jumps_, "sample") + " for which a wheel would have jumped (a counter set anew?)");
	return notes;
}
}  // namespace viwo
