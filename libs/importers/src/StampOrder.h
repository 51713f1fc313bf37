#pragma once

#include <mrpt/obs/CObservation.h>
#include <viwo/rawlog/RawlogWriter.h>

#include <cstddef>
#include <cstdint>
#include <map>

namespace viwo
{
/** Writes observations in the order of their stamps, as far as these come within a span; memory use is that of the span. */
class StampOrder
{
   public:
	StampOrder(RawlogWriter& writer, double span_s) : writer_(writer), span_s_(span_s) {}

	void push(const mrpt::obs::CObservation::Ptr& observation);
	/** Nothing follows. */
	void finish();

	size_t written() const { return written_; }
	size_t outOfOrder() const { return out_of_order_; }  //!< that came after one with a later stamp
	size_t late() const { return late_; }                //!< of these, so late that they stand in the rawlog out of order
	int64_t first_t_ns() const { return first_t_ns_; }
	int64_t last_t_ns() const { return newest_ns_; }

   private:
	void writeUntil(int64_t t_ns);

	RawlogWriter& writer_;
	double span_s_;
	/** By stamp; at the same stamp in the order of arrival, but images last: an estimator processes an image with what it has till then. */
	std::multimap<std::pair<int64_t, bool>, mrpt::obs::CObservation::Ptr> waiting_;
	int64_t newest_ns_ = 0, written_until_ns_ = 0, first_t_ns_ = 0;
	size_t pushed_ = 0, written_ = 0, out_of_order_ = 0, late_ = 0;
};
}  // namespace viwo
