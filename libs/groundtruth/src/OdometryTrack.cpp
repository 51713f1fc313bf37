#include "OdometryTrack.h"

#include <viwo/core/Ranking.h>
#include <viwo/core/Scalars.h>
#include <viwo/core/Time.h>

#include <algorithm>

namespace viwo::gt
{
namespace
{
constexpr double kGap_s = 1.0;
constexpr double kOnEarth_m = 1e7;
/** Quantisation, jitter of stamps, a push: steps below this are never called impossible. */
constexpr double kSlack_m = 0.3, kSlack_rad = 20 * kDegree;
/** Times the speed that is exceeded in a twentieth of the steps only; whatever that is, these bounds hold. */
constexpr double kFactor = 3, kUsual = 0.95;
constexpr double kSlowest_m_s = 2, kFastest_m_s = 10, kSlowest_rad_s = 120 * kDegree, kFastest_rad_s = 540 * kDegree;
constexpr size_t kSpike = 5;  //!< readings in a row that may be wrong at once
constexpr double kSameOrigin_m = 1;

double quantile(std::vector<double> values, double fraction)
{
	return valueAtRank(values, static_cast<size_t>(fraction * static_cast<double>(values.size() - 1)));
}
}  // namespace

void OdometryTrack::add(int64_t t_ns, const Pose2& T)
{
	const bool on_earth = T.p.allFinite() && std::isfinite(T.yaw) && T.p.cwiseAbs().maxCoeff() < kOnEarth_m;
	if (!on_earth || (!readings_.empty() && t_ns <= readings_.back().t_ns))
		++left_out_;
	else
		readings_.push_back({t_ns, Pose2(T.p, wrapped(T.yaw))});
}

void OdometryTrack::beginFile()
{
	file_begins_.push_back(readings_.size());
}

void OdometryTrack::joinFiles()
{
	for (const size_t begin : file_begins_)
	{
		if (begin == 0 || begin >= readings_.size()) continue;
		const Pose2 start = readings_[begin - 1].T, first = readings_[begin].T;
		if ((first.p - start.p).norm() < kSameOrigin_m) continue;
		for (size_t i = begin; i < readings_.size(); ++i) readings_[i].T = start * between(first, readings_[i].T);
	}
}

OdometryTrack::Limits OdometryTrack::limits() const
{
	std::vector<double> periods, speeds, turns;
	for (size_t i = 1; i < readings_.size(); ++i) periods.push_back(secondsBetween(readings_[i - 1].t_ns, readings_[i].t_ns));
	Limits limits{};
	limits.period_s = quantile(periods, 0.5);
	for (size_t i = 1; i < readings_.size(); ++i)
	{
		const Pose2 step = between(readings_[i - 1].T, readings_[i].T);
		const double dt_s = std::max(periods[i - 1], limits.period_s);
		speeds.push_back(step.p.norm() / dt_s);
		turns.push_back(std::abs(step.yaw) / dt_s);
	}
	limits.speed_m_s = std::clamp(kFactor * quantile(speeds, kUsual), kSlowest_m_s, kFastest_m_s);
	limits.turn_rad_s = std::clamp(kFactor * quantile(turns, kUsual), kSlowest_rad_s, kFastest_rad_s);
	return limits;
}

bool OdometryTrack::possible(const Reading& a, const Reading& b, const Limits& limits) const
{
	// Stamps may be repaired or jitter: a step has the usual time at least.
	const double dt_s = std::max(secondsBetween(a.t_ns, b.t_ns), limits.period_s);
	const Pose2 step = between(a.T, b.T);
	return step.p.norm() < kSlack_m + limits.speed_m_s * dt_s && std::abs(step.yaw) < kSlack_rad + limits.turn_rad_s * dt_s;
}

/** The reading after k with which the track leaps back to where it was; k where it does not within a few readings. */
size_t OdometryTrack::backFromSpike(size_t last_good, size_t k, const Limits& limits) const
{
	for (size_t m = k + 1; m < std::min(readings_.size(), k + 1 + kSpike); ++m)
		if (!possible(readings_[m - 1], readings_[m], limits) && possible(readings_[last_good], readings_[m], limits)) return m;
	return k;
}

Pose2 OdometryTrack::constantVelocity(const std::vector<Reading>& kept, int64_t t_ns) const
{
	const Reading& last = kept.back();
	const double now_s = secondsBetween(last.t_ns, t_ns);
	if (kept.size() < 2 || now_s > kGap_s) return last.T;
	const Reading& before = kept[kept.size() - 2];
	const double ratio = now_s / secondsBetween(before.t_ns, last.t_ns);
	const Pose2 step = between(before.T, last.T);
	return ratio < 10 ? last.T * Pose2(step.p * ratio, step.yaw * ratio) : last.T;
}

void OdometryTrack::clean()
{
	joinFiles();
	if (readings_.size() < 2) return;
	const Limits limit = limits();
	std::vector<Reading> kept{readings_.front()};
	size_t last_good = 0;
	Pose2 T_kept_raw;  // what the readings count from, in the track that is kept
	for (size_t k = 1; k < readings_.size(); ++k)
	{
		const Reading& raw = readings_[k];
		if (!possible(readings_[last_good], raw, limit))
		{
			const size_t back = backFromSpike(last_good, k, limit);
			left_out_ += back - k;
			if (back > k)
			{
				k = back - 1;
				continue;
			}
			const Pose2 step = between(readings_[last_good].T, raw.T);
			largest_m_ = std::max(largest_m_, step.p.norm());
			largest_rad_ = std::max(largest_rad_, std::abs(step.yaw));
			++jumps_;
			T_kept_raw = constantVelocity(kept, raw.t_ns) * raw.T.inverse();
		}
		kept.push_back({raw.t_ns, jumps_ > 0 ? T_kept_raw * raw.T : raw.T, jumps_});
		last_good = k;
	}
	useless_ = 2 * jumps_ > readings_.size();
	readings_ = useless_ ? std::vector<Reading>() : std::move(kept);
}

std::optional<OdometryTrack::Reading> OdometryTrack::at(int64_t t_ns)
{
	while (hint_ < readings_.size() && readings_[hint_].t_ns < t_ns) ++hint_;
	if (hint_ < readings_.size() && readings_[hint_].t_ns == t_ns) return readings_[hint_];
	const auto near = [&](const Reading& o) { return std::abs(secondsBetween(o.t_ns, t_ns)) <= 0.5 * kGap_s; };
	if (hint_ == 0) return !readings_.empty() && near(readings_.front()) ? std::optional<Reading>(readings_.front()) : std::nullopt;
	// Behind the last reading the motion of the last interval goes on.
	const bool beyond = hint_ == readings_.size();
	if (beyond && (!near(readings_.back()) || readings_.size() < 2)) return std::nullopt;
	const Reading &a = readings_[beyond ? hint_ - 2 : hint_ - 1], &b = readings_[beyond ? hint_ - 1 : hint_];
	const double span_s = secondsBetween(a.t_ns, b.t_ns);
	if (span_s > kGap_s) return std::nullopt;
	const double s = secondsBetween(a.t_ns, t_ns) / span_s;
	return Reading{t_ns, Pose2(a.T.p + s * (b.T.p - a.T.p), wrapped(a.T.yaw + s * wrapped(b.T.yaw - a.T.yaw))), b.jumps};
}
}  // namespace viwo::gt
