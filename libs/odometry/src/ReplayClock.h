#pragma once

#include <functional>
#include <optional>
#include <string>

namespace viwo
{
/** Where a replay's time comes from. */
struct ReplayTime
{
	std::function<double()> now_s;
	std::function<void(double seconds)> sleep;

	/** The machine's steady clock. */
	static ReplayTime steady();
};

/** Hands a log on by the log's clock: what is early waits, what is late is not dropped, but said. Begins with the first waitFor(). */
class ReplayClock
{
   public:
	/** @param speed times the log's clock; 0: as fast as it goes, then only the time is taken. */
	explicit ReplayClock(double speed, ReplayTime time = ReplayTime::steady());

	/** Waits until a time of the log has come; ends early when `stop` says so. @param log_s since the beginning of the replay.
	 *  @return a remark where the replay fell behind real time, or has caught up. */
	std::optional<std::string> waitFor(double log_s, const std::function<bool()>& stop);

	/** How much later than due the last observation was handed on, in s of the machine's clock. */
	double lag_s() const { return lag_s_; }
	double largestLag_s() const { return largest_lag_s_; }
	/** Time of the log per time of the machine, since the beginning. */
	double speed() const;

   private:
	std::optional<std::string> judged();

	double speed_;
	ReplayTime time_;
	std::optional<double> begin_s_;
	double log_s_ = 0, lag_s_ = 0, largest_lag_s_ = 0;
	bool behind_ = false;
};
}  // namespace viwo
