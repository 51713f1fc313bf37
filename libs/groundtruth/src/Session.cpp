#include "Session.h"

#include "InertialYaw.h"
#include "OdometryTrack.h"
#include "RangeNoise.h"

#include <mrpt/core/format.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <viwo/core/Error.h>
#include <viwo/core/MrptPose.h>
#include <viwo/core/Scalars.h>
#include <viwo/core/Time.h>
#include <viwo/rawlog/MrptTime.h>
#include <viwo/rawlog/RawlogReader.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace viwo::gt
{
namespace
{
using mrpt::obs::CObservation2DRangeScan;

constexpr double kScanGap_s = 1.0;
constexpr double kOnRobot_m = 100;  //!< farther away from O no sensor sits
constexpr size_t kFewBeams = 30;
const char* const kUsualOdometry = "ODOMETRY";
const char* const kUsualImu = "IMU";

/** Everything of use in the rawlogs, before labels are chosen. */
struct Contents
{
	std::map<std::string, std::vector<Scan>> scans;
	OdometryTrack odometry;
	InertialYaw inertial;
	std::set<std::string> odometry_labels, imu_labels;
	size_t bad_scans = 0, bad_ranges = 0, late = 0;
	std::string labels;  //!< of everything, for messages
};

bool onRobot(const Pose3& T)
{
	return T.p.allFinite() && T.p.norm() < kOnRobot_m && T.R.coeffs().allFinite();
}

bool wanted(const Scan& scan, size_t beam, double range_m, const ScanOptions& options)
{
	const double angle_rad = scan.first_angle_rad + scan.step_rad * static_cast<double>(beam);
	return range_m >= options.min_range_m && range_m <= options.max_range_m && angle_rad >= options.first_angle_deg * kDegree &&
	       angle_rad <= options.last_angle_deg * kDegree;
}

/** Nothing for a scan that cannot be used: no geometry, or a pose that no sensor has. Beams that the options leave out are invalid. */
std::optional<Scan> convert(const CObservation2DRangeScan& observation, const ScanOptions& options)
{
	const size_t n = observation.getScanSize();
	Scan scan;
	scan.t_ns = nanosecondsOf(observation.timestamp);
	scan.T_OL = fromMrpt(observation.sensorPose);
	if (n < 2 || !(observation.aperture > 0) || !onRobot(scan.T_OL)) return std::nullopt;
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
		scan.ranges_m[i] = valid && wanted(scan, i, static_cast<double>(r), options) ? r : 0;
	}
	return scan;
}

void addScan(const CObservation2DRangeScan& observation, const GroundTruthRunOptions& options, Contents& contents)
{
	if (!options.scan_label.empty() && observation.sensorLabel != options.scan_label) return;
	auto converted = convert(observation, options.options.scan);
	std::vector<Scan>& scans = contents.scans[observation.sensorLabel];
	for (size_t i = 0; i < observation.getScanSize(); ++i) contents.bad_ranges += std::isnan(observation.getScanRange(i));
	if (!converted)
		++contents.bad_scans;
	else if (!scans.empty() && converted->t_ns <= scans.back().t_ns)
		++contents.late;
	else
		scans.push_back(std::move(*converted));
}

std::string odometryLabel(const GroundTruthRunOptions& options)
{
	return options.odometry_label.empty() ? kUsualOdometry : options.odometry_label;
}

std::string imuLabel(const GroundTruthRunOptions& options)
{
	return options.imu_label.empty() ? kUsualImu : options.imu_label;
}

void add(const mrpt::obs::CObservation& o, const GroundTruthRunOptions& options, Contents& contents)
{
	if (const auto* scan = dynamic_cast<const CObservation2DRangeScan*>(&o)) addScan(*scan, options, contents);
	if (const auto* odometry = dynamic_cast<const mrpt::obs::CObservationOdometry*>(&o))
	{
		contents.odometry_labels.insert(odometry->sensorLabel);
		if (odometry->sensorLabel != odometryLabel(options)) return;
		contents.odometry.add(nanosecondsOf(odometry->timestamp),
		                      Pose2(odometry->odometry.x(), odometry->odometry.y(), odometry->odometry.phi()));
	}
	if (const auto* imu = dynamic_cast<const mrpt::obs::CObservationIMU*>(&o))
	{
		contents.imu_labels.insert(imu->sensorLabel);
		if (imu->sensorLabel == imuLabel(options) && options.options.odometry.use_imu) contents.inertial.add(*imu);
	}
}

void read(const std::string& path, const GroundTruthRunOptions& options, const std::function<bool(double)>& proceed, Contents& contents)
{
	RawlogReaderOptions reader_options;
	reader_options.allow_truncated = options.allow_truncated;
	reader_options.skip_missing_images = true;
	reader_options.action_odometry_label = odometryLabel(options);
	RawlogReader reader(path, reader_options);
	contents.odometry.beginFile();
	size_t count = 0;
	while (const auto observation = reader.next())
	{
		add(*observation, options, contents);
		if (++count % 256 == 0 && !proceed(reader.progress())) throw Error("interrupted: nothing was written");
	}
	contents.late += reader.counts().late;
	contents.labels += (contents.labels.empty() ? "" : ", ") + reader.counts().describe();
}

/** A label that was asked for and is not there is a slip of the pen: without its sensor the result would be another one. */
void requireLabel(const std::string& label, const std::set<std::string>& there, const std::string& what, const std::string& option,
                  const GroundTruthRunOptions& options, const Contents& contents)
{
	if (label.empty() || there.count(label) > 0) return;
	throw Error(options.rawlogs.front() + ": no " + what + " under label " + label + "; correct " + option +
	            ", or leave it out; labels here: " + contents.labels);
}

/** Sensors under unusual labels, which a run without the option does not use. */
void noteUnused(const std::string& label, const char* usual, const std::set<std::string>& there, const std::string& what,
                const std::string& option, std::vector<std::string>& notes)
{
	if (!label.empty() || there.empty() || there.count(usual) > 0) return;
	notes.push_back(what + " under label " + *there.begin() + " is not used: choose it with " + option);
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
	session.notes.push_back(mrpt::format("%zu times no scan for more than %g s, at most for %.1f s: %s", gaps, kScanGap_s, longest_s,
	                                     session.has_odometry ? "odometry leads across" : "nothing leads across"));
}

void addOdometryNotes(const OdometryTrack& odometry, Session& session)
{
	if (odometry.useless())
		session.notes.push_back(
		    mrpt::format("odometry is not used: most of its steps (%zu, up to %.3g m and %.0f deg) are none that a robot drives",
		                 odometry.jumps(), odometry.largestJump_m(), odometry.largestJump_rad() / kDegree));
	else if (odometry.jumps() > 0)
		session.notes.push_back(
		    mrpt::format("odometry leapt %zu times as no robot drives, by up to %.3g m and %.0f deg: these steps were left out",
		                 odometry.jumps(), odometry.largestJump_m(), odometry.largestJump_rad() / kDegree));
	if (!session.has_odometry) session.notes.push_back("no odometry: the guess for each scan is that of constant velocity");
}

void addNotes(const Contents& contents, size_t noise, Session& session)
{
	const auto note = [&](size_t count, const std::string& what)
	{
		if (count > 0) session.notes.push_back(std::to_string(count) + " " + what);
	};
	note(contents.bad_scans, "scans without beams, without aperture or with a sensor pose that is none were left out");
	note(contents.bad_ranges, "ranges are no numbers (NaN): taken as beams without return");
	note(contents.late, "observations whose stamps do not increase were left out");
	note(contents.odometry.leftOut(), "odometry readings that are wild, no numbers or whose stamps do not increase were left out");
	note(contents.inertial.leftOut(), "gyroscope readings that are wild or no numbers were left out");
	note(noise, "scans are noise, no surface in them: they are not used");
	size_t blind = 0, few = 0;
	for (const Scan& scan : session.scans)
	{
		blind += std::none_of(scan.ranges_m.begin(), scan.ranges_m.end(), [](float r) { return r > 0; });
		few += scan.ranges_m.size() < kFewBeams;
	}
	note(blind - noise, "scans have no valid beam: their poses come from odometry alone");
	note(few, "scans have fewer than " + std::to_string(kFewBeams) + " beams: hardly enough to tell where they were taken");
	addGapNote(session);
	addOdometryNotes(contents.odometry, session);
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
	requireLabel(options.odometry_label, contents.odometry_labels, "odometry (CObservationOdometry)", "--odometry-label", options,
	             contents);
	requireLabel(options.imu_label, contents.imu_labels, "IMU (CObservationIMU)", "--imu-label", options, contents);
	noteUnused(options.odometry_label, kUsualOdometry, contents.odometry_labels, "odometry", "--odometry-label", session.notes);
	noteUnused(options.imu_label, kUsualImu, contents.imu_labels, "an IMU", "--imu-label", session.notes);
	session.scans = std::move(contents.scans[session.scan_label]);
	contents.odometry.clean();
	session.has_odometry = contents.odometry.size() > 1;
	session.odometry_jumps = contents.odometry.jumps();
	session.odometry_left_out = contents.odometry.leftOut();
	for (Scan& scan : session.scans)
	{
		const auto reading = contents.odometry.at(scan.t_ns);
		if (!reading) continue;
		scan.odometry = reading->T;
		scan.odometry_jumps = reading->jumps;
	}
	session.has_imu = contents.inertial.integrate(session.scans, session.gyro_bias_rad_s);
	session.range_noise_m = options.options.scan.range_noise_m > 0 ? options.options.scan.range_noise_m : rangeNoise_m(session.scans);
	const size_t noise = blankNoise(session.scans, session.range_noise_m);
	addNotes(contents, noise, session);
	return session;
}
}  // namespace viwo::gt
