#include "MinuteLog.h"

#include <unistd.h>

#include <algorithm>
#include <fstream>

namespace viwo
{
namespace
{
/** Resident memory; 0 where the system does not tell. */
double residentMemory_mb()
{
	std::ifstream statm("/proc/self/statm");
	double total_pages = 0, resident_pages = 0;
	statm >> total_pages >> resident_pages;
	return resident_pages * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1024 * 1024);
}
}  // namespace

void MinuteLog::addFrame(double t_s)
{
	const size_t number = static_cast<size_t>(std::max(0.0, t_s) / 60);
	if (minutes_.empty() || minutes_.back().number != number) minutes_.push_back({number, 0, 0});
	++minutes_.back().frames;
	minutes_.back().rss_mb = residentMemory_mb();
}
}  // namespace viwo
