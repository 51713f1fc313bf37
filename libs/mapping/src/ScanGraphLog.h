#pragma once

#include <mrpt/core/format.h>
#include <viwo/core/AtomicFile.h>
#include <viwo/mapping/RayScan.h>

namespace viwo
{
/** Scans as octomap's log2graph reads them: a line `NODE x y z roll pitch yaw` for the sensor, here without rotation, and a line `x y z`
 * for each hit as seen from there. Clearing rays have no place in the format.
 */
class ScanGraphLog
{
   public:
	explicit ScanGraphLog(const std::string& path) : file_(path) {}

	void add(const RayScan& scan)
	{
		if (scan.hits.empty()) return;
		const octomap::point3d& origin = scan.hits.front().origin;
		line("NODE ", origin, " 0 0 0\n");
		for (const Ray& ray : scan.hits) line("", ray.end - origin, "\n");
	}

	AtomicFile& file() { return file_; }

   private:
	void line(const char* before, const octomap::point3d& p, const char* after)
	{
		file_.stream() << before
		               << mrpt::format("%.9g %.9g %.9g", static_cast<double>(p.x()), static_cast<double>(p.y()), static_cast<double>(p.z()))
		               << after;
	}

	AtomicFile file_;
};
}  // namespace viwo
