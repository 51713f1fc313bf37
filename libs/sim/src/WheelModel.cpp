#include <viwo/core/Error.h>
#include <viwo/sim/RandomSource.h>
#include <viwo/sim/WheelModel.h>

#include <algorithm>
#include <cmath>

namespace viwo::sim
{
namespace
{
WheelIntrinsics actualIntrinsics(const WheelOptions& o, uint64_t seed)
{
	std::mt19937_64 generator = randomSource(seed, "wheel intrinsics");
	std::normal_distribution<double> normal;
	const double radius_error = o.radius_error + o.radius_deviation * normal(generator);
	const double difference = o.left_right_difference + o.left_right_deviation * normal(generator);
	const double track_error = o.track_error + o.track_deviation * normal(generator);
	return {1 + radius_error - 0.5 * difference, 1 + radius_error + 0.5 * difference, o.track_m * (1 + track_error)};
}

void requireGroups(const std::vector<double>& list, size_t group, const char* key)
{
	if (list.size() % group != 0)
		throw Error(std::string("[wheels] ") + key + ": expected groups of " + std::to_string(group) + " numbers, found " +
		            std::to_string(list.size()));
}

/** Turns of one wheel, as metres of nominal circumference, read in whole ticks. */
class Encoder
{
   public:
	Encoder(const WheelOptions& o, int64_t start_ticks)
	    : tick_m_(2 * M_PI * o.radius_m / o.ticks_per_revolution), quantised_(o.tick_quantisation), start_ticks_(start_ticks)
	{
	}

	/** Turns on and returns the increment of the reading, in metres of nominal circumference. */
	double advance(double travel_m)
	{
		const double before_m = read_m();
		turned_m_ += travel_m;
		return read_m() - before_m;
	}

	int64_t ticks() const { return start_ticks_ + static_cast<int64_t>(std::floor(turned_m_ / tick_m_)); }

   private:
	double read_m() const { return quantised_ ? tick_m_ * std::floor(turned_m_ / tick_m_) : turned_m_; }

