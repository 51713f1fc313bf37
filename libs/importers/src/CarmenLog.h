#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace viwo
{
/** x (m), y (m), yaw (rad) of O in the odometry's frame. */
using CarmenPose = Eigen::Vector3d;

/** One line with a scan. */
struct CarmenScan
{
	int64_t t_ns = 0;
	std::string stamp;                         //!< as written in the log, s
	std::string kind;                          //!< FLASER, RLASER or ROBOTLASER1
	double first_angle_rad = 0, step_rad = 0;  //!< in the laser's frame
	double max_range_m = 0;
	std::vector<float> ranges_m;  //!< counter-clockwise
	CarmenPose odometry;          //!< that of this very line
	CarmenPose T_OL;              //!< the laser on the robot
};

struct CarmenOdometry
{
	int64_t t_ns = 0;
	CarmenPose pose;
};

struct CarmenLog
{
	std::vector<CarmenScan> scans;              //!< in the order of the file
	std::vector<CarmenOdometry> odometry;       //!< ODOM lines, in the order of the file
	std::map<std::string, size_t> other_lines;  //!< kinds that were skipped
};

/** Reads a CARMEN log (robot navigation toolkit of Montemerlo, Roy and Thrun): FLASER, RLASER, ROBOTLASER1, ODOM, and of PARAM the lasers'
 *  offsets and largest range. plain, gzip or bzip2.
 *
 *  Beams of FLASER and RLASER: the first at -90 deg; 180 beams step 1 deg (the last at 89 deg), 360 beams 0.5 deg (89.5), 181 and 361 end
 * at 90 deg; any other number spans 180 deg.
 *  @throws Error naming file and line: words missing, no number, no stamp; no scan in the log; empty; OtherFormat without any line of
 *  such a log.
 */
CarmenLog readCarmenLog(const std::string& path);
}  // namespace viwo
