#pragma once

#include <viwo/sim/Route.h>

#include <vector>

#include "SpeedRamp.h"

namespace viwo::sim
{
/** The route on a perfect plane: place, heading, and speeds with two derivatives. */
struct PlanarState
{
	double x_m = 0, y_m = 0, yaw_rad = 0;
	double v = 0, dv = 0, ddv = 0;  //!< forward speed, m/s, and derivatives
	double w = 0, dw = 0, ddw = 0;  //!< yaw rate, rad/s, and derivatives
};

/** Strings the segments of a route into one motion. Speeds and heading are closed-form; the place is their integral by Gauss-Legendre
 * quadrature between the points where a ramp begins or ends, exact to rounding.
 */
class PlanarPath
{
   public:
	/** @throws Error for segments that are too short to brake in, or sums of sines of unequal lengths. */
	explicit PlanarPath(const Route& route);

	PlanarState at(double t_s) const;
	double duration_s() const { return duration_s_; }

   private:
	struct Leg
	{
		RouteSegment segment;
		double begin_s = 0, yaw_begin_rad = 0;
		double v_m_s = 0, w_rad_s = 0;  //!< at full speed
		SpeedRamp v_ramp, w_ramp;
	};
	struct Node
	{
		double t_s, x_m, y_m;
	};

	Leg makeLeg(const RouteSegment& segment, double v_in_m_s, double v_out_m_s, bool in_motion_at_begin, bool in_motion_at_end) const;
	void fitStraight(Leg& leg, double v_in_m_s, double v_out_m_s) const;
	void fitTurn(Leg& leg, double v_in_m_s, double v_out_m_s, bool in_motion_at_begin, bool in_motion_at_end) const;
	void fitFree(Leg& leg, bool in_motion_at_begin, bool in_motion_at_end) const;
	double fullSpeed(const RouteSegment& segment) const;
	void append(Leg leg);
	void integratePlace(const Leg& leg, double begin_s, double end_s);

	/** All but the place. */
	PlanarState speedsAt(const Leg& leg, double t_s) const;
	void freeSpeedsAt(const Leg& leg, double t_s, PlanarState& state) const;
	void advance(const Leg& leg, double begin_s, double end_s, double& x_m, double& y_m) const;

	Route route_;
	std::vector<Leg> legs_;
	std::vector<Node> nodes_;
	double duration_s_ = 0, end_s_ = 0, end_yaw_rad_ = 0;
};
}  // namespace viwo::sim
