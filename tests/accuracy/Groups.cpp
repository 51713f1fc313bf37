#include "Groups.h"

namespace viwo::accuracy
{
std::vector<std::unique_ptr<Group>> allGroups(const Settings& settings)
{
	std::vector<std::unique_ptr<Group>> groups;
	for (const auto make : {starts, corridor, lobby, handHeld, slip, disturbances, standing, ablation, robots, calibration,
	                        onlineCalibration, real, consistencyOfCovariance, determinism, speedAndMemory})
		groups.push_back(make(settings));
	return groups;
}
}  // namespace viwo::accuracy
