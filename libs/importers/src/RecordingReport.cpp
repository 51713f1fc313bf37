#include <mrpt/core/format.h>
#include <viwo/core/Time.h>
#include <viwo/core/TimeText.h>
#include <viwo/importers/RecordingInfo.h>

#include <algorithm>

namespace viwo
{
namespace
{
/** Slower than this an IMU cannot be integrated between images with errors that its noise describes. */
constexpr double kMinImuRate_hz = 50;

struct Use
{
	const char* name;
	std::vector<SensorRole> needed;
};

const char* nameOf(SensorRole role)
{
	switch (role)
	{
		case SensorRole::camera:
			return "images";
		case SensorRole::imu:
			return "an IMU";
		case SensorRole::wheels:
			return "wheel odometry";
		case SensorRole::lidar:
			return "2D scans";
		case SensorRole::gps:
			return "GPS fixes";
		case SensorRole::truth:
			return "a ground truth";
		case SensorRole::other:
			break;
	}
	return "other";
}

const StreamInfo* find(const RecordingInfo& info, SensorRole role)
{
	const StreamInfo* found = nullptr;
	for (const StreamInfo& stream : info.streams)
		if (stream.role == role && (found == nullptr || (!found->remark.empty() && stream.remark.empty()))) found = &stream;
	return found;
}

std::string verdict(const RecordingInfo& info, const Use& use)
{
	std::string missing, remarks;
	for (const SensorRole role : use.needed)
	{
		const StreamInfo* stream = find(info, role);
		if (stream == nullptr)
			missing += (missing.empty() ? "" : ", ") + std::string(nameOf(role));
		else if (!stream->remark.empty())
			remarks += "; " + stream->name + " " + stream->remark;
		else if (role == SensorRole::camera && !stream->calibrated)
			remarks += "; the calibration of " + stream->name + " is missing";
		else if (role == SensorRole::imu && stream->rate_hz < kMinImuRate_hz)
			remarks += "; " + stream->name + " is slow, set its noise high";
	}
	return missing.empty() ? "yes" + remarks : "no, without " + missing;
}
}  // namespace

std::string describeRecording(const RecordingInfo& info)
{
	std::string text = info.path + ": " + info.kind + "\n";
	int64_t first_ns = 0, last_ns = 0;
	size_t width = 5, type_width = 5;
	for (const StreamInfo& stream : info.streams)
	{
		width = std::max(width, stream.name.size()), type_width = std::max(type_width, stream.type.size());
		first_ns = first_ns == 0 ? stream.first_t_ns : std::min(first_ns, stream.first_t_ns);
		last_ns = std::max(last_ns, stream.last_t_ns);
	}
	text += mrpt::format("from %s to %s s: %.3f s\n\n", formatSeconds(first_ns).c_str(), formatSeconds(last_ns).c_str(),
	                     secondsBetween(first_ns, last_ns));
	text += mrpt::format("%-*s  %-*s  %8s  %8s  %9s  %9s  %9s  %9s  %9s\n", static_cast<int>(width), "name", static_cast<int>(type_width),
	                     "type", "count", "rate Hz", "jitter ms", "gap s", "back", "from s", "to s");
	for (const StreamInfo& stream : info.streams)
	{
		text += mrpt::format("%-*s  %-*s  %8zu  %8.2f  %9.3f  %9.3f  %9zu  %9.3f  %9.3f\n", static_cast<int>(width), stream.name.c_str(),
		                     static_cast<int>(type_width), stream.type.c_str(), stream.count, stream.rate_hz, stream.jitter_s * 1e3,
		                     stream.largest_gap_s, stream.backwards, secondsBetween(first_ns, stream.first_t_ns),
		                     secondsBetween(first_ns, stream.last_t_ns));
	}
	text += "\nsuffices for\n";
	using Role = SensorRole;
	for (const Use& use :
	     {Use{"--mode wheel", {Role::wheels}}, Use{"--mode wio", {Role::wheels, Role::imu}}, Use{"--mode vio", {Role::camera, Role::imu}},
	      Use{"--mode viwo", {Role::camera, Role::imu, Role::wheels}}, Use{"viwo-groundtruth", {Role::lidar, Role::wheels}}})
		text += mrpt::format("  %-16s  %s\n", use.name, verdict(info, use).c_str());
	for (const std::string& note : info.notes) text += "note: " + note + "\n";
	return text;
}
}  // namespace viwo
