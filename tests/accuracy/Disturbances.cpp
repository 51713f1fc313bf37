#include "Groups.h"

#include "Drives.h"

namespace viwo::accuracy
{
namespace
{
struct Disturbance
{
	std::string name, folder;
	std::vector<std::string> overrides;
};

std::vector<Disturbance> disturbances()
{
	return {{"camera black for 5 s", "black", {"camera.black_from_s=20", "camera.black_to_s=25"}},
	        {"wheels silent for 5 s", "silent", {"wheels.silences=20 5"}},
	        {"IMU stamps jittered by 2 ms", "jitter", {"imu.stamp_jitter_ms=2"}},
	        {"exposure halved, later doubled", "exposure", {"camera.exposure_steps=20 0.5 50 1"}}};
}

double ate(const Score& s)
{
	return s.ate_m;
}

class Disturbances : public Group
{
   public:
	using Group::Group;
	std::vector<std::string> bars() const override;
	void plan(Runner& runner) const override;
	std::vector<Row> judge(const Runner& runner) const override;
};

std::vector<std::string> Disturbances::bars() const
{
	std::vector<std::string> names;
	for (const Disturbance& d : disturbances()) names.push_back(d.name + ": ATE over the clean run's");
	return names;
}

void Disturbances::plan(Runner& runner) const
{
	wantAll(runner, runsOf(corridorDrive(), settings_.seeds));
	for (const Disturbance& d : disturbances()) wantAll(runner, runsOf(corridorDrive().with(d.folder, d.overrides), settings_.seeds));
}

std::vector<Row> Disturbances::judge(const Runner& runner) const
{
	const std::vector<double> clean = each(scoresOf(runner, runsOf(corridorDrive(), settings_.seeds)), ate);
	std::vector<Row> rows;
	for (const Disturbance& d : disturbances())
	{
		const auto scores = scoresOf(runner, runsOf(corridorDrive().with(d.folder, d.overrides), settings_.seeds));
		const std::vector<double> disturbed = each(scores, ate);
		std::vector<double> ratios;
		for (size_t i = 0; i < clean.size(); ++i) ratios.push_back(disturbed[i] / clean[i]);
		rows.push_back(atMost(bars()[rows.size()], worst(ratios), 2, "",
		                      listOf("disturbed", disturbed, 100, "cm") + "; " + listOf("clean", clean, 100, "cm") + problemsOf(scores)));
	}
	return rows;
}
}  // namespace

std::unique_ptr<Group> disturbances(const Settings& settings)
{
	return std::make_unique<Disturbances>(settings);
}
}  // namespace viwo::accuracy
