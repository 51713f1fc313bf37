#include "Groups.h"

#include "Drives.h"

namespace viwo::accuracy
{
namespace
{
/** A walk through the lobby with a camera that sways by some centimetres and degrees: what a visual-inertial odometry is made for. The
 *  mode vio of the tables must be an honest opponent.
 */
SimulatedDrive handHeldDrive()
{
	return {"hand-held",
	        "lobby",
	        "lobby_free",
	        {"lidar.enabled=false", "vibration.acceleration_m_s2=1", "vibration.rate_deg_s=20", "vibration.frequency_min_hz=0.5",
	         "vibration.frequency_max_hz=1.2"}};
}

class HandHeld : public Group
{
   public:
	using Group::Group;
	std::vector<std::string> bars() const override { return {"hand-held camera and IMU: worst ATE of vio"}; }
	void plan(Runner& runner) const override { wantAll(runner, runsOf(handHeldDrive(), settings_.seeds, "vio")); }
	std::vector<Row> judge(const Runner& runner) const override
	{
		const std::vector<Score> scores = scoresOf(runner, runsOf(handHeldDrive(), settings_.seeds, "vio"), 0.95);
		const std::vector<double> percent = each(scores, [](const Score& s) { return s.percent(); });
		return {atMost(bars()[0], worst(percent), 1, "%",
		               listOf("vio", each(scores, [](const Score& s) { return s.ate_m; }), 100, "cm") + problemsOf(scores) + " of " +
		                   std::to_string(scores.front().length_m).substr(0, 4) + " m and more")};
	}
};
}  // namespace

std::unique_ptr<Group> handHeld(const Settings& settings)
{
	return std::make_unique<HandHeld>(settings);
}
}  // namespace viwo::accuracy
