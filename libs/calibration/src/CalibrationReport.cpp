#include <mrpt/core/format.h>
#include <viwo/calibration/CalibrationReport.h>
#include <viwo/evaluation/Chart.h>
#include <viwo/evaluation/Html.h>
#include <viwo/evaluation/Json.h>
#include <viwo/evaluation/Table.h>

#include <algorithm>
#include <cmath>

namespace viwo
{
namespace
{
std::string number(double value, int decimals)
{
	const double unit = std::pow(10.0, -decimals);
	const bool is_zero = std::abs(value) < 0.5 * unit;  // not "-0.00"
	return mrpt::format("%.*f", decimals, is_zero ? 0.0 : value);
}

/** As many decimals as the deviation fills with two digits. */
int decimalsOf(const CalibrationRow& row)
{
	if (!row.observed || !(row.deviation > 0)) return row.unit.empty() ? 5 : row.unit == "deg" ? 3 : 2;
	return std::clamp(1 - static_cast<int>(std::floor(std::log10(row.deviation))), 0, 6);
}

Table parameterTable(const CalibrationRunResult& result)
{
	Table table({{"", "", true}, {"unit", "", true}, {"start", ""}, {"result", ""}, {"deviation", ""}, {"change", ""}});
	for (const CalibrationRow& row : result.rows)
	{
		const int n = decimalsOf(row);
		if (row.observed)
			table.addRow({row.what, row.unit, number(row.start, n), number(row.value, n), number(row.deviation, n),
			              number(row.value - row.start, n)},
			             {3});
		else
			table.addRow({row.what, row.unit, number(row.start, n), number(row.value, n), "not observed", "-"});
	}
	return table;
}

struct QualityRow
{
	const char *key, *what, *unit;
	double CalibrationQuality::*member;
};
constexpr QualityRow kQuality[] = {{"image_px", "images: reprojection", "px", &CalibrationQuality::image_px},
                                   {"wheel_forward_mm", "wheels: forward, per interval", "mm", &CalibrationQuality::wheel_forward_mm},
                                   {"wheel_sideways_mm", "wheels: sideways, per interval", "mm", &CalibrationQuality::wheel_sideways_mm},
                                   {"wheel_yaw_mrad", "wheels: heading, per interval", "mrad", &CalibrationQuality::wheel_yaw_mrad},
                                   {"reference_mm", "reference: position", "mm", &CalibrationQuality::reference_mm}};

Table qualityTable(const CalibrationRunResult& result)
{
	Table table({{"root mean square of the residuals", "", true}, {"unit", "", true}, {"before", ""}, {"after", ""}});
	for (const QualityRow& row : kQuality)
	{
		const double before = result.batch.before.*row.member, after = result.batch.after.*row.member;
		if (before == 0 && after == 0) continue;
		table.addRow({row.what, row.unit, number(before, 3), number(after, 3)});
	}
	return table;
}

/** Below the table. */
std::string notObservedLine(const CalibrationRunResult& result)
{
	for (const CalibrationRow& row : result.rows)
		if (!row.observed) return "not observed: the drive does not tell it; it is what it was at the start\n";
	return {};
}

/** The drive, or the part of it. */
std::string usedPart(const CalibrationRunResult& r)
{
	return number(r.duration_s, 1) + " s of " + r.rawlogs + (r.from_s > 0 ? " from " + number(r.from_s, 1) + " s on" : "");
}

std::string summaryLine(const CalibrationRunResult& r)
{
	const BatchCalibrationResult& b = r.batch;
	return usedPart(r) + ": " + std::to_string(b.keyframes) + " key frames, " + std::to_string(b.landmarks) + " landmarks, " +
	       std::to_string(b.rounds) + " rounds; noise of a corner " + number(b.pixel_sigma_px, 2) + " px, of the wheels " +
	       number(b.wheel_noise_ratio, 2) + " times the configured, slip " + number(b.slip_s, 1) + " s";
}

LineChart misfitChart(const CalibrationRunResult& result, const std::string& title, const std::string& label,
                      double CalibrationMisfit::*member)
{
	LineChart chart;
	chart.title = title;
	chart.x_label = "time (s)";
	chart.y_label = label;
	for (const bool is_after : {false, true})
	{
		LineChart::Curve curve{is_after ? "after" : "before", {}};
		for (const CalibrationMisfit& m : (is_after ? result.batch.after : result.batch.before).frames)
			curve.points.emplace_back(m.t_s, m.*member);
		chart.curves.push_back(std::move(curve));
	}
	return chart;
}

void addMisfits(const CalibrationRunResult& result, HtmlPage& page)
{
	const struct
	{
		const char *title, *label, *caption;
		double CalibrationMisfit::*member;
	} charts[] = {
	    {"Images", "px", "Reprojection error of the corners of each key frame, root mean square.", &CalibrationMisfit::image_px},
	    {"Wheels, forward", "mm", "Travel from key frame to key frame less what the wheels say.", &CalibrationMisfit::wheel_forward_mm},
	    {"Wheels, sideways", "mm", "Sideways motion of the robot's frame, which wheels do not make.",
	     &CalibrationMisfit::wheel_sideways_mm},
	    {"Wheels, heading", "mrad", "Turn from key frame to key frame less what the wheels say.", &CalibrationMisfit::wheel_yaw_mrad}};
	page.beginRow();
	for (const auto& c : charts) page.figure(toSvg(misfitChart(result, c.title, c.label, c.member), PlotColours::page), c.caption);
	page.endRow();
}

std::string deviationsText(const CalibrationRunResult& result)
{
	std::string text = "\nStandard deviations (not observed: the input was kept):\n";
	for (const CalibrationRow& row : result.rows)
	{
		const std::string deviation = row.observed ? number(row.deviation, std::max(3, decimalsOf(row))) : "not observed";
		text.append("  ").append(row.key).append(": ").append(deviation);
		if (row.observed && !row.unit.empty()) text.append(" ").append(row.unit);
		text.append("\n");
	}
	for (const std::string& note : result.batch.notes) text.append("Note: ").append(note).append("\n");
	return text;
}
}  // namespace

std::string calibrationText(const CalibrationRunResult& result)
{
	return summaryLine(result) + "\n\n" + parameterTable(result).toText() + notObservedLine(result) + "\n" + qualityTable(result).toText();
}

std::string calibrationJson(const CalibrationRunResult& result)
{
	Json json;
	json["program"] = "viwo-calibrate estimate " VIWO_VERSION;
	json["rawlog"] = result.rawlogs;
	if (!result.reference.empty()) json["reference"] = result.reference;
	json["from_s"] = result.from_s;
	json["duration_s"] = result.duration_s;
	json["key_frames"] = result.batch.keyframes;
	json["landmarks"] = result.batch.landmarks;
	json["rounds"] = result.batch.rounds;
	json["pixel_sigma_px"] = result.batch.pixel_sigma_px;
	json["wheel_noise_ratio"] = result.batch.wheel_noise_ratio;
	json["slip_s"] = result.batch.slip_s;
	json["wall_time_s"] = result.wall_time_s;
	json["notes"] = result.batch.notes;
	for (const CalibrationRow& row : result.rows)
	{
		Json& parameter = json["parameters"][row.key];
		parameter["meaning"] = row.what;
		parameter["unit"] = row.unit;
		parameter["start"] = row.start;
		parameter["value"] = row.value;
		if (row.observed) parameter["deviation"] = row.deviation;
		parameter["observed"] = row.observed;
	}
	for (const QualityRow& row : kQuality)
	{
		json["residuals_before"][row.key] = result.batch.before.*row.member;
		json["residuals_after"][row.key] = result.batch.after.*row.member;
	}
	return toText(json);
}

std::string calibrationHtml(const CalibrationRunResult& result)
{
	HtmlPage page("Calibration");
	page.paragraph(summaryLine(result) + (result.reference.empty() ? "." : "; reference " + result.reference + "."));
	for (const std::string& note : result.batch.notes) page.paragraph("Note: " + note + ".");
	page.heading("What was found");
	page.table(
	    parameterTable(result),
	    "x forward, y left, z up from the middle of the wheel axle on the ground. Deviations are standard deviations. What the motion "
	    "does not tell is kept as it was given; on a plane that is always the height of the IMU.");
	page.heading("Residuals before and after");
	page.paragraph(
	    "Before: with the calibration at the start, and everything else (path, landmarks, biases) at its best; there corners count that "
	    "are "
	    "off by up to 30 px. Those that lie far off are weighed down, so these figures are larger than the noise of a corner.");
	page.table(qualityTable(result), "");
	addMisfits(result, page);
	return page.toString();
}

void saveCalibration(const CalibrationRunResult& result, const std::string& path)
{
	result.rig.save(path, "Calibration of a robot's sensors, estimated by viwo-calibrate " VIWO_VERSION " from " + usedPart(result) +
	                          ".\nFor viwo-odometry --rig, and rawlog-edit --camera-params LABEL,FILE and --sensors-pose FILE.\n" +
	                          deviationsText(result));
}
}  // namespace viwo
