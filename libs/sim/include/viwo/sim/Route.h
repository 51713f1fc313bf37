#pragma once

#include <viwo/core/Options.h>

#include <string>
#include <vector>

namespace viwo::sim
{
/** One leg of a route. */
struct RouteSegment
{
	enum class Kind
	{
		straight,  //!< length_m
		rotate,    //!< on the spot by angle_rad, positive to the left
		arc,       //!< radius_m > 0, angle_rad, positive to the left
		stand,     //!< duration_s
		free       //!< duration_s of the route's sums of sines
	};
	Kind kind = Kind::stand;
	double length_m = 0;
	double radius_m = 0;
	double angle_rad = 0;
	double duration_s = 0;
};

/** What the robot is told to drive; the section [route] of a route file. */
struct Route : Options<Route>
{
	double start_x_m = 0, start_y_m = 0, start_yaw_deg = 0;
	double speed_m_s = 0.15;
	double yaw_rate_rad_s = 0.15;
	double acceleration_m_s2 = 0.2;
	double yaw_acceleration_rad_s2 = 0.4;
	bool initial_speed = false;
	bool final_stop = true;
	double duration_s = 0;
	std::string segments = "stand 5 s";
	std::vector<double> free_speed_amplitudes = {0.3, 0.15};
	std::vector<double> free_speed_periods_s = {13.0, 7.3};
	std::vector<double> free_yaw_rate_amplitudes_rad_s = {0.12, 0.07, 0.04};
	std::vector<double> free_yaw_rate_periods_s = {23.0, 11.0, 6.1};
	double free_yaw_rate_mean_rad_s = 0;

	template <class Visitor>
	void visit(Visitor& v)
	{
		v("start_x_m", start_x_m, "where the route starts in the world");
		v("start_y_m", start_y_m, "");
		v("start_yaw_deg", start_yaw_deg, "heading at the start");
		v("speed_m_s", speed_m_s, "speed on straights, arcs and (mean) in free motion", 1e-3, 5.0);
		v("yaw_rate_rad_s", yaw_rate_rad_s, "yaw rate of rotations; tight arcs are driven no faster than this", 1e-3, 5.0);
		v("acceleration_m_s2", acceleration_m_s2, "largest acceleration along the path", 1e-3, 10.0);
		v("yaw_acceleration_rad_s2", yaw_acceleration_rad_s2, "largest yaw acceleration", 1e-3, 20.0);
		v("initial_speed", initial_speed, "the log begins in mid-motion: the first segment has its full speed from the first sample on");
		v("final_stop", final_stop, "the last segment ends at rest; false: the log ends in mid-motion");
		v("duration_s", duration_s, "the log is cut at this time; 0: at the end of the last segment", 0.0, 86400.0);
		v("segments", segments,
		  "comma-separated: straight L m | rotate A deg | arc RADIUS m A deg | stand T s | free T s; angles positive to the left; 'N x "
		  "(...)' repeats");
		v("free_speed_amplitudes", free_speed_amplitudes, "free motion: speed = speed_m_s (1 + sum of A sin(2 pi t / period))");
		v("free_speed_periods_s", free_speed_periods_s, "one for each amplitude");
		v("free_yaw_rate_mean_rad_s", free_yaw_rate_mean_rad_s, "free motion: yaw rate = mean + sum of A sin(2 pi t / period)", -5.0, 5.0);
		v("free_yaw_rate_amplitudes_rad_s", free_yaw_rate_amplitudes_rad_s, "");
		v("free_yaw_rate_periods_s", free_yaw_rate_periods_s, "one for each amplitude");
	}

	/** The parsed `segments`. @throws Error that quotes the entry that cannot be read. */
	std::vector<RouteSegment> parsedSegments() const;
};
}  // namespace viwo::sim
