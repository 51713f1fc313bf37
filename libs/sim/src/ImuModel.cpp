#include <viwo/core/Error.h>
#include <viwo/sim/ImuModel.h>
#include <viwo/sim/Mounting.h>
#include <viwo/sim/RandomSource.h>

#include <algorithm>
#include <cmath>

namespace viwo::sim
{
namespace
{
using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d uniform(std::mt19937_64& generator, double bound)
{
	std::uniform_real_distribution<double> distribution(-1, 1);
	Vector3d v;
	for (int i = 0; i < 3; ++i) v[i] = bound * distribution(generator);
	return v;
}

/** Normal draws of one source. */
class Normal
{
   public:
	Normal(uint64_t seed, std::string_view source) : generator_(randomSource(seed, source)) {}

	Vector3d draw(double deviation)
	{
		Vector3d v;
		for (int i = 0; i < 3; ++i) v[i] = deviation * distribution_(generator_);
		return v;
	}

   private:
	std::mt19937_64 generator_;
	std::normal_distribution<double> distribution_;
};

/** What a triad makes of a true vector: scale errors on the diagonal, axes that are not quite perpendicular off it. */
Matrix3d sensitivity(uint64_t seed, std::string_view source, double scale_error, double misalignment_rad)
{
	std::mt19937_64 generator = randomSource(seed, source);
	const Vector3d scale = uniform(generator, scale_error), a = uniform(generator, misalignment_rad),
	               b = uniform(generator, misalignment_rad);
	Matrix3d M = (Vector3d::Ones() + scale).asDiagonal();
	M(0, 1) = a[0], M(0, 2) = a[1], M(1, 2) = a[2];
	M(1, 0) = b[0], M(2, 0) = b[1], M(2, 1) = b[2];
	return M;
}

Vector3d quantised(const Vector3d& v, double step)
{
	if (step == 0) return v;
	return step * (v / step).array().round();
}
}  // namespace

ImuOptions ImuOptions::perfect()
{
	ImuOptions o;
	o.acc_noise_m_s2_sqrtHz = o.gyro_noise_rad_s_sqrtHz = o.acc_walk_m_s3_sqrtHz = o.gyro_walk_rad_s2_sqrtHz = 0;
	o.acc_start_bias_m_s2 = o.gyro_start_bias_rad_s = o.acc_scale_error = o.gyro_scale_error = o.axis_misalignment_deg = 0;
	o.acc_resolution_m_s2 = o.gyro_resolution_rad_s = o.stamp_jitter_ms = 0;
	o.pose_error.assign(6, 0);
	return o;
}

ImuModel::ImuModel(const Motion& motion, const ImuOptions& options, uint64_t seed) : options_(options)
{
	const Mounting mounting(options.pose, options.pose_error, "imu");
	T_OB_ = mounting.nominal;
	T_OB_actual_ = mounting.actual;
	if (2e-3 * options.stamp_jitter_ms >= 1 / options.rate_hz)
		throw Error("[imu] stamp_jitter_ms: must be below half the sample interval, or stamps go back");
	simulate(motion, seed);
}

ImuSample ImuModel::exactSample(const Motion& motion, double t_s) const
{
	const MotionState O = motion.at(t_s);
	const Vector3d lever = T_OB_actual_.p;
	const Vector3d acc_O = O.alpha_O.cross(lever) + O.w_O.cross(O.w_O.cross(lever));
	const Vector3d up_W(0, 0, options_.gravity_m_s2);
	const Vector3d force_O = O.T_WO.R.conjugate() * (O.a_WO + up_W) + acc_O;
	return {motion.stamp_ns(t_s), T_OB_actual_.R.conjugate() * force_O, T_OB_actual_.R.conjugate() * O.w_O};
}

void ImuModel::simulate(const Motion& motion, uint64_t seed)
{
	const double misalignment_rad = options_.axis_misalignment_deg * M_PI / 180;
	const Matrix3d M_acc = sensitivity(seed, "imu acc sensitivity", options_.acc_scale_error, misalignment_rad);
	const Matrix3d M_gyro = sensitivity(seed, "imu gyro sensitivity", options_.gyro_scale_error, misalignment_rad);
	Normal acc_noise(seed, "imu acc noise"), gyro_noise(seed, "imu gyro noise"), acc_walk(seed, "imu acc walk"),
	    gyro_walk(seed, "imu gyro walk");
	std::mt19937_64 bias_generator = randomSource(seed, "imu start bias"), jitter_generator = randomSource(seed, "imu jitter");
	std::uniform_real_distribution<double> jitter(-1e-3 * options_.stamp_jitter_ms, std::nextafter(1e-3 * options_.stamp_jitter_ms, 1.0));
	Bias bias;
	bias.acc_m_s2 = uniform(bias_generator, options_.acc_start_bias_m_s2);
	bias.gyro_rad_s = uniform(bias_generator, options_.gyro_start_bias_rad_s);

	// A sample of a white process of density sigma, averaged over one interval dt, deviates by sigma / sqrt(dt); a walk steps by sigma
	// sqrt(dt).
	const double root_rate = std::sqrt(options_.rate_hz);
	for (int64_t i = 0;; ++i)
	{
		const double t_s = 1e-3 * options_.phase_ms + static_cast<double>(i) / options_.rate_hz;
		if (t_s > motion.duration_s()) break;
		ImuSample s = exactSample(motion, t_s);
		s.acc_m_s2 = quantised(M_acc * s.acc_m_s2 + bias.acc_m_s2 + acc_noise.draw(options_.acc_noise_m_s2_sqrtHz * root_rate),
		                       options_.acc_resolution_m_s2);
		s.gyro_rad_s = quantised(M_gyro * s.gyro_rad_s + bias.gyro_rad_s + gyro_noise.draw(options_.gyro_noise_rad_s_sqrtHz * root_rate),
		                         options_.gyro_resolution_rad_s);
		if (options_.stamp_jitter_ms > 0) s.t_ns += nanoseconds(jitter(jitter_generator));
		samples_.push_back(s);
		times_s_.push_back(t_s);
		biases_.push_back(bias);
		bias.acc_m_s2 += acc_walk.draw(options_.acc_walk_m_s3_sqrtHz / root_rate);
		bias.gyro_rad_s += gyro_walk.draw(options_.gyro_walk_rad_s2_sqrtHz / root_rate);
	}
	if (samples_.empty()) throw Error("[imu] phase_ms: the motion ends before the first sample; lengthen the route");
}

std::vector<ImuSample> ImuModel::samples(double t_begin_s, double t_end_s) const
{
	// Times are multiples of the interval: half a nanosecond is the resolution of stamps.
	const auto begin = std::lower_bound(times_s_.begin(), times_s_.end(), t_begin_s - 5e-10) - times_s_.begin();
	const auto end = std::upper_bound(times_s_.begin(), times_s_.end(), t_end_s + 5e-10) - times_s_.begin();
	return {samples_.begin() + begin, samples_.begin() + std::max(begin, end)};
}

ImuModel::Bias ImuModel::biasAt(double t_s) const
{
	const double index = std::round((t_s - times_s_.front()) * options_.rate_hz);
	return biases_[static_cast<size_t>(std::clamp(index, 0.0, static_cast<double>(biases_.size() - 1)))];
}

ImuNoise ImuModel::noise() const
{
	return {options_.acc_noise_m_s2_sqrtHz, options_.gyro_noise_rad_s_sqrtHz, options_.acc_walk_m_s3_sqrtHz,
	        options_.gyro_walk_rad_s2_sqrtHz};
}
}  // namespace viwo::sim
