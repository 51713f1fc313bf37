#include "RosWheels.h"

#include "RosInstance.h"

#include <sensor_msgs/JointState.h>
#include <viwo/core/Joined.h>
#include <viwo/core/Time.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <sstream>
#include <utility>

namespace viwo
{
namespace
{
std::vector<std::string> wordsOf(const std::string& text)
{
	std::istringstream words(text);
	return {std::istream_iterator<std::string>(words), {}};
}

/** Mean over the named joints; nothing where one of them is absent, or has no such value. */
std::optional<double> meanOf(const sensor_msgs::JointState& state, const std::vector<double>& values, const std::string& joints)
{
	double sum = 0;
	const std::vector<std::string> names = wordsOf(joints);
	for (const std::string& joint : names)
	{
		const auto at = static_cast<size_t>(std::find(state.name.begin(), state.name.end(), joint) - state.name.begin());
		if (at >= state.name.size() || at >= values.size() || !std::isfinite(values[at])) return std::nullopt;
		sum += values[at];
	}
	return sum / static_cast<double>(names.size());
}

/** Of the left and the right wheels. */
struct Sides
{
	double left, right;
};

std::optional<Sides> sidesOf(const sensor_msgs::JointState& state, const std::vector<double>& values, const TopicMapping& mapping)
{
	const auto left = meanOf(state, values, mapping.left_joints), right = meanOf(state, values, mapping.right_joints);
	if (!left || !right) return std::nullopt;
	return Sides{*left, *right};
}

WheelTwist twistOf(double left_rad_s, double right_rad_s, const TopicMapping& mapping)
{
	const double v_left_m_s = mapping.wheel_radius_m * left_rad_s, v_right_m_s = mapping.wheel_radius_m * right_rad_s;
	return {0.5 * (v_left_m_s + v_right_m_s), (v_right_m_s - v_left_m_s) / mapping.track_m};
}
}  // namespace

void requireWheels(const RosBagFile& bag, const TopicMapping& mapping)
{
	std::set<std::string> there;
	bool found = false;
	bag.visit({mapping.topic},
	          [&](const rosbag::MessageInstance& message)
	          {
		          const auto state = instance<sensor_msgs::JointState>(message);
		          there.insert(state->name.begin(), state->name.end());
		          found = sidesOf(*state, state->position, mapping) || sidesOf(*state, state->velocity, mapping);
		          return !found;
	          });
	if (found) return;
	for (const auto& [key, joints] : {std::pair("left_joints", mapping.left_joints), std::pair("right_joints", mapping.right_joints)})
		for (const std::string& joint : wordsOf(joints))
			if (there.count(joint) == 0)
				throw Error(bag.name() + ": [" + mapping.label + "] " + key + " = " + joints + ": " + mapping.topic + " has no joint " +
				            joint + "; it has: " + (there.empty() ? "none" : joined(there)));
	throw Error(bag.name() + ": [" + mapping.label + "]: no message of " + mapping.topic +
	            " has positions or velocities of all left_joints and right_joints; leave it out by a --map");
}

std::optional<StampedTwist> RosWheels::push(const rosbag::MessageInstance& message, int64_t t_ns, const TopicMapping& mapping)
{
	const auto state = instance<sensor_msgs::JointState>(message);
	const auto angles_rad = sidesOf(*state, state->position, mapping);
	if (!angles_rad)
	{
		const auto rates_rad_s = sidesOf(*state, state->velocity, mapping);
		if (!rates_rad_s) return std::nullopt;
		return StampedTwist{t_ns, twistOf(rates_rad_s->left, rates_rad_s->right, mapping)};
	}
	const Angles now{t_ns, angles_rad->left, angles_rad->right};
	const std::optional<Angles> before = last_;
	// Out of order: the angles of a later time are kept.
	if (before && t_ns <= before->t_ns) return std::nullopt;
	last_ = now;
	if (!before) return std::nullopt;
	const double dt_s = secondsBetween(before->t_ns, t_ns);
	return StampedTwist{t_ns, twistOf((now.left_rad - before->left_rad) / dt_s, (now.right_rad - before->right_rad) / dt_s, mapping)};
}
}  // namespace viwo