	double tick_m_;
	bool quantised_;
	int64_t start_ticks_;
	double turned_m_ = 0;
};

void deadReckon(WheelReading& reading, double v_dt_m, double w_dt_rad)
{
	// Along an arc: chord of half the angle.
	const double half = 0.5 * w_dt_rad, chord_m = std::abs(half) < 1e-9 ? v_dt_m : v_dt_m * std::sin(half) / half;
	reading.x_m += chord_m * std::cos(reading.yaw_rad + half);
	reading.y_m += chord_m * std::sin(reading.yaw_rad + half);
	reading.yaw_rad += w_dt_rad;
}
}  // namespace

WheelOptions WheelOptions::perfect()
{
	WheelOptions o;
	o.tick_quantisation = false;
	o.radius_error = o.left_right_difference = o.track_error = 0;
	o.noise_m_s_sqrtHz = o.noise_per_speed_sqrtHz = 0;
	return o;
}

WheelModel::WheelModel(const Motion& motion, const WheelOptions& options, uint64_t seed)
    : options_(options), actual_(actualIntrinsics(options, seed))
{
	requireGroups(options.slips, 4, "slips");
	requireGroups(options.silences, 2, "silences");
	for (size_t i = 3; i < options.slips.size(); i += 4)
		if (options.slips[i] != 0 && options.slips[i] != 1)
			throw Error("[wheels] slips: the fourth number of a slip is 0 (left) or 1 (right)");
	if (2e-3 * options.stamp_jitter_ms >= 1 / options.rate_hz)
		throw Error("[wheels] stamp_jitter_ms: must be below half the interval of readings, or stamps go back");
	simulate(motion, seed);
}

WheelSpeeds WheelModel::slipFactor(double t_s) const
{
	WheelSpeeds factor{1, 1};
	const auto& s = options_.slips;
	for (size_t i = 0; i < s.size(); i += 4)
		if (t_s >= s[i] && t_s < s[i] + s[i + 1]) (s[i + 3] == 0 ? factor.left_m_s : factor.right_m_s) += s[i + 2];
	return factor;
}

bool WheelModel::silent(double t_s) const
{
	const auto& s = options_.silences;
	for (size_t i = 0; i < s.size(); i += 2)
		if (t_s >= s[i] && t_s < s[i] + s[i + 1]) return true;
	return false;
}

WheelSpeeds WheelModel::travel(const Motion& motion, double begin_s, double end_s) const
{
	std::vector<double> cuts = {begin_s, end_s};
	for (size_t i = 0; i < options_.slips.size(); i += 4)
		for (const double t : {options_.slips[i], options_.slips[i] + options_.slips[i + 1]})
			if (t > begin_s && t < end_s) cuts.push_back(t);
	std::sort(cuts.begin(), cuts.end());
	// Three Gauss points on at most some tens of milliseconds: the speeds are smooth, what remains is some nanometres.
	static constexpr double kNodes[] = {-0.7745966692414834, 0, 0.7745966692414834};
	static constexpr double kWeights[] = {5.0 / 9, 8.0 / 9, 5.0 / 9};
	WheelSpeeds sum;
	for (size_t c = 0; c + 1 < cuts.size(); ++c)
	{
		const double middle_s = 0.5 * (cuts[c] + cuts[c + 1]), half_s = 0.5 * (cuts[c + 1] - cuts[c]);
		const WheelSpeeds factor = slipFactor(middle_s);
		for (int i = 0; i < 3; ++i)
		{
			const WheelSpeeds v = motion.wheelSpeeds(middle_s + half_s * kNodes[i], actual_.track_m);
			sum.left_m_s += half_s * kWeights[i] * v.left_m_s * factor.left_m_s;
			sum.right_m_s += half_s * kWeights[i] * v.right_m_s * factor.right_m_s;
		}
	}
	return sum;
}

void WheelModel::simulate(const Motion& motion, uint64_t seed)
{
	std::mt19937_64 noise_generator = randomSource(seed, "wheel noise"), jitter_generator = randomSource(seed, "wheel jitter"),
	                start_generator = randomSource(seed, "wheel start ticks");
	std::normal_distribution<double> normal;
	std::uniform_real_distribution<double> jitter(-1e-3 * options_.stamp_jitter_ms, std::nextafter(1e-3 * options_.stamp_jitter_ms, 1.0));
	std::uniform_int_distribution<int64_t> start_ticks(0, 100000);
	Encoder left(options_, start_ticks(start_generator)), right(options_, start_ticks(start_generator));
	const auto withNoise = [&](double travel_m, double dt_s)
	{
		const double speed_m_s = std::abs(travel_m) / dt_s, standing_m_s = 1e-9;
		const double draw = normal(noise_generator);
		const double density =
		    speed_m_s < standing_m_s ? 0 : std::hypot(options_.noise_m_s_sqrtHz, options_.noise_per_speed_sqrtHz * speed_m_s);
		return travel_m + density * std::sqrt(dt_s) * draw;
	};

	WheelReading reading;
	double step_begin_s = 0, left_m = 0, right_m = 0, since_s = 0;
	for (int64_t i = 0;; ++i)
	{
		const double t_s = 1e-3 * options_.phase_ms + static_cast<double>(i) / options_.rate_hz;
		if (t_s > motion.duration_s()) break;
		const double dt_s = t_s - step_begin_s;
		if (dt_s > 0)
		{
			const WheelSpeeds ground = travel(motion, step_begin_s, t_s);
			left_m += left.advance(withNoise(ground.left_m_s, dt_s) / actual_.k_left);
			right_m += right.advance(withNoise(ground.right_m_s, dt_s) / actual_.k_right);
			since_s += dt_s;
		}
		step_begin_s = t_s;
		if (silent(t_s)) continue;
		reading.t_s = t_s;
		reading.t_ns = motion.stamp_ns(t_s) - nanoseconds(1e-3 * options_.clock_offset_ms);
		if (options_.stamp_jitter_ms > 0) reading.t_ns += nanoseconds(jitter(jitter_generator));
		reading.ticks_left = left.ticks();
		reading.ticks_right = right.ticks();
		const double distance_m = 0.5 * (left_m + right_m), angle_rad = (right_m - left_m) / options_.track_m;
		if (since_s > 0)
			reading.mean_twist = {distance_m / since_s, angle_rad / since_s};
		else
		{
			const WheelSpeeds now = motion.wheelSpeeds(t_s, actual_.track_m);
			reading.mean_twist = twistOf({0, now.left_m_s / actual_.k_left, now.right_m_s / actual_.k_right}, nominal());
		}
		deadReckon(reading, distance_m, angle_rad);
		readings_.push_back(reading);
		left_m = right_m = since_s = 0;
	}
}

std::vector<WheelSample> WheelModel::samples(double t_begin_s, double t_end_s) const
{
	std::vector<WheelSample> result;
	for (const WheelReading& r : readings_)
		if (r.t_s >= t_begin_s - 5e-10 && r.t_s <= t_end_s + 5e-10)
			result.push_back(wheelSampleFromTwist(r.t_ns, r.mean_twist, options_.track_m));
	return result;
}
}  // namespace viwo::sim
