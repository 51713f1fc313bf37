#include "Session.h"

#include "InertialYaw.h"
#include "RangeNoise.h"

#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <viwo/core/Error.h>
#include <viwo/core/MrptPose.h>
#include <viwo/core/Time.h>
#include <viwo/rawlog/MrptTime.h>
#include <viwo/rawlog/RawlogReader.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>

namespace viwo::gt
{
namespace
{
using mrpt::obs::CObservation2DRangeScan;

constexpr double kOdometryGap_s = 1.0, kScanGap_s = 1.0;

struct StampedPose2
{
	int64_t t_ns;
	Pose2 T;
};

/** Everything of use in the rawlogs, before labels are chosen. */
struct Contents
{
	std::map<std::string, std::vector<Scan>> scans;
	std::vector<StampedPose2> odometry;
	InertialYaw inertial;
	size_t bad_scans = 0, bad_ranges = 0, late = 0, bad_odometry = 0;
	std::string labels;  //!< of everything, for messages
};

bool finite(const Pose3& T)
{
	return T.p.allFinite() && T.R.coeffs().allFinite();
}

/** Nothing for a scan that cannot be used: no geometry, or a pose that is not finite. */
std::optional<Scan> convert(const CObservation2DRangeScan& observation)
{
	const size_t n = observation.getScanSize();
	Scan scan;
	scan.t_ns = nanosecondsOf(observation.timestamp);
	scan.T_OL = fromMrpt(observation.sensorPose);
	if (n < 2 || !(observation.aperture > 0) || !finite(scan.T_OL)) return std::nullopt;
	scan.max_range_m = observation.maxRange;
	scan.first_angle_rad = -0.5 * static_cast<double>(observation.aperture);
	scan.step_rad = static_cast<double>(observation.aperture) / static_cast<double>(n - 1);
	scan.ranges_m.resize(n);
	for (size_t i = 0; i < n; ++i)
	{
		const size_t source = observation.rightToLeft ? i : n - 1 - i;
		const float r = observation.getScanRange(source);
		// A laser's "no return" is often its largest range with the flag of a valid one.
		const bool valid = observation.getScanRangeValidity(source) && std::isfinite(r) && r > 0 && r < 0.999f * observation.maxRange;
		scan.ranges_m[i] = valid ? r : 0;
	}
	return scan;
}

void add(const mrpt::obs::CObservation& o, const GroundTruthRunOptions& options, Contents& contents)
{
	if (const auto* scan = dynamic_cast<const CObservation2DRangeScan*>(&o))
	{
		if (!options.scan_label.empty() && scan->sensorLabel != options.scan_label) return;
		auto converted = convert(*scan);
		std::vector<Scan>& scans = contents.scans[scan->sensorLabel];
		for (size_t i = 0; i < scan->getScanSize(); ++i) contents.bad_ranges += std::isnan(scan->getScanRange(i));
		if (!converted)
			++contents.bad_scans;
		else if (!scans.empty() && converted->t_ns <= scans.back().t_ns)
			++contents.late;
		else
			scans.push_back(std::move(*converted));
	}
	else if (const auto* odometry = dynamic_cast<const mrpt::obs::CObservationOdometry*>(&o))
	{
		if (odometry->sensorLabel != options.odometry_label) return;
		const Pose2 T(odometry->odometry.x(), odometry->odometry.y(), odometry->odometry.phi());
		const int64_t t_ns = nanosecondsOf(odometry->timestamp);
		const bool increasing = contents.odometry.empty() || t_ns > contents.odometry.back().t_ns;
		if (!T.p.allFinite() || !std::isfinite(T.yaw) || !increasing)
			++contents.bad_odometry;
		else
			contents.odometry.push_back({t_ns, T});
	}
	else if (const auto* imu = dynamic_cast<const mrpt::obs::CObservationIMU*>(&o))
		if (imu->sensorLabel == options.imu_label && options.options.odometry.use_imu) contents.inertial.add(*imu);
}

void read(const std::string& path, const GroundTruthRunOptions& options, const std::function<bool(double)>& proceed, Contents& contents)
{
	RawlogReaderOptions reader_options;
	reader_options.allow_truncated = options.allow_truncated;
	reader_options.skip_missing_images = true;
	reader_options.action_odometry_label = options.odometry_label;
	RawlogReader reader(path, reader_options);
	const Pose2 start = contents.odometry.empty() ? Pose2() : contents.odometry.back().T;
	const size_t odometry_before = contents.odometry.size();
	size_t count = 0;
	while (const auto observation = reader.next())
	{
		add(*observation, options, contents);
		if (++count % 256 == 0 && !proceed(reader.progress())) throw Error("interrupted: nothing was written");
	}
	contents.late += reader.counts().late;
	contents.labels += (contents.labels.empty() ? "" : ", ") + reader.counts().describe();
	// A second rawlog's odometry counts from its own start.
	if (odometry_before == 0 || contents.odometry.size() == odometry_before) return;
	const Pose2 first = contents.odometry[odometry_before].T;
	if ((first.p - start.p).norm() < 1) return;
	for (size_t i = odometry_before; i < contents.odometry.size(); ++i)
		contents.odometry[i].T = start * between(first, contents.odometry[i].T);
}

std::optional<Pose2> odometryAt(const std::vector<StampedPose2>& odometry, int64_t t_ns, size_t& hint)
{
	while (hint < odometry.size() && odometry[hint].t_ns < t_ns) ++hint;
	if (hint < odometry.size() && odometry[hint].t_ns == t_ns) return odometry[hint].T;
	const auto near = [&](const StampedPose2& o) { return std::abs(secondsBetween(o.t_ns, t_ns)) <= 0.5 * kOdometryGap_s; };
	if (hint == 0) return !odometry.empty() && near(odometry.front()) ? std::optional<Pose2>(odometry.front().T) : std::nullopt;
	// Behind the last reading the motion of the last interval goes on.
	const bool beyond = hint == odometry.size();
	if (beyond && (!near(odometry.back()) || odometry.size() < 2)) return std::nullopt;
	const StampedPose2 &a = odometry[beyond ? hint - 2 : hint - 1], &b = odometry[beyond ? hint - 1 : hint];
	const double span_s = secondsBetween(a.t_ns, b.t_ns);
	if (span_s > kOdometryGap_s) return std::nullopt;
	const double s = secondsBetween(a.t_ns, t_ns) / span_s;
	return Pose2(a.T.p + s * (b.T.p - a.T.p), wrapped(a.T.yaw + s * wrapped(b.T.yaw - a.T.yaw)));
}

std::string chosenLabel(const GroundTruthRunOptions& options, const Contents& contents)
{
	const std::string where = options.rawlogs.front();
	std::vector<std::string> labels;
	for (const auto& [label, scans] : contents.scans)
		if (!scans.empty()) labels.push_back(label);
	if (labels.empty())
	{
		const std::string what = options.scan_label.empty() ? "" : " under label " + options.scan_label;
		throw Error(where + ": no usable scans (CObservation2DRangeScan)" + what +
		            "; choose with --scan-label; labels here: " + contents.labels);
	}
	if (labels.size() > 1)
		throw Error(where + ": scans under several labels (" + labels[0] + ", " + labels[1] + "); choose one with --scan-label");
	return labels.front();
}

/** Where the scans are silent for long. */
void addGapNote(Session& session)
{
	size_t gaps = 0;
	double longest_s = 0;
	for (size_t i = 1; i < session.scans.size(); ++i)
	{
		const double gap_s = secondsBetween(session.scans[i - 1].t_ns, session.scans[i].t_ns);
		gaps += gap_s > kScanGap_s;
		longest_s = std::max(longest_s, gap_s);
	}
	if (gaps == 0) return;
	char text[160];
	std::snprintf(text, sizeof text, "%zu times no scan for more than %g s, at most for %.1f s: %s", gaps, kScanGap_s, longest_s,
	              session.has_odometry ? "odometry leads across" : "nothing leads across");
	session.notes.push_back(text);
}

void addNotes(const Contents& contents, Session& session)
{
	const auto note = [&](size_t count, const std::string& what)
	{
		if (count > 0) session.notes.push_back(std::to_string(count) + " " + what);
	};
	note(contents.bad_scans, "scans without beams, aperture or a finite sensor pose were left out");
	note(contents.bad_ranges, "ranges are no numbers (NaN): taken as beams without return");
	note(contents.late, "observations whose stamps do not increase were left out");
	note(contents.bad_odometry, "odometry readings that are not finite or whose stamps do not increase were left out");
	size_t blind = 0;
	for (const Scan& scan : session.scans) blind += std::none_of(scan.ranges_m.begin(), scan.ranges_m.end(), [](float r) { return r > 0; });
	note(blind, "scans have no valid beam: their poses come from odometry alone");
	addGapNote(session);
	if (!session.has_odometry) session.notes.push_back("no odometry: the guess for each scan is that of constant velocity");
}
}  // namespace

Session loadSession(const GroundTruthRunOptions& options, const std::function<bool(double)>& proceed)
{
	Contents contents;
	for (size_t i = 0; i < options.rawlogs.size(); ++i)
		read(
		    options.rawlogs[i], options,
		    [&](double f) { return proceed((static_cast<double>(i) + f) / static_cast<double>(options.rawlogs.size())); }, contents);

	Session session;
	session.scan_label = chosenLabel(options, contents);
	session.scans = std::move(contents.scans[session.scan_label]);
	session.has_odometry = contents.odometry.size() > 1;
	size_t hint = 0;
	for (Scan& scan : session.scans) scan.odometry = odometryAt(contents.odometry, scan.t_ns, hint);
	session.has_imu = contents.inertial.integrate(session.scans, session.gyro_bias_rad_s);
	session.range_noise_m = options.options.scan.range_noise_m > 0 ? options.options.scan.range_noise_m : rangeNoise_m(session.scans);
	addNotes(contents, session);
	return session;
}
}  // namespace viwo::gt
