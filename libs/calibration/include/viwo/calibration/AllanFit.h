#pragma once

#include <viwo/calibration/AllanDeviation.h>

#include <Eigen/Core>
#include <string>
#include <vector>

namespace viwo
{
/** A figure with its standard deviation. Where it was not observed, `value` is 0 and `limit` says what it may still be (95 %). */
struct NoiseReading
{
	double value = 0, deviation = 0;
	bool observed = false;
	double limit = 0;
};

/** The least of the fitted curve, over 0.664: the bias instability, or an upper bound of it where the curve still falls at its end. */
struct BiasInstability
{
	double value = 0, deviation = 0;
	double tau_s = 0;
	bool reached = false;
};

/** What is added to a fitted point. */
struct FittedPoint
{
	AllanPoint point;
	double low = 0, high = 0;  //!< of the deviation, 95 %
	double model = 0;          //!< fitted deviation
	bool used = false;         //!< by the fit
};

/** Noise of one axis. Units: u that of the samples. */
struct NoiseModel
{
	NoiseReading quantisation;  //!< Q, u s
	NoiseReading white;         //!< N, u/sqrt(Hz): the line of slope -1/2 at tau = 1 s
	NoiseReading flicker;       //!< B, u: the flat part
	NoiseReading walk;          //!< K, u sqrt(Hz): the line of slope +1/2 at tau = 3 s
	BiasInstability instability;
	double length_s = 0;      //!< of the log
	double walk_needs_s = 0;  //!< where the walk was not observed: length of a log that shows one as small as this one leaves possible
	double shortest_s = 0;    //!< shorter clusters do not follow the model and are left out; 0: none are
	bool smoothed = false;    //!< the sensor filters: neighbouring samples are alike
	double misfit = 0;        //!< chi^2 of the fit over its degrees of freedom; near 1 where the model holds
	double trend_slope = 0;   //!< of the curve's last octaves; above 0.8 it is a drift, not a random walk
	std::vector<FittedPoint> points;
};

/** Fits sigma^2 = 3 Q^2/tau^2 + N^2/tau + (2 ln 2/pi) B^2 + K^2 tau/3 (IEEE Std 952) with coefficients that are not negative, to the
 * curve's points an octave apart, each weighed by its degrees of freedom; points that fit badly count less. A kind of noise without which
 * the curve fits as well is not observed. @throws Error: too few points, or samples that never change. */
NoiseModel fitNoise(const AllanCurve& curve);
}  // namespace viwo
