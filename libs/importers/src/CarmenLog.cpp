#include "CarmenLog.h"

#include "CsvFile.h"
#include "TextLines.h"

#include <viwo/core/Error.h>
#include <viwo/core/Scalars.h>
#include <viwo/core/TimeText.h>

#include <cmath>

namespace viwo
{
namespace
{
/** A SICK LMS reports errors and "no return" as 81.83 m and more. */
constexpr double kMaxRange_m = 80;

struct LaserParameters
{
	double front_offset_m = 0, rear_offset_m = 0, max_range_m = kMaxRange_m;
};

/** The words of one line, read from left to right. */
class Words
{
   public:
	Words(const std::string& line, std::string where) : words_(splitWords(line)), where_(std::move(where)) {}

	const std::string& kind() const { return words_.front(); }
	bool empty() const { return words_.empty() || words_.front()[0] == '#'; }
	size_t left() const { return words_.size() - next_; }
	void skip(size_t count)
	{
		need(count);
		next_ += count;
	}
	double number()
	{
		need(1);
		return parseNumber(words_[next_++], where_);
	}
	size_t count()
	{
		const double n = number();
		if (n < 0 || n > 1e5 || n != std::floor(n)) throw Error(where_ + ": '" + words_[next_ - 1] + "' is not a number of readings");
		need(static_cast<size_t>(n));
		return static_cast<size_t>(n);
	}
	CarmenPose pose()
	{
		const double x = number(), y = number(), yaw = number();
		return {x, y, yaw};
	}
	std::string word()
	{
		need(1);
		return words_[next_++];
	}
	/** The time of the robot: third word from the end. */
	const std::string& stamp() const
	{
		need(3);
		return words_[words_.size() - 3];
	}
	int64_t stamp_ns() const
	{
		const auto t_ns = parseSeconds(stamp());
		if (!t_ns) throw Error(where_ + ": '" + stamp() + "', third word from the end, is not a time in seconds");
		return *t_ns;
	}

   private:
	void need(size_t count) const
	{
		if (left() < count) throw Error(where_ + ": " + kind() + " line ends too early; copy the log again or remove the line");
	}

	std::vector<std::string> words_;
	std::string where_;
	size_t next_ = 1;
};

std::vector<float> ranges(Words& words)
{
	std::vector<float> ranges_m(words.count());
	for (float& range : ranges_m) range = static_cast<float>(words.number());
	return ranges_m;
}

double stepOf(size_t beams)
{
	if (beams == 180 || beams == 181) return kDegree;
	if (beams == 360 || beams == 361) return 0.5 * kDegree;
	return beams > 1 ? M_PI / static_cast<double>(beams - 1) : 0;
}

CarmenScan readLaser(Words& words, const LaserParameters& parameters)
{
	CarmenScan scan;
	scan.ranges_m = ranges(words);
	scan.first_angle_rad = -0.5 * M_PI;
	scan.step_rad = stepOf(scan.ranges_m.size());
	scan.max_range_m = parameters.max_range_m;
	words.skip(3);  // the laser's pose: odometry carried to the laser, or a corrected pose
	scan.odometry = words.pose();
	scan.T_OL = words.kind() == "RLASER" ? CarmenPose(parameters.rear_offset_m, 0, M_PI) : CarmenPose(parameters.front_offset_m, 0, 0);
	return scan;
}

CarmenScan readRobotLaser(Words& words)
{
	CarmenScan scan;
	words.skip(1);  // type
	scan.first_angle_rad = words.number();
	words.skip(1);  // field of view: follows from the number of readings
	scan.step_rad = words.number();
	scan.max_range_m = words.number();
	words.skip(2);  // accuracy, remission mode
	scan.ranges_m = ranges(words);
	words.skip(words.count());  // remissions
	const CarmenPose laser = words.pose();
	scan.odometry = words.pose();
	const double c = std::cos(scan.odometry.z()), s = std::sin(scan.odometry.z());
	const double dx = laser.x() - scan.odometry.x(), dy = laser.y() - scan.odometry.y();
	scan.T_OL = {c * dx + s * dy, -s * dx + c * dy, std::remainder(laser.z() - scan.odometry.z(), 2 * M_PI)};
	return scan;
}

void readParameter(Words& words, LaserParameters& parameters)
{
	const std::string name = words.left() > 0 ? words.word() : "";
	if (name == "robot_frontlaser_offset") parameters.front_offset_m = words.number();
	if (name == "robot_rearlaser_offset") parameters.rear_offset_m = words.number();
	if (name == "robot_front_laser_max") parameters.max_range_m = words.number();
}
}  // namespace

CarmenLog readCarmenLog(const std::string& path)
{
	CarmenLog log;
	LaserParameters parameters;
	size_t line_number = 0, carmen_lines = 0;
	const std::vector<std::string> lines = readTextLines(path);
	if (lines.empty()) throw Error(path + ": the file is empty; record or copy it again");
	for (const std::string& line : lines)
	{
		Words words(line, path + ":" + std::to_string(++line_number));
		if (words.empty()) continue;
		const std::string& kind = words.kind();
		if (kind == "PARAM")
			readParameter(words, parameters);
		else if (kind == "ODOM")
		{
			const CarmenPose pose = words.pose();
			log.odometry.push_back({words.stamp_ns(), pose});
		}
		else if (kind == "FLASER" || kind == "RLASER" || kind == "ROBOTLASER1")
		{
			CarmenScan scan = kind == "ROBOTLASER1" ? readRobotLaser(words) : readLaser(words, parameters);
			scan.kind = kind;
			scan.stamp = words.stamp();
			scan.t_ns = words.stamp_ns();
			log.scans.push_back(std::move(scan));
		}
		else
		{
			++log.other_lines[kind];
			continue;
		}
		++carmen_lines;
	}
	const std::string no_scan = path + ": no FLASER, RLASER or ROBOTLASER1 line; this is not a CARMEN log with scans";
	if (carmen_lines == 0) throw OtherFormat(no_scan);
	if (log.scans.empty()) throw Error(no_scan);
	return log;
}
}  // namespace viwo
