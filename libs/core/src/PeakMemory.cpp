#include <sys/resource.h>
#include <viwo/core/PeakMemory.h>

namespace viwo
{
double peakMemory_mb()
{
	rusage usage{};
	getrusage(RUSAGE_SELF, &usage);
	return static_cast<double>(usage.ru_maxrss) / 1024;
}
}  // namespace viwo
