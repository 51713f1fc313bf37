#pragma once

#include <viwo/core/Options.h>

#include <cstdint>
#include <vector>

namespace viwo::sim
{
struct TimeJet;

/** Section [floor] of a rig: unevenness as a sum of plane waves. Height, slope and the robot's pitch and roll follow from one height field.
 */
struct FloorOptions : Options<FloorOptions>
{
	double height_rms_mm = 1.0;
	double wavelength_min_m = 1.0;
	double wavelength_max_m = 4.0;

	/** A perfect plane. */
	static FloorOptions flat();

	template <class Visitor>
	void visit(Visitor& v)
	{
		v("height_rms_mm", height_rms_mm,
		  "deviation of the floor from a plane, mm; the tilt is its slope, about 0.2 deg rms at 1 mm; 0: flat", 0.0, 50.0);
		v("wavelength_min_m", wavelength_min_m, "shortest wave of the floor", 0.1, 100.0);
		v("wavelength_max_m", wavelength_max_m, "longest wave of the floor", 0.1, 100.0);
	}
};

/** Section [vibration] of a rig: band-limited shaking of the whole robot, proportional to its speed. */
struct VibrationOptions : Options<VibrationOptions>
{
	double acceleration_m_s2 = 0.08;
	double rate_deg_s = 0.15;
	double reference_speed_m_s = 0.15;
	double frequency_min_hz = 8;
	double frequency_max_hz = 35;

	static VibrationOptions off();

	template <class Visitor>
	void visit(Visitor& v)
	{
		v("acceleration_m_s2", acceleration_m_s2, "rms acceleration of each axis at the reference speed; 0: none", 0.0, 20.0);
		v("rate_deg_s", rate_deg_s, "rms angular rate of each axis at the reference speed; 0: none", 0.0, 100.0);
		v("reference_speed_m_s", reference_speed_m_s, "wheel speed at which the above hold", 1e-3, 10.0);
		v("frequency_min_hz", frequency_min_hz, "lowest frequency", 0.5, 90.0);
		v("frequency_max_hz", frequency_max_hz, "highest frequency; below half the IMU's rate", 0.5, 90.0);
	}
};

/** Height of the floor over z = 0 and its slope, as functions of the place. */
class Floor
{
   public:
	Floor(const FloorOptions& options, uint64_t seed);

	/** Height (m) and its partial derivatives along x and y at (x, y), each with time derivatives. */
	void at(const TimeJet& x, const TimeJet& y, TimeJet& height, TimeJet& slope_x, TimeJet& slope_y) const;

   private:
	struct Wave
	{
		double amplitude_m, kx_rad_m, ky_rad_m, phase_rad;
	};
	std::vector<Wave> waves_;
};

/** Sums of sines: three displacements (m) and three angles (rad), scaled by the speed of the wheels. */
class Vibration
{
   public:
	Vibration(const VibrationOptions& options, uint64_t seed);

	/** The six displacements dx dy dz droll dpitch dyaw; speed_squared: of the faster wheel or so, with time derivatives. */
	void at(double t_s, const TimeJet& speed_squared, TimeJet (&displacement)[6]) const;

	bool isOff() const { return waves_.empty(); }

   private:
	struct Wave
	{
		int axis;
		double amplitude, omega_rad_s, phase_rad;
	};
	std::vector<Wave> waves_;
	double reference_speed_m_s_;
};
}  // namespace viwo::sim
