#include <viwo/core/Scalars.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "CalibrationDrive.h"
#include "Drives.h"
#include "Groups.h"

namespace viwo::accuracy
{
namespace
{
/** One bar on errors of the same kind. */
struct Kind
{
	const char *what, *unit;
	double factor, limit;
	std::function<double(const RigVector& error)> figure;
};

/** Those heights, and nothing else, are hidden from a drive on a floor. */
bool hidden(int parameter)
{
	return parameter == RigOrder::imu_lever + 2 || parameter == RigOrder::camera_lever + 2;
}

/** The largest of two vectors of three. */
std::function<double(const RigVector&)> largest(int first, int second)
{
	return [=](const RigVector& error)
	{
		double most = 0;
		for (const int begin : {first, second})
			for (int i = begin; i < begin + 3; ++i)
				if (!hidden(i)) most = std::max(most, std::abs(error[i]));
		return most;
	};
}

std::vector<Kind> kinds()
{
	using Order = RigOrder;
	const double track_m = trueRig(calibrationDrive(), 1).wheels.track_m;
	return {{"scale (mean of the wheels)", "%", 50, 0.2,
	         [](const RigVector& e) { return std::abs(e[Order::left_scale] + e[Order::right_scale]); }},
	        {"left wheel against right", "%", 100, 0.2,
	         [](const RigVector& e) { return std::abs(e[Order::left_scale] - e[Order::right_scale]); }},
	        {"track", "%", 100 / track_m, 0.5, [](const RigVector& e) { return std::abs(e[Order::track]); }},
	        {"turn of a mounting", "deg", 1 / kDegree, 0.2, largest(Order::imu_rotation, Order::camera_rotation)},
	        {"lever arm", "mm", 1e3, 10, largest(Order::imu_lever, Order::camera_lever)},
	        {"clock", "ms", 1e3, 1,
	         [](const RigVector& e) { return std::max(std::abs(e[Order::camera_offset]), std::abs(e[Order::wheel_offset])); }}};
}

/** What viwo-calibrate made of one log. */
struct Calibrated
{
	RigVector error = RigVector::Constant(std::numeric_limits<double>::infinity());
	RigVector deviation = RigVector::Ones();
	std::vector<bool> observed = std::vector<bool>(RigOrder::size, true);
	std::string problem;
};

/** Factors from the units of the report to metres, radians and seconds. */
double reportFactor(const std::string& unit)
{
	return unit == "mm" || unit == "ms" ? 1e-3 : unit == "deg" ? kDegree : 1;
}

Calibrated calibrated(const Runner& runner, const SimulatedDrive& drive, uint64_t seed)
{
	Calibrated c;
	const Outcome outcome = runner.calibrationOutcome(drive.log(seed));
	c.problem = outcome.error;
	if (outcome.failed()) return c;
	const Json parameters = loadJson(outcome.file("program.out")).at("parameters");
	c.error = rigDifference(loadRig(outcome.file("rig.ini")), trueRig(drive, seed));
	for (int i = 0; i < RigOrder::size; ++i)
	{
		const auto k = static_cast<size_t>(i);
		const Json& p = parameters.at(RigOrder::names()[k]);
		c.observed[k] = p.at("observed").get<bool>();
		if (c.observed[k]) c.deviation[i] = reportFactor(p.at("unit")) * p.at("deviation").get<double>();
	}
	return c;
}

class CalibrationGroup : public Group
{
   public:
	using Group::Group;
	std::vector<std::string> bars() const override;
	void plan(Runner& runner) const override;
	std::vector<Row> judge(const Runner& runner) const override;

   private:
	Row withinDeviations(const std::vector<Calibrated>& seeds) const;
};

std::vector<std::string> CalibrationGroup::bars() const
{
	std::vector<std::string> names{"calibration: errors within 3 of their deviations",
	                               "calibration: parameters observed besides the heights"};
	for (const Kind& kind : kinds()) names.push_back(std::string("calibration: worst ") + kind.what);
	return names;
}

void CalibrationGroup::plan(Runner& runner) const
{
	const SimulatedDrive drive = calibrationDrive();
	for (uint64_t seed = 1; seed <= static_cast<uint64_t>(settings_.seeds); ++seed)
	{
		const LogRecipe log = drive.log(seed);
		runner.wantCalibration({log, saveRig(settings_, drive, wrongRig(trueRig(drive, seed), seed), log.name + "-wrong"), 40});
	}
}

Row CalibrationGroup::withinDeviations(const std::vector<Calibrated>& seeds) const
{
	int pairs = 0, within = 0;
	double worst = 0;
	for (const Calibrated& c : seeds)
		for (int i = 0; i < RigOrder::size; ++i)
		{
			if (hidden(i) || !c.observed[static_cast<size_t>(i)]) continue;
			const double ratio = std::abs(c.error[i]) / c.deviation[i];
			worst = std::max(worst, ratio);
			++pairs;
			if (ratio <= 3) ++within;
		}
	return atLeast(
	    bars()[0], pairs > 0 ? 100.0 * within / pairs : 0, 95, "%",
	    std::to_string(within) + " of " + std::to_string(pairs) + listOf(" pairs of parameter and seed; farthest", {worst}, 1, ""));
}

std::vector<Row> CalibrationGroup::judge(const Runner& runner) const
{
	const SimulatedDrive drive = calibrationDrive();
	std::vector<Calibrated> seeds;
	std::string problems;
	std::vector<double> observed;
	for (uint64_t seed = 1; seed <= static_cast<uint64_t>(settings_.seeds); ++seed)
	{
		seeds.push_back(calibrated(runner, drive, seed));
		const Calibrated& c = seeds.back();
		if (!c.problem.empty()) problems += "; " + c.problem;
		int count = 0;
		for (int i = 0; i < RigOrder::size; ++i)
			if (!hidden(i) && c.problem.empty() && c.observed[static_cast<size_t>(i)]) ++count;
		observed.push_back(count);
	}
	std::vector<Row> rows{withinDeviations(seeds), atLeast(bars()[1], *std::min_element(observed.begin(), observed.end()),
	                                                       RigOrder::size - 2, "", listOf("of the seeds:", observed, 1, "") + problems)};
	for (const Kind& kind : kinds())
	{
		std::vector<double> errors;
		for (const Calibrated& c : seeds) errors.push_back(kind.factor * kind.figure(c.error));
		rows.push_back(atMost(bars()[rows.size()], worst(errors), kind.limit, kind.unit, listOf("of the seeds:", errors, 1, kind.unit)));
	}
	return rows;
}
}  // namespace

std::unique_ptr<Group> calibration(const Settings& settings)
{
	return std::make_unique<CalibrationGroup>(settings);
}
}  // namespace viwo::accuracy
