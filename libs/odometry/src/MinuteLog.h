#pragma once

#include <cstddef>
#include <vector>

namespace viwo
{
/** Frames of each minute of the log that has some, and the memory that the program had at the end of it. */
class MinuteLog
{
   public:
	struct Minute
	{
		size_t number = 0;  //!< since the first frame, from 0
		size_t frames = 0;
		double rss_mb = 0;
	};

	/** @param t_s since the first frame. */
	void addFrame(double t_s);
	const std::vector<Minute>& minutes() const { return minutes_; }

   private:
	std::vector<Minute> minutes_;
};
}  // namespace viwo
