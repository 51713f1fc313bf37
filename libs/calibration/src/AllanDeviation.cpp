#include <viwo/calibration/AllanDeviation.h>

#include <algorithm>
#include <cmath>

namespace viwo
{
namespace
{
/** Clusters are shifted by this part of their length: shorter shifts add work, but hardly any information. */
constexpr size_t kShiftsPerCluster = 32;
constexpr double kLeastFilled = 0.9;

size_t shiftOf(size_t cluster)
{
	return std::max<size_t>(1, cluster / kShiftsPerCluster);
}

double meanOf(const EvenPieces& pieces)
{
	double sum = 0;
	size_t count = 0;
	for (const auto& piece : pieces)
		for (const double x : piece)
			if (std::isfinite(x)) sum += x, ++count;
	return count > 0 ? sum / static_cast<double>(count) : 0;
}

/** Sums from the start of a piece, so that any cluster's mean takes two look-ups. */
class ClusterMeans
{
   public:
	ClusterMeans(const std::vector<double>& piece, double mean) : sums_(piece.size() + 1), counts_(piece.size() + 1)
	{
		for (size_t i = 0; i < piece.size(); ++i)
		{
			const bool there = std::isfinite(piece[i]);
			sums_[i + 1] = sums_[i] + (there ? piece[i] - mean : 0);
			counts_[i + 1] = counts_[i] + (there ? 1 : 0);
		}
	}
	size_t size() const { return counts_.size() - 1; }
	size_t count() const { return counts_.back(); }

	/** Sum over the squared differences of neighbours, and how many. */
	void add(size_t cluster, double& sum, size_t& terms) const
	{
		const size_t shift = shiftOf(cluster);
		const auto least = static_cast<uint32_t>(std::ceil(kLeastFilled * static_cast<double>(cluster)));
		for (size_t i = 0; i + 2 * cluster <= size(); i += shift)
		{
			const size_t j = i + cluster, k = j + cluster;
			const uint32_t first = counts_[j] - counts_[i], second = counts_[k] - counts_[j];
			if (first < least || second < least) continue;
			const double difference = (sums_[k] - sums_[j]) / second - (sums_[j] - sums_[i]) / first;
			sum += difference * difference;
			++terms;
		}
	}

   private:
	std::vector<double> sums_;
	std::vector<uint32_t> counts_;
};

std::vector<size_t> clusterSizes(size_t longest)
{
	std::vector<size_t> sizes;
	for (int quarter = 0;; ++quarter)
	{
		const auto cluster = static_cast<size_t>(std::llround(std::exp2(0.25 * quarter)));
		if (4 * cluster > longest) return sizes;
		if (sizes.empty() || cluster > sizes.back()) sizes.push_back(cluster);
	}
}

/** Of one piece. @param n samples. */
double degreesOfFreedomOf(double n, double m, NoiseKind kind)
{
	const double N = n + 1;  // readings of the integral
	if (n < 2 * m || N < 4) return 0;
	switch (kind)
	{
		case NoiseKind::quantisation:
			// Its integral is white: a shift by one sample gives another estimate, which long shifts do without.
			return (N + 1) * (N - 2 * m) / (2 * (N - m)) / static_cast<double>(shiftOf(static_cast<size_t>(m)));
		case NoiseKind::white:
			return (3 * (N - 1) / (2 * m) - 2 * (N - 2) / N) * 4 * m * m / (4 * m * m + 5);
		case NoiseKind::flicker:
			return m < 2 ? 2 * (N - 2) * (N - 2) / (2.3 * N - 4.9) : 5 * N * N / (4 * m * (N + 3 * m));
		case NoiseKind::walk:
			return (N - 2) / m * ((N - 1) * (N - 1) - 3 * m * (N - 1) + 4 * m * m) / ((N - 3) * (N - 3));
	}
	return 0;
}
}  // namespace

double AllanCurve::degreesOfFreedom(size_t cluster, NoiseKind kind) const
{
	double sum = 0;
	for (const size_t length : lengths)
		sum += std::max(0.0, degreesOfFreedomOf(static_cast<double>(length), static_cast<double>(cluster), kind));
	return sum;
}

AllanCurve allanCurve(const EvenPieces& pieces, double interval_s)
{
	AllanCurve curve;
	curve.interval_s = interval_s;
	const double mean = meanOf(pieces);
	std::vector<ClusterMeans> means;
	size_t longest = 0;
	for (const auto& piece : pieces)
	{
		means.emplace_back(piece, mean);
		curve.lengths.push_back(means.back().count());
		longest = std::max(longest, means.back().count());
	}
	for (const size_t cluster : clusterSizes(longest))
	{
		double sum = 0;
		size_t terms = 0;
		for (const ClusterMeans& piece : means) piece.add(cluster, sum, terms);
		if (terms > 0)
			curve.points.push_back({cluster, static_cast<double>(cluster) * interval_s, std::sqrt(0.5 * sum / static_cast<double>(terms))});
	}
	return curve;
}
}  // namespace viwo
