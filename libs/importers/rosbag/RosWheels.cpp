#include "RosWheels.h"

#include "RosInstance.h"

#include <sensor_msgs/JointState.h>
#include <viwo/core/Time.h>

#include <algorithm>
#include <sstream>

namespace viwo
{
namespace
{
/** Mean over the named joints; nothing where one of them is absent, or has no such value. */
std::optional<double> meanOf(const sensor_msgs::JointState& state, const std::vector<double>& values, const std::string& joints)
{
	std::istringstream words(joints);
	double sum = 0;
	int count = 0;
	for (std::string joint; words >> joint; ++count)
	{
		const auto at = static_cast<size_t>(std::find(state.name.begin(), state.name.end(), joint) - state.name.begin());
		if (at >= state.name.size() || at >= values.size()) return std::nullopt;
		sum += values[at];
	}
	return sum / count;
}

WheelTwist twistOf(double left_rad_s, double right_rad_s, const TopicMapping& mapping)
{
	const double v_left_m_s = mapping.wheel_radius_m * left_rad_s, v_right_m_s = mapping.wheel_radius_m * right_rad_s;
	return {0.5 * (v_left_m_s + v_right_m_s), (v_right_m_s - v_left_m_s) / mapping.track_m};
}
}  // namespace

std::optional<StampedTwist> RosWheels::push(const rosbag::MessageInstance& message, int64_t t_ns, const TopicMapping& mapping)
{
	const auto state = instance<sensor_msgs::JointState>(message);
	const auto left = meanOf(*state, state->position, mapping.left_joints), right = meanOf(*state, state->position, mapping.right_joints);
	if (!left || !right)
	{
		const auto v_left = meanOf(*state, state->velocity, mapping.left_joints),
		           v_right = meanOf(*state, state->velocity, mapping.right_joints);
		if (!v_left || !v_right) return std::nullopt;
		return StampedTwist{t_ns, twistOf(*v_left, *v_right, mapping)};
	}
	const Angles now{t_ns, *left, *right};
	const std::optional<Angles> before = last_;
	// Out of order: the angles of a later time are kept.
	if (before && t_ns <= before->t_ns) return std::nullopt;
	last_ = now;
	if (!before) return std::nullopt;
	const double dt_s = secondsBetween(before->t_ns, t_ns);
	return StampedTwist{t_ns, twistOf((*left - before->left_rad) / dt_s, (*right - before->right_rad) / dt_s, mapping)};
}
}  // namespace viwo
