#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace viwo
{
/** One quantity at even times, in pieces between long gaps; NaN where a sample was lost. */
using EvenPieces = std::vector<std::vector<double>>;

/** Kinds of noise in a rate, by the slope of their Allan deviation over the cluster time: -1, -1/2, 0 and +1/2. */
enum class NoiseKind
{
	quantisation,
	white,
	flicker,
	walk
};
constexpr size_t kNoiseKinds = 4;

/** One point of the curve. */
struct AllanPoint
{
	size_t cluster = 0;    //!< samples in a cluster
	double tau_s = 0;      //!< their time
	double deviation = 0;  //!< in the unit of the samples
};

/** Overlapping Allan deviation over cluster times (IEEE Std 952, Annex C; NIST SP 1065). */
struct AllanCurve
{
	double interval_s = 0;
	std::vector<size_t> lengths;     //!< samples in each piece, lost ones not counted
	std::vector<AllanPoint> points;  //!< four to an octave of tau, from one sample to a quarter of the longest piece

	/** Equivalent degrees of freedom of the variance at this cluster size, were all of the noise of one kind (Howe, Allan and Barnes'
	 * approximations, NIST SP 1065, Table 5); 0: too few samples. */
	double degreesOfFreedom(size_t cluster, NoiseKind kind) const;
};

/** The mean of a cluster is that of the samples that are there; clusters that lack more than a tenth are left out. Neighbours are
 * subtracted within a piece only. Noise-free data give deviations of 0. */
AllanCurve allanCurve(const EvenPieces& pieces, double interval_s);
}  // namespace viwo
