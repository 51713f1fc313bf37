#include "Ablation.h"
#include "ConsistencyOfCovariance.h"
#include "Corridor.h"
#include "Determinism.h"
#include "Disturbances.h"
#include "Group.h"
#include "Lobby.h"
#include "Real.h"
#include "Slip.h"
#include "SpeedAndMemory.h"
#include "Standing.h"
#include "Starts.h"

namespace viwo::accuracy
{
namespace
{
template <class... Kinds>
std::vector<std::unique_ptr<Group>> make(const Settings& settings)
{
	std::vector<std::unique_ptr<Group>> groups;
	(groups.push_back(std::make_unique<Kinds>(settings)), ...);
	return groups;
}
}  // namespace

std::vector<std::unique_ptr<Group>> allGroups(const Settings& settings)
{
	return make<Starts, Corridor, Lobby, Slip, Disturbances, Standing, Ablation, Real, ConsistencyOfCovariance, Determinism,
	            SpeedAndMemory>(settings);
}
}  // namespace viwo::accuracy
