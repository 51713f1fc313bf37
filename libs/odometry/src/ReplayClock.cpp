#include "ReplayClock.h"

#include <mrpt/core/format.h>

#include <algorithm>
#include <chrono>
#include <thread>

namespace viwo
{
namespace
{
constexpr double kLongestSleep_s = 0.1;  // a gap of the log may be hours, and the user may want to stop
constexpr double kBehind_s = 0.5, kCaughtUp_s = 0.1;
}  // namespace

ReplayTime ReplayTime::steady()
{
	using Seconds = std::chrono::duration<double>;
	return {[] { return Seconds(std::chrono::steady_clock::now().time_since_epoch()).count(); },
	        [](double seconds) { std::this_thread::sleep_for(Seconds(seconds)); }};
}

ReplayClock::ReplayClock(double speed, ReplayTime time) : speed_(speed), time_(std::move(time)) {}

std::optional<std::string> ReplayClock::waitFor(double log_s, const std::function<bool()>& stop)
{
	if (!begin_s_) begin_s_ = time_.now_s() - (speed_ > 0 ? log_s / speed_ : 0);
	log_s_ = log_s;
	if (speed_ <= 0) return std::nullopt;
	const double due_s = *begin_s_ + log_s / speed_;
	lag_s_ = std::max(0.0, time_.now_s() - due_s);
	largest_lag_s_ = std::max(largest_lag_s_, lag_s_);
	for (double left_s = due_s - time_.now_s(); left_s > 0 && !stop(); left_s = due_s - time_.now_s())
		time_.sleep(std::min(left_s, kLongestSleep_s));
	return judged();
}

std::optional<std::string> ReplayClock::judged()
{
	const bool was_behind = behind_;
	behind_ = lag_s_ > (behind_ ? kCaughtUp_s : kBehind_s);
	if (behind_ == was_behind) return std::nullopt;
	if (!behind_) return "caught up with real time";
	return mrpt::format("%.1f s behind real time; nothing is dropped", lag_s_);
}

double ReplayClock::speed() const
{
	if (!begin_s_) return 0;
	const double wall_s = time_.now_s() - *begin_s_;
	return wall_s > 0 ? log_s_ / wall_s : 0;
}
}  // namespace viwo
