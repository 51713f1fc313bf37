#pragma once

#include <cstdint>
#include <deque>

namespace viwo
{
/** The newest stamp of all streams, and the holes in it: times without data of any sensor that are too long to be filled with poses. */
class StreamClock
{
   public:
	/** @param longest_fill_s how far into a hole frames without data are still made. */
	explicit StreamClock(double longest_fill_s) : longest_fill_s_(longest_fill_s) {}

	void advance(int64_t t_ns);
	int64_t now_ns() const { return now_ns_; }

	/** The time itself, or the end of the hole in which it lies too deep. Times are asked for in increasing order. */
	int64_t pastHoles(int64_t t_ns);

   private:
	struct Hole
	{
		int64_t begin_ns, end_ns;
	};

	double longest_fill_s_;
	bool started_ = false;
	int64_t now_ns_ = 0;
	std::deque<Hole> holes_;  //!< not yet passed
};
}  // namespace viwo
