#include <viwo/calibration/ImuNoiseReport.h>
#include <viwo/core/AtomicFile.h>
#include <viwo/core/NumberText.h>
#include <viwo/evaluation/Html.h>
#include <viwo/evaluation/Json.h>

#include <cmath>

#include "AllanPlot.h"

namespace viwo
{
namespace
{
std::string withDeviation(double value, double deviation)
{
	return significant(value, 3) + " +- " + significant(deviation, 1);
}

std::string textOf(const NoiseReading& r)
{
	return r.observed ? withDeviation(r.value, r.deviation) : "-";
}

std::string textOf(const BiasInstability& b)
{
	if (!(b.value > 0)) return "-";
	return b.reached ? withDeviation(b.value, b.deviation) : "< " + significant(b.value + 2 * b.deviation, 2);
}

/** As somebody would say it who is to record one. */
std::string duration(double seconds)
{
	if (seconds < 600) return fixed(seconds, 0) + " s";
	return seconds < 7200 ? fixed(seconds / 60, 0) + " min" : fixed(seconds / 3600, 1) + " h";
}

Table axesTable(const ImuNoiseResult& result, size_t first)
{
	const std::string u = imuAxisUnit(first);
	Table table({{"", "", true}, {imuAxisName(first), ""}, {imuAxisName(first + 1), ""}, {imuAxisName(first + 2), ""}});
	const auto add = [&](const char* what, const std::string& unit, const auto& of) {
		table.addRow({what + (", " + unit), of(first), of(first + 1), of(first + 2)});
	};
	const auto& axes = result.axes;
	add("mean", u, [&](size_t axis) { return significant(result.mean[axis], 4); });
	add("white noise N", u + "/sqrt(Hz)", [&](size_t axis) { return textOf(axes[axis].white); });
	add("bias instability B", u, [&](size_t axis) { return textOf(axes[axis].instability); });
	add("at the cluster time", "s", [&](size_t axis) { return significant(axes[axis].instability.tau_s, 2); });
	add("random walk K", first < 3 ? "m/s^3/sqrt(Hz)" : "rad/s^2/sqrt(Hz)", [&](size_t axis) { return textOf(axes[axis].walk); });
	add("quantisation Q", u + "*s", [&](size_t axis) { return textOf(axes[axis].quantisation); });
	return table;
}

std::string logLine(const ImuNoiseResult& r)
{
	std::string line = r.imu_label + ": " + std::to_string(r.samples) + " samples over " + duration(r.duration_s) + " at " +
	                   significant(r.rate_hz, 4) + " Hz";
	if (r.lost > 0) line += ", " + std::to_string(r.lost) + " lost (longest gap " + fixed(r.longest_gap_s, 2) + " s)";
	bool smoothed = false;
	for (const NoiseModel& m : r.axes) smoothed = smoothed || m.smoothed;
	if (smoothed) line += "; its samples are smoothed by the sensor";
	return line;
}

std::string keyLine(const char* key, const WorstAxis& worst, const ImuNoiseResult& result)
{
	if (worst.reading.observed)
		return std::string(key) + " = " + significant(worst.reading.value, 4) + " +- " + significant(worst.reading.deviation, 1) + " (" +
		       imuAxisName(worst.axis) + ", the largest)";
	return std::string(key) + ": not observed: log of " + duration(result.duration_s) + ", " +
	       duration(result.axes[worst.axis].walk_needs_s) + " needed; below " + significant(worst.reading.limit, 2);
}

std::vector<std::string> keyLines(const ImuNoiseResult& r)
{
	return {keyLine("acc_noise_m_s2_sqrtHz", r.acc_noise, r), keyLine("gyro_noise_rad_s_sqrtHz", r.gyro_noise, r),
	        keyLine("acc_walk_m_s3_sqrtHz", r.acc_walk, r), keyLine("gyro_walk_rad_s2_sqrtHz", r.gyro_walk, r)};
}

Json toJson(const NoiseReading& r)
{
	Json json;
	json["observed"] = r.observed;
	if (r.observed) json["value"] = r.value;
	if (r.observed) json["deviation"] = r.deviation;
	json["limit_95"] = r.limit;
	return json;
}

Json toJson(const NoiseModel& m)
{
	Json json;
	if (m.points.empty()) return nullptr;
	json["white_N"] = toJson(m.white);
	json["bias_instability_B"] = {{"value", m.instability.value},
	                              {"deviation", m.instability.deviation},
	                              {"tau_s", m.instability.tau_s},
	                              {"reached", m.instability.reached}};
	json["random_walk_K"] = toJson(m.walk);
	if (!m.walk.observed) json["random_walk_K"]["needs_s"] = m.walk_needs_s;
	json["quantisation_Q"] = toJson(m.quantisation);
	json["flicker_of_fit"] = toJson(m.flicker);
	json["misfit"] = m.misfit;
	json["shortest_tau_s"] = m.shortest_s;
	json["smoothed"] = m.smoothed;
	return json;
}

Json toJson(const WorstAxis& worst)
{
	Json json = toJson(worst.reading);
	json["axis"] = imuAxisName(worst.axis);
	return json;
}
}  // namespace

std::string describeImuNoise(const ImuNoiseResult& result)
{
	std::string text = logLine(result) + "\n\n" + axesTable(result, 0).toText() + "\n" + axesTable(result, 3).toText() + "\n";
	for (const std::string& line : keyLines(result)) text += line + "\n";
	return text;
}

std::string imuNoiseOrigin(const ImuNoiseResult& result, const std::string& program)
{
	std::string text = "Noise of an IMU at rest by its Allan deviation, made by " + program + ": of each sensor's axes the largest. " +
	                   logLine(result) + ".";
	for (const std::string& line : keyLines(result)) text += "\n" + line;
	return text;
}

void saveImuNoiseSvg(const std::string& path, const ImuNoiseResult& result)
{
	writeAtomically(path, allanPlot(result, {0, 3}, lightPalette()));
}

void saveImuNoiseHtml(const std::string& path, const ImuNoiseResult& result)
{
	HtmlPage page("Noise of " + result.imu_label);
	page.paragraph(logLine(result) + ".");
	page.beginRow();
	for (const size_t first : {0u, 3u})
		page.figure(allanPlot(result, {first}, pagePalette()),
		            std::string(first == 0 ? "Accelerometer" : "Gyroscope") +
		                ": overlapping Allan deviation of each axis over the cluster time, with the curves fitted after IEEE Std 952. " +
		                kAllanMarks);
	page.endRow();
	for (const std::string& line : keyLines(result)) page.paragraph(line);
	page.heading("Axes");
	page.table(axesTable(result, 0), "");
	page.table(axesTable(result, 3), "With standard deviations; '<': the curve still falls at its end; '-': not observed.");
	if (!result.warnings.empty()) page.heading("Warnings");
	for (const std::string& warning : result.warnings) page.paragraph(warning);
	writeAtomically(path, page.toString());
}

void saveImuNoiseJson(const std::string& path, const ImuNoiseResult& r)
{
	Json json;
	json["imu_label"] = r.imu_label;
	json["duration_s"] = r.duration_s;
	json["rate_hz"] = r.rate_hz;
	json["samples"] = r.samples;
	json["lost"] = r.lost;
	json["pieces"] = r.pieces;
	json["longest_gap_s"] = r.longest_gap_s;
	json["jitter_s"] = r.jitter_s;
	json["rejected"] = Json::object();
	for (const auto& [reason, count] : r.rejected) json["rejected"][reason] = count;
	json["acc_noise_m_s2_sqrtHz"] = toJson(r.acc_noise);
	json["gyro_noise_rad_s_sqrtHz"] = toJson(r.gyro_noise);
	json["acc_walk_m_s3_sqrtHz"] = toJson(r.acc_walk);
	json["gyro_walk_rad_s2_sqrtHz"] = toJson(r.gyro_walk);
	for (size_t axis = 0; axis < kImuAxes; ++axis)
	{
		Json& one = json["axes"][imuAxisName(axis)] = toJson(r.axes[axis]);
		if (one.is_object()) one["mean"] = r.mean[axis];
	}
	json["warnings"] = r.warnings;
	saveJson(path, json);
}

void saveImuNoiseCsv(const std::string& path, const ImuNoiseResult& result)
{
	AtomicFile file(path);
	file.stream() << "# overlapping Allan deviation; low, high: 95 % interval; units: " << imuAxisUnit(0) << ", " << imuAxisUnit(3)
	              << "\naxis,tau_s,deviation,low,high,fitted,used\n";
	for (size_t axis = 0; axis < kImuAxes; ++axis)
		for (const FittedPoint& p : result.axes[axis].points)
			file.stream() << imuAxisName(axis) << ',' << significant(p.point.tau_s, 7) << ',' << significant(p.point.deviation, 7) << ','
			              << significant(p.low, 7) << ',' << significant(p.high, 7) << ',' << significant(p.model, 7) << ','
			              << (p.used ? 1 : 0) << '\n';
	file.commit();
}
}  // namespace viwo
