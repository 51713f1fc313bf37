#include "StampOrder.h"

#include <mrpt/obs/CObservationImage.h>
#include <viwo/core/Time.h>
#include <viwo/rawlog/MrptTime.h>

#include <algorithm>
#include <limits>

namespace viwo
{
void StampOrder::push(const mrpt::obs::CObservation::Ptr& observation)
{
	const int64_t t_ns = nanosecondsOf(observation->timestamp);
	if (pushed_++ == 0) newest_ns_ = first_t_ns_ = written_until_ns_ = t_ns;
	if (t_ns < newest_ns_) ++out_of_order_;
	if (written_ > 0 && t_ns < written_until_ns_) ++late_;
	newest_ns_ = std::max(newest_ns_, t_ns);
	first_t_ns_ = std::min(first_t_ns_, t_ns);
	const bool is_image = dynamic_cast<const mrpt::obs::CObservationImage*>(observation.get()) != nullptr;
	waiting_.emplace(std::pair(t_ns, is_image), observation);
	writeUntil(newest_ns_ - nanoseconds(span_s_));
}

void StampOrder::finish()
{
	writeUntil(std::numeric_limits<int64_t>::max());
}

void StampOrder::writeUntil(int64_t t_ns)
{
	while (!waiting_.empty() && waiting_.begin()->first.first <= t_ns)
	{
		writer_.write(*waiting_.begin()->second);
		written_until_ns_ = std::max(written_until_ns_, waiting_.begin()->first.first);
		++written_;
		waiting_.erase(waiting_.begin());
	}
}
}  // namespace viwo
