#include "KittiOxts.h"

#include "CsvFile.h"

#include <mrpt/core/format.h>
#include <viwo/core/Error.h>
#include <viwo/core/NumberText.h>
#include <viwo/core/Scalars.h>
#include <viwo/core/Time.h>
#include <viwo/core/TimeText.h>

#include <cmath>
#include <ctime>
#include <filesystem>
#include <fstream>

namespace viwo
{
namespace
{
namespace fs = std::filesystem;
constexpr double kEarthRadius_m = 6378137;
/** Up to wu, the last field of interest to anybody here. */
constexpr size_t kOxtsFields = 23;

Eigen::Vector3d mercator(const OxtsPacket& packet, double scale)
{
	return {scale * kEarthRadius_m * packet.longitude_deg * kDegree,
	        scale * kEarthRadius_m * std::log(std::tan((90 + packet.latitude_deg) * kDegree / 2)), packet.altitude_m};
}
}  // namespace

int64_t parseDateTime(const std::string& text, const std::string& where)
{
	std::tm time = {};
	int length = 0;
	const int count = std::sscanf(text.c_str(), "%4d-%2d-%2d %2d:%2d:%2d%n", &time.tm_year, &time.tm_mon, &time.tm_mday, &time.tm_hour,
	                              &time.tm_min, &time.tm_sec, &length);
	const std::string rest = count == 6 ? text.substr(static_cast<size_t>(length)) : "";
	const auto fraction_ns = rest.empty() || rest[0] == '.' ? parseSeconds("0" + rest) : std::nullopt;
	if (count != 6 || !fraction_ns) throw Error(where + ": '" + text + "' is not a time like 2011-09-26 14:05:35.550923000");
	time.tm_year -= 1900;
	time.tm_mon -= 1;
	return static_cast<int64_t>(timegm(&time)) * nanoseconds(1) + *fraction_ns;
}

std::vector<KittiFrame> readKittiFrames(const std::string& folder, const std::string& extension, size_t& missing)
{
	const std::string list = (fs::path(folder) / "timestamps.txt").string();
	std::ifstream file(list);
	if (!file) throw Error(list + ": cannot be read; check that the folder is a drive in KITTI's raw layout");
	std::vector<KittiFrame> frames;
	missing = 0;
	size_t line_number = 0;
	for (std::string line; std::getline(file, line); ++line_number)
	{
		while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
		if (line.empty()) continue;
		const std::string where = list + ":" + std::to_string(line_number + 1);
		const fs::path path = fs::path(folder) / "data" / (mrpt::format("%010zu.", line_number) + extension);
		const int64_t t_ns = parseDateTime(line, where);
		std::error_code ignored;
		if (!fs::is_regular_file(path, ignored))
		{
			++missing;
			continue;
		}
		if (!frames.empty() && t_ns <= frames.back().t_ns) throw Error(where + ": stamp not later than that of the frame before");
		frames.push_back({t_ns, path.string()});
	}
	if (frames.empty()) throw Error((fs::path(folder) / "data").string() + ": none of the files that timestamps.txt lists is there");
	return frames;
}

OxtsPacket readOxtsPacket(const KittiFrame& frame)
{
	std::ifstream file(frame.path);
	std::string line;
	if (!file || !std::getline(file, line)) throw Error(frame.path + ": cannot be read, or it is empty");
	const auto words = splitWords(line);
	if (words.size() < kOxtsFields)
		throw Error(frame.path + ":1: " + counted(words.size(), "number") + " instead of at least " + std::to_string(kOxtsFields) +
		            " (lat lon alt ... wu)");
	double v[kOxtsFields];
	for (size_t i = 0; i < kOxtsFields; ++i) v[i] = parseNumber(words[i], frame.path + ":1");

	OxtsPacket packet;
	packet.t_ns = frame.t_ns;
	packet.latitude_deg = v[0], packet.longitude_deg = v[1], packet.altitude_m = v[2];
	packet.roll_rad = v[3], packet.pitch_rad = v[4], packet.yaw_rad = v[5];
	packet.twist = {v[8], v[19]};
	packet.imu = {frame.t_ns, {v[11], v[12], v[13]}, {v[17], v[18], v[19]}};
	return packet;
}

Pose3 poseOf(const OxtsPacket& packet, const OxtsPacket& first)
{
	const double scale = std::cos(first.latitude_deg * kDegree);
	const Eigen::Quaterniond R = Eigen::AngleAxisd(packet.yaw_rad, Eigen::Vector3d::UnitZ()) *
	                             Eigen::AngleAxisd(packet.pitch_rad, Eigen::Vector3d::UnitY()) *
	                             Eigen::AngleAxisd(packet.roll_rad, Eigen::Vector3d::UnitX());
	return {R, mercator(packet, scale) - mercator(first, scale)};
}
}  // namespace viwo
