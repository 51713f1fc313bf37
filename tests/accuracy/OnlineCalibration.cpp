#include "CalibrationDrive.h"
#include "Drives.h"
#include "Groups.h"

namespace viwo::accuracy
{
namespace
{
using Words = std::vector<std::string>;

/** On top of wheels and T_BC, which are estimated in any case. */
Words allSwitches()
{
	return {"factors.estimate_T_BO=true", "factors.estimate_camera_time_offset=true", "factors.estimate_wheel_time_offset=true"};
}

class OnlineCalibration : public Group
{
   public:
	using Group::Group;
	std::vector<std::string> bars() const override;
	void plan(Runner& runner) const override;
	std::vector<Row> judge(const Runner& runner) const override;

   private:
	std::vector<RunRecipe> runs(bool wrong_start, bool calibrating) const;
	/** ATE with all switches over that with none, the worst of the seeds. */
	Row ratio(const Runner& runner, bool wrong_start, const std::string& bar, double limit) const;
};

std::vector<std::string> OnlineCalibration::bars() const
{
	return {"online calibration of a wrong rig: worst ATE over that without its switches",
	        "online calibration of the right rig: worst ATE over that without its switches"};
}

std::vector<RunRecipe> OnlineCalibration::runs(bool wrong_start, bool calibrating) const
{
	const SimulatedDrive drive = calibrationDrive();
	const std::string start = wrong_start ? "wrong" : "right";
	std::vector<RunRecipe> runs =
	    runsOf(drive, settings_.seeds, "viwo", start + (calibrating ? "-online" : "-off"), calibrating ? allSwitches() : Words());
	for (size_t i = 0; i < runs.size(); ++i)
	{
		const SensorRig truth = trueRig(drive, i + 1);
		runs[i].rig = saveRig(settings_, drive, wrong_start ? wrongRig(truth, i + 1) : truth, runs[i].log.name + "-" + start);
	}
	return runs;
}

void OnlineCalibration::plan(Runner& runner) const
{
	for (const bool wrong_start : {true, false})
		for (const bool calibrating : {true, false}) wantAll(runner, runs(wrong_start, calibrating));
}

Row OnlineCalibration::ratio(const Runner& runner, bool wrong_start, const std::string& bar, double limit) const
{
	const std::vector<Score> with = scoresOf(runner, runs(wrong_start, true)), without = scoresOf(runner, runs(wrong_start, false), 0);
	std::vector<double> ratios, with_m, without_m;
	for (size_t i = 0; i < with.size(); ++i)
	{
		with_m.push_back(with[i].ate_m);
		without_m.push_back(without[i].ate_m);
		ratios.push_back(with_m.back() / without_m.back());
	}
	return atMost(bar, worst(ratios), limit, "",
	              listOf("with", with_m, 100, "cm, ") + listOf("without", without_m, 100, "cm") + problemsOf(with) + problemsOf(without));
}

std::vector<Row> OnlineCalibration::judge(const Runner& runner) const
{
	return {ratio(runner, true, bars()[0], 0.5), ratio(runner, false, bars()[1], 1.2)};
}
}  // namespace

std::unique_ptr<Group> onlineCalibration(const Settings& settings)
{
	return std::make_unique<OnlineCalibration>(settings);
}
}  // namespace viwo::accuracy
