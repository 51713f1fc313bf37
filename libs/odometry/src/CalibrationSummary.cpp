#include "CalibrationSummary.h"

#include <viwo/core/Scalars.h>

#include <optional>

namespace viwo
{
namespace
{
using Json = nlohmann::ordered_json;

Json vectorJson(const Eigen::Vector3d& v)
{
	return {v.x(), v.y(), v.z()};
}

Json poseJson(const Pose3& T)
{
	return {{"p_m", vectorJson(T.p)}, {"q_xyzw", {T.R.x(), T.R.y(), T.R.z(), T.R.w()}}};
}

/** "held": switched on, but the motion has not shown enough of it. */
const char* stateOf(bool is_estimated, bool started)
{
	return !is_estimated ? "given" : started ? "estimated" : "held";
}

Json offsetJson(double given_s, double estimated_s, const std::optional<double>& deviation_s, bool started)
{
	Json j{{"offset_s", given_s + estimated_s}, {"state", stateOf(deviation_s.has_value(), started)}};
	if (deviation_s) j["deviation_s"] = *deviation_s;
	return j;
}

Json mountingJson(const Pose3& T_BO, const CalibrationDeviations& d)
{
	Json j = poseJson(T_BO);
	// A metre shows the yaw, a quarter turn the rest.
	const bool yaw_alone = d.T_BO.has_value() && d.yaw_started && !d.lever_arm_started;
	j["state"] = yaw_alone ? "yaw estimated" : stateOf(d.T_BO.has_value(), d.lever_arm_started && d.yaw_started);
	if (!d.T_BO) return j;
	// Along O's axes. The height of the IMU over the floor has no influence on planar motion.
	j["deviation"] = {{"p_in_O_m", {(*d.T_BO)[0], (*d.T_BO)[1], nullptr}}, {"rotation_in_O_rad", vectorJson(d.T_BO->tail<3>())}};
	j["not_observed"] = "z of O";
	return j;
}
}  // namespace

Json calibrationJson(const Odometry& odometry, const OdometryOptions& options)
{
	const CalibrationEstimate c = odometry.calibrationEstimate();
	const CalibrationDeviations d = odometry.calibrationDeviations();
	Json j{{"T_BC", poseJson(c.T_BC)},
	       {"wheels", {{"k_left", c.wheels.k_left}, {"k_right", c.wheels.k_right}, {"track_m", c.wheels.track_m}}}};
	if (d.T_BC) j["T_BC"]["deviation"] = {{"p_m", vectorJson(d.T_BC->head<3>())}, {"rotation_rad", vectorJson(d.T_BC->tail<3>())}};
	if (d.wheels) j["wheels"]["deviation"] = {{"k_left", d.wheels->x()}, {"k_right", d.wheels->y()}, {"track_m", d.wheels->z()}};
	j["T_BO"] = mountingJson(c.T_BO, d);
	j["camera_clock"] =
	    offsetJson(options.rawlog.camera_time_offset_s, c.camera_time_offset_s, d.camera_time_offset_s, d.camera_offset_started);
	j["wheel_clock"] = offsetJson(options.rawlog.wheel_time_offset_s, c.wheel_time_offset_s, d.wheel_time_offset_s, d.wheel_offset_started);
	j["floor"] = {{"tilt_x_rad", c.plane_tilt_x_rad}, {"tilt_y_rad", c.plane_tilt_y_rad}, {"height_m", c.plane_height_m}};
	return j;
}
}  // namespace viwo
