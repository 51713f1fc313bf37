#pragma once

#include "FrontEnd.h"
#include "PoseGraph.h"

namespace viwo::gt
{
/** The key scans with their present poses: what the graph moves. */
struct KeyScans
{
	std::vector<size_t> scan;   //!< index of each in the session
	std::vector<Cloud> clouds;  //!< in O
	std::vector<Pose2> poses;   //!< O in the map
	std::vector<double> way_m;  //!< along the path, from the first

	size_t size() const { return scan.size(); }
};

KeyScans keyScansOf(FrontEndResult& front_end);

/** Edges between neighbours in time: registration, and odometry where there is any. */
std::vector<GraphEdge> chainEdges(const KeyScans& keys, const FrontEndResult& front_end, const MotionModel& motion,
                                  const GraphOptions& options);

/** From key to key by the gyroscope; empty where there is none whose bias is known. */
GyroTurns gyroTurns(const KeyScans& keys, const Session& session, const MotionModel& motion, const MotionNoiseOptions& options);

/** An edge of odometry from key a to key a + 1; nothing where it is not known. @param flag of the registration of a + 1. */
std::optional<GraphEdge> odometryEdge(const KeyScans& keys, size_t a, double trust, const MotionModel& motion, const GraphOptions& options);
}  // namespace viwo::gt
