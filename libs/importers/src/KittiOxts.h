#pragma once

#include <viwo/core/ImuSample.h>
#include <viwo/core/Pose3.h>
#include <viwo/core/WheelSample.h>

#include <cstdint>
#include <string>
#include <vector>

namespace viwo
{
/** One packet of the inertial and GPS unit; I is its frame: x forward, y left, z up. */
struct OxtsPacket
{
	int64_t t_ns = 0;
	double latitude_deg = 0, longitude_deg = 0, altitude_m = 0;
	double roll_rad = 0, pitch_rad = 0, yaw_rad = 0;  //!< yaw 0 looks east, counter-clockwise
	WheelTwist twist;                                 //!< vf and wz at the stamp
	ImuSample imu;
};

/** Frames of a KITTI sensor: line i of timestamps.txt belongs to file i. */
struct KittiFrame
{
	int64_t t_ns = 0;
	std::string path;
};

/** The frames of a sensor's folder (timestamps.txt, data/%010d.extension) whose file exists.
 *  @param missing receives the count of the others.
 *  @throws Error: no timestamps.txt, a malformed or not increasing stamp (among the files that exist), no file at all.
 */
std::vector<KittiFrame> readKittiFrames(const std::string& folder, const std::string& extension, size_t& missing);

/** @throws Error naming the file: fewer than 23 numbers, not a number. */
OxtsPacket readOxtsPacket(const KittiFrame& frame);

/** Pose of I in an east-north-up frame at the first packet's position, after KITTI's development kit (Mercator projection scaled at the
 * first latitude). */
Pose3 poseOf(const OxtsPacket& packet, const OxtsPacket& first);

/** "2011-09-26 14:05:35.550923000" as UTC. @throws Error beginning with `where`. */
int64_t parseDateTime(const std::string& text, const std::string& where);
}  // namespace viwo
