#include <viwo/sim/Motion.h>

#include "PlanarPath.h"
#include "TimeJet.h"

namespace viwo::sim
{
namespace
{
/** Half the distance between the wheels of a small robot: turns the yaw rate into a wheel speed, for the strength of the vibration only. */
constexpr double kVibrationLever_m = 0.115;

using VectorJet = MatrixJet<Eigen::Vector3d>;
using RotationJet = MatrixJet<Eigen::Matrix3d>;

/** Axes of a robot that stands tangentially on the floor, its x axis above the heading. */
RotationJet standingOn(const TimeJet& yaw, const TimeJet& slope_x, const TimeJet& slope_y)
{
	const TimeJet c = cos(yaw), s = sin(yaw), climb = slope_x * c + slope_y * s;
	const TimeJet x_norm = inverseSqrt(1 + climb * climb);
	const TimeJet z_norm = inverseSqrt(1 + slope_x * slope_x + slope_y * slope_y);
	const TimeJet x[3] = {c * x_norm, s * x_norm, climb * x_norm};
	const TimeJet z[3] = {-slope_x * z_norm, -slope_y * z_norm, z_norm};
	RotationJet R;
	for (int i = 0; i < 3; ++i)
	{
		const int j = (i + 1) % 3, k = (i + 2) % 3;
		R.set(i, 0, x[i]);
		R.set(i, 1, z[j] * x[k] - z[k] * x[j]);
		R.set(i, 2, z[i]);
	}
	return R;
}

RotationJet rotationAbout(int axis, const TimeJet& angle)
{
	const int j = (axis + 1) % 3, k = (axis + 2) % 3;
	RotationJet R;
	R.set(axis, axis, 1);
	R.set(j, j, cos(angle));
	R.set(j, k, -sin(angle));
	R.set(k, j, sin(angle));
	R.set(k, k, cos(angle));
	return R;
}

Eigen::Vector3d vee(const Eigen::Matrix3d& M)
{
	return 0.5 * Eigen::Vector3d(M(2, 1) - M(1, 2), M(0, 2) - M(2, 0), M(1, 0) - M(0, 1));
}

/** [w]_x = R^T R', and [alpha]_x is the skew part of R^T R''. */
MotionState stateOf(const RotationJet& R, const VectorJet& p)
{
	MotionState state;
	state.T_WO = {Eigen::Quaterniond(R.f).normalized(), p.f};
	state.v_WO = p.d;
	state.a_WO = p.dd;
	state.w_O = vee(R.f.transpose() * R.d);
	state.alpha_O = vee(R.f.transpose() * R.dd);
	return state;
}

struct Place
{
	TimeJet x, y, yaw;

	explicit Place(const PlanarState& s)
	{
		const double c = std::cos(s.yaw_rad), sn = std::sin(s.yaw_rad);
		x = {s.x_m, s.v * c, s.dv * c - s.v * s.w * sn};
		y = {s.y_m, s.v * sn, s.dv * sn + s.v * s.w * c};
		yaw = {s.yaw_rad, s.w, s.dw};
	}
};

void onFloor(const Place& place, const Floor& floor, RotationJet& R_WO, VectorJet& p_WO)
{
	TimeJet height, slope_x, slope_y;
	floor.at(place.x, place.y, height, slope_x, slope_y);
	R_WO = standingOn(place.yaw, slope_x, slope_y);
	p_WO.set(0, 0, place.x);
	p_WO.set(1, 0, place.y);
	p_WO.set(2, 0, height);
}
}  // namespace

Motion::Motion(const Route& route, const FloorOptions& floor, const VibrationOptions& vibration, uint64_t seed, int64_t epoch_ns)
    : path_(std::make_unique<PlanarPath>(route)), floor_(floor, seed), vibration_(vibration, seed), epoch_ns_(epoch_ns)
{
}

Motion::~Motion() = default;
Motion::Motion(Motion&&) noexcept = default;

double Motion::duration_s() const
{
	return path_->duration_s();
}

MotionState Motion::at(double t_s) const
{
	const PlanarState planar = path_->at(t_s);
	RotationJet R_WO;
	VectorJet p_WO;
	onFloor(Place(planar), floor_, R_WO, p_WO);
	if (!vibration_.isOff())
	{
		const TimeJet v(planar.v, planar.dv, planar.ddv), rim = kVibrationLever_m * TimeJet(planar.w, planar.dw, planar.ddw);
		TimeJet shake[6];
		vibration_.at(t_s, v * v + rim * rim, shake);
		VectorJet offset_O;
		for (int i = 0; i < 3; ++i) offset_O.set(i, 0, shake[i]);
		const VectorJet offset_W = R_WO * offset_O;
		p_WO.f += offset_W.f;
		p_WO.d += offset_W.d;
		p_WO.dd += offset_W.dd;
		R_WO = R_WO * rotationAbout(2, shake[5]) * rotationAbout(1, shake[4]) * rotationAbout(0, shake[3]);
	}
	return stateOf(R_WO, p_WO);
}

WheelSpeeds Motion::wheelSpeeds(double t_s, double track_m) const
{
	RotationJet R_WO;
	VectorJet p_WO;
	onFloor(Place(path_->at(t_s)), floor_, R_WO, p_WO);
	const MotionState state = stateOf(R_WO, p_WO);
	const double v_m_s = R_WO.f.col(0).dot(state.v_WO), half_track_m = 0.5 * track_m;
	return {v_m_s - half_track_m * state.w_O.z(), v_m_s + half_track_m * state.w_O.z()};
}

Trajectory Motion::groundTruth(double rate_hz) const
{
	Trajectory trajectory;
	const auto count = static_cast<int64_t>(std::floor(duration_s() * rate_hz + 1e-9));
	for (int64_t i = 0; i <= count; ++i)
	{
		const double t_s = static_cast<double>(i) / rate_hz;
		trajectory.push_back({stamp_ns(t_s), at(t_s).T_WO});
	}
	return trajectory;
}
}  // namespace viwo::sim
