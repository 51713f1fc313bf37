#include "Propagation.h"

#include "ImuPreintegration.h"

#include <viwo/core/So3.h>
#include <viwo/core/Time.h>

#include <cmath>

namespace viwo
{
namespace
{
// States beyond these are no robot's: the window has diverged.
constexpr double kMaxSpeed_m_s = 60;
constexpr double kMaxAccBias_m_s2 = 3;
constexpr double kMaxGyroBias_rad_s = 0.5;

constexpr double kMaxOffset_s = 0.4;

NavState step(const NavState& s, const ImuSample& a, const ImuSample& b, double gravity_m_s2)
{
	const double dt_s = secondsBetween(a.t_ns, b.t_ns);
	const Eigen::Vector3d w = 0.5 * (a.gyro_rad_s + b.gyro_rad_s) - s.b_g;
	const Eigen::Vector3d f = 0.5 * (a.acc_m_s2 + b.acc_m_s2) - s.b_a;
	NavState next = s;
	next.t_ns = b.t_ns;
	const Eigen::Vector3d acc_W = s.T_WB.R * so3::expQuaternion(0.5 * w * dt_s) * f - Eigen::Vector3d(0, 0, gravity_m_s2);
	next.T_WB.p += s.v_WB * dt_s + 0.5 * acc_W * dt_s * dt_s;
	next.v_WB += acc_W * dt_s;
	next.T_WB.R = (s.T_WB.R * so3::expQuaternion(w * dt_s)).normalized();
	return next;
}
}  // namespace

std::vector<NavState> propagateOver(NavState state, const std::vector<ImuSample>& samples, double gravity_m_s2)
{
	std::vector<NavState> states;
	for (size_t i = 1; i < samples.size(); ++i)
	{
		state = step(state, samples[i - 1], samples[i], gravity_m_s2);
		states.push_back(state);
	}
	return states;
}

NavState predict(const NavState& s, const ImuPreintegration& interval, double gravity_m_s2)
{
	const ImuDelta d = interval.corrected(s.b_a, s.b_g);
	const double dt_s = interval.dt_s();
	const Eigen::Vector3d g_up(0, 0, gravity_m_s2);
	NavState predicted = s;
	predicted.T_WB.p = s.T_WB.p + s.v_WB * dt_s - 0.5 * g_up * dt_s * dt_s + s.T_WB.R * d.alpha;
	predicted.v_WB = s.v_WB - g_up * dt_s + s.T_WB.R * d.beta;
	predicted.T_WB.R = (s.T_WB.R * d.gamma).normalized();
	return predicted;
}

Eigen::Quaterniond turnOver(const std::vector<ImuSample>& samples, const Eigen::Vector3d& b_g)
{
	Eigen::Quaterniond R = Eigen::Quaterniond::Identity();
	for (size_t i = 1; i < samples.size(); ++i)
	{
		const ImuSample &a = samples[i - 1], &b = samples[i];
		R = R * so3::expQuaternion((0.5 * (a.gyro_rad_s + b.gyro_rad_s) - b_g) * secondsBetween(a.t_ns, b.t_ns));
	}
	return R;
}

bool plausible(const NavState& s)
{
	const bool finite =
	    s.T_WB.p.allFinite() && s.T_WB.R.coeffs().allFinite() && s.v_WB.allFinite() && s.b_a.allFinite() && s.b_g.allFinite();
	return finite && s.v_WB.norm() < kMaxSpeed_m_s && s.b_a.norm() < kMaxAccBias_m_s2 && s.b_g.norm() < kMaxGyroBias_rad_s;
}

bool plausible(const ClockOffsets& offsets)
{
	return std::abs(offsets.t_d_s) < kMaxOffset_s && std::abs(offsets.t_w_s) < kMaxOffset_s;
}
}  // namespace viwo
