#pragma once

#include <viwo/sim/ImuModel.h>
#include <viwo/sim/Motion.h>
#include <viwo/sim/WheelModel.h>

#include <iostream>
#include <string>

namespace viwo::sim
{
inline Route routeOf(const std::string& segments, bool initial_speed = false, bool final_stop = true)
{
	Route route;
	route.start_x_m = 1;
	route.start_y_m = -2;
	route.start_yaw_deg = 30;
	route.segments = segments;
	route.initial_speed = initial_speed;
	route.final_stop = final_stop;
	return route;
}

/** Every kind of segment, about 60 s. */
inline Route variedRoute()
{
	return routeOf("straight 1 m, arc 0.8 m 90 deg, straight 0.5 m, rotate -60 deg, stand 1 s, free 25 s");
}

inline void measured(const std::string& what, double value, const std::string& unit)
{
	std::cout << "[measured] " << what << ": " << value << " " << unit << "\n";
}
}  // namespace viwo::sim
