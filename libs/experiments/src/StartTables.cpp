#include <viwo/experiments/Starts.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "Figures.h"

namespace viwo::experiments
{
namespace
{
using Figure = std::function<double(const Start&)>;

constexpr size_t kColumns = 7;  // 30 to 210 s
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr int kTimeDecimals = 2, kRmseDecimals = 3;

/** One row of Table 2 or 3: medians over the seeds at each start time, and their average. */
struct Row
{
	std::vector<double> values;
	std::vector<bool> counts;  //!< into the average
	std::vector<bool> open;    //!< runs have not been done
	double average = kNone;

	bool whole() const
	{
		return std::none_of(open.begin(), open.end(), [](bool o) { return o; });
	}
	/** Starts that count and have no figure. */
	size_t dashes() const
	{
		size_t n = 0;
		for (size_t i = 0; i < values.size(); ++i) n += counts[i] && std::isnan(values[i]) ? 1 : 0;
		return n;
	}
};

/** @param everywhere starts that do not drive count, too. */
Row rowOf(const std::vector<Start>& starts, const std::string& sequence, const Figure& figure, bool everywhere)
{
	std::map<double, std::vector<double>> by_time;
	std::map<double, bool> driving, open;
	for (const Start& start : starts)
	{
		if (start.sequence != sequence) continue;
		by_time[start.start_s].push_back(figure(start));
		driving[start.start_s] = start.driving;
		open[start.start_s] = open[start.start_s] || start.open;
	}
	Row row;
	double sum = 0;
	int count = 0;
	for (const auto& [start_s, values] : by_time)
	{
		row.values.push_back(median(values));
		row.counts.push_back(everywhere || driving[start_s]);
		row.open.push_back(open[start_s]);
		if (!row.counts.back() || std::isnan(row.values.back())) continue;
		sum += row.values.back();
		++count;
	}
	if (count > 0 && row.whole()) row.average = sum / count;
	return row;
}

/** Which of two rows are the better one: fewer dashes, whatever the average of the rest; then the smaller average. Both where they print
 * the same, none while runs are open. */
std::pair<bool, bool> better(const Row& a, const Row& b, int decimals)
{
	if (!a.whole() || !b.whole()) return {false, false};
	if (a.dashes() != b.dashes()) return {a.dashes() < b.dashes(), b.dashes() < a.dashes()};
	const std::set<size_t> best = smallest({a.average, b.average}, decimals);
	return {best.count(0) != 0, best.count(1) != 0};
}

Row paperRow(const PaperRow& printed)
{
	const size_t n = printed.values.size();
	return {printed.values, std::vector<bool>(n, true), std::vector<bool>(n, false), printed.average};
}

Table emptyTable(const char* unit)
{
	std::vector<Table::Column> columns{{"sequence", "", true}, {"start at", "", true}};
	for (size_t i = 1; i <= kColumns; ++i) columns.push_back({std::to_string(30 * i) + " s", unit});
	columns.push_back({"average", unit});
	return Table(columns);
}

void add(Table& table, const std::string& sequence, const std::string& name, const Row& row, int decimals, bool bold)
{
	std::vector<std::string> cells{sequence, name};
	for (size_t i = 0; i < kColumns; ++i)
	{
		if (i >= row.values.size())
			cells.emplace_back("");
		else if (row.open[i])
			cells.emplace_back(kOpenMark);
		else
			cells.push_back(row.counts[i] ? fixed(row.values[i], decimals) : "(" + fixed(row.values[i], decimals) + ")");
	}
	cells.push_back(row.whole() ? fixed(row.average, decimals) : kOpenMark);
	table.addRow(cells, bold ? std::set<size_t>{cells.size() - 1} : std::set<size_t>{});
}

double vinsTime(const Start& s)
{
	return s.vins.aligned_s;
}
double ownTime(const Start& s)
{
	return s.ours.aligned_s;
}
double firstPose(const Start& s)
{
	return s.ours.first_pose_s;
}
double vinsRmse(const Start& s)
{
	return s.vins.rmse_m;
}
double ownRmse(const Start& s)
{
	return s.ours.rmse_m;
}

Json runJson(const StartRun& run)
{
	return {{"problem", run.problem}, {"first_pose_s", run.first_pose_s}, {"aligned_s", run.aligned_s}, {"rmse_m", run.rmse_m},
	        {"scale", run.scale},     {"converged", run.converged}};
}
}  // namespace

Table table2(const std::vector<Start>& starts)
{
	Table table = emptyTable("s");
	for (const std::string& sequence : sequencesOf(starts))
	{
		const PaperSequence& paper = paperSequence(sequence);
		const Row vins = rowOf(starts, sequence, vinsTime, false), own = rowOf(starts, sequence, ownTime, false);
		const auto [vins_better, own_better] = better(vins, own, kTimeDecimals);
		add(table, sequence, "VINS-Mono's method", vins, kTimeDecimals, vins_better);
		add(table, "", "ours, vision-aligned", own, kTimeDecimals, own_better);
		add(table, "", "ours, first metric pose", rowOf(starts, sequence, firstPose, true), kTimeDecimals, false);
		add(table, "", "paper, VINS-Mono", paperRow(paper.vins_time_s), 2, false);
		add(table, "", "paper, their system", paperRow(paper.own_time_s), 2, false);
	}
	return table;
}

Table table3(const std::vector<Start>& starts)
{
	Table table = emptyTable("m");
	for (const std::string& sequence : sequencesOf(starts))
	{
		const PaperSequence& paper = paperSequence(sequence);
		const Row vins = rowOf(starts, sequence, vinsRmse, true), own = rowOf(starts, sequence, ownRmse, true);
		const auto [vins_better, own_better] = better(vins, own, kRmseDecimals);
		add(table, sequence, "VINS-Mono's method", vins, kRmseDecimals, vins_better);
		add(table, "", "ours", own, kRmseDecimals, own_better);
		add(table, "", "paper, VINS-Mono", paperRow(paper.vins_rmse_m), 2, false);
		add(table, "", "paper, their system", paperRow(paper.own_rmse_m), 2, false);
	}
	return table;
}

Table startRuns(const std::vector<Start>& starts)
{
	Table table({{"sequence", "", true},
	             {"seed", ""},
	             {"start", "s"},
	             {"driving", "", true},
	             {"VINS aligned", "s"},
	             {"ours aligned", "s"},
	             {"ours first pose", "s"},
	             {"VINS RMSE", "m"},
	             {"ours RMSE", "m"},
	             {"VINS scale", ""},
	             {"ours scale", ""}});
	for (const Start& s : starts)
	{
		if (s.open) continue;
		table.addRow({s.sequence, std::to_string(s.seed), fixed(s.start_s, 0), s.driving ? "yes" : "no", fixed(s.vins.aligned_s, 2),
		              fixed(s.ours.aligned_s, 2), fixed(s.ours.first_pose_s, 2), fixed(s.vins.rmse_m, 4), fixed(s.ours.rmse_m, 4),
		              fixed(s.vins.scale, 3), fixed(s.ours.scale, 3)});
	}
	return table;
}

Json startsJson(const std::vector<Start>& starts)
{
	Json rows = Json::array();
	for (const Start& s : starts)
	{
		Json row{{"sequence", s.sequence}, {"seed", s.seed}, {"start_s", s.start_s}, {"measured", !s.open}};
		if (!s.open) row.update({{"driving", s.driving}, {"ours", runJson(s.ours)}, {"vins", runJson(s.vins)}});
		rows.push_back(row);
	}
	Json averages = Json::array();
	for (const StartAverages& a : startAverages(starts))
	{
		const PaperSequence& paper = paperSequence(a.sequence);
		averages.push_back({{"sequence", a.sequence},
		                    {"vins_s", a.vins_s},
		                    {"aligned_s", a.aligned_s},
		                    {"first_pose_s", a.first_pose_s},
		                    {"vins_rmse_m", a.vins_rmse_m},
		                    {"rmse_m", a.rmse_m},
		                    {"paper",
		                     {{"vins_s", paper.vins_time_s.average},
		                      {"own_s", paper.own_time_s.average},
		                      {"vins_rmse_m", paper.vins_rmse_m.average},
		                      {"own_rmse_m", paper.own_rmse_m.average}}}});
	}
	return {{"averages", averages}, {"starts", rows}};
}

std::vector<StartAverages> startAverages(const std::vector<Start>& starts)
{
	std::vector<StartAverages> list;
	for (const std::string& sequence : sequencesOf(starts))
		list.push_back({sequence, rowOf(starts, sequence, vinsTime, false).average, rowOf(starts, sequence, ownTime, false).average,
		                rowOf(starts, sequence, firstPose, true).average, rowOf(starts, sequence, vinsRmse, true).average,
		                rowOf(starts, sequence, ownRmse, true).average});
	return list;
}
}  // namespace viwo::experiments
