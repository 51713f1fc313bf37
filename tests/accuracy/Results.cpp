#include "Results.h"

#include <viwo/core/AtomicFile.h>
#include <viwo/evaluation/Table.h>

#include <algorithm>
#include <cstdio>

namespace viwo::accuracy
{
namespace
{
std::string number(double value)
{
	if (std::isnan(value)) return "-";
	char text[32];
	std::snprintf(text, sizeof text, "%.3g", value);
	return text;
}

std::string limitText(const Row& row)
{
	if (row.min && row.max) return number(*row.min) + " to " + number(*row.max);
	if (row.min) return "at least " + number(*row.min);
	return row.max ? "at most " + number(*row.max) : "";
}

std::string verdict(const Row& row)
{
	return row.skipped ? "skipped" : row.holds() ? "yes" : "NO";
}

Json toJson(const Row& row)
{
	Json j;
	j["name"] = row.name;
	j["value"] = row.skipped ? Json() : Json(row.value);
	if (row.min && row.max)
		j["limit"] = {*row.min, *row.max};
	else
		j["limit"] = row.min ? Json(*row.min) : row.max ? Json(*row.max) : Json();
	j["bound"] = row.min && row.max ? "within" : row.min ? "at least" : "at most";
	j["holds"] = row.skipped ? Json() : Json(row.holds());
	j["unit"] = row.unit;
	j["detail"] = row.detail;
	return j;
}

Table tableOf(const std::vector<Row>& rows)
{
	Table table({{"what", "", true}, {"measured", ""}, {"limit", ""}, {"unit", "", true}, {"holds", "", true}, {"detail", "", true}});
	for (const Row& row : rows)
		table.addRow({row.name, row.skipped ? "-" : number(row.value), limitText(row), row.unit, verdict(row), row.detail});
	return table;
}
}  // namespace

Row atMost(const std::string& name, double value, double limit, const std::string& unit, const std::string& detail)
{
	return {name, unit, value, std::nullopt, limit, detail, false};
}

Row atLeast(const std::string& name, double value, double limit, const std::string& unit, const std::string& detail)
{
	return {name, unit, value, limit, std::nullopt, detail, false};
}

Row skippedRow(const std::string& name, const std::string& why)
{
	Row row;
	row.name = name;
	row.detail = "skipped: " + why;
	row.skipped = true;
	return row;
}

bool Results::allHold() const
{
	return std::all_of(rows_.begin(), rows_.end(), [](const Row& r) { return r.skipped || r.holds(); });
}

void Results::save(const std::string& stem) const
{
	Json j;
	j["all_hold"] = allHold();
	j["rows"] = Json::array();
	for (const Row& row : rows_) j["rows"].push_back(toJson(row));
	saveJson(stem + ".json", j);
	AtomicFile file(stem + ".md");
	file.stream() << tableOf(rows_).toMarkdown();
	file.commit();
}

std::string Results::toText() const
{
	return tableOf(rows_).toText();
}
}  // namespace viwo::accuracy
