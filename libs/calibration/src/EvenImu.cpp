#include <viwo/calibration/EvenImu.h>
#include <viwo/core/Error.h>
#include <viwo/core/Ranking.h>
#include <viwo/core/Time.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "Median.h"

namespace viwo
{
namespace
{
constexpr double kLongestGap_s = 600;
constexpr double kMostCells = 50;   // for each sample
constexpr double kLate = 1.5;       // intervals, from which on samples may have been lost
constexpr size_t kNeighbours = 64;  // stamps on each side by which a delay is told from jitter

/** Median over runs of so many samples; 0 for a shorter record. */
double intervalOfRuns(const std::vector<double>& t_s, size_t length)
{
	std::vector<double> runs;
	for (size_t i = length; i < t_s.size(); i += length) runs.push_back((t_s[i] - t_s[i - length]) / static_cast<double>(length));
	return medianOf(runs);
}

/** That of most intervals; where these differ, that of most short runs, of which few have lost a sample; where stamps come in bunches, that
 * of runs which are longer than any. */
double typicalInterval(const std::vector<double>& t_s)
{
	std::vector<double> intervals;
	for (size_t i = 1; i < t_s.size(); ++i) intervals.push_back(t_s[i] - t_s[i - 1]);
	const double middle = medianOf(intervals);
	double sum = 0;
	size_t near = 0;
	for (const double interval : intervals)
		if (std::abs(interval - middle) < 0.1 * middle) sum += interval, ++near;
	double typical = 2 * near > intervals.size() ? sum / static_cast<double>(near) : intervalOfRuns(t_s, 16);
	for (const size_t length : {16u, 512u})
		if (const double longer = intervalOfRuns(t_s, length); longer > kLate * typical) typical = longer;
	return typical > 0 ? typical : middle;
}

/** Which cell of the grid each sample belongs to. */
class Counter
{
   public:
	Counter(const std::vector<double>& t_s, double interval_s) : t_s_(t_s), interval_s_(interval_s), cells_(t_s.size(), 0)
	{
		size_t run = 0;  // first sample since the last hole
		for (size_t i = 1; i < t_s_.size(); ++i)
		{
			cells_[i] = cells_[i - 1] + 1;
			if (t_s_[i] - t_s_[i - 1] < kLate * interval_s_) continue;
			const double late =
			    leastLag(i, std::min(i + kNeighbours, t_s_.size()), i) - leastLag(std::max(run, i - std::min(i, kNeighbours)), i, i - 1);
			const double lost = std::round(late);
			if (lost < 1) continue;
			cells_[i] += static_cast<int64_t>(lost);
			run = i;
		}
	}
	const std::vector<int64_t>& cells() const { return cells_; }

   private:
	/** How late stamps are against their count, in intervals, with the count going on evenly from sample `from`. Reception delays a stamp,
	 * now more, now less: the least delay is steady. */
	double leastLag(size_t begin, size_t end, size_t from) const
	{
		double least = std::numeric_limits<double>::infinity();
		for (size_t j = begin; j < end; ++j)
		{
			const double cell =
			    j < from ? static_cast<double>(cells_[j]) : static_cast<double>(cells_[from]) + static_cast<double>(j - from);
			least = std::min(least, t_s_[j] / interval_s_ - cell);
		}
		return least;
	}

	const std::vector<double>& t_s_;
	double interval_s_;
	std::vector<int64_t> cells_;
};

/** Mean interval of the grid, gaps longer than a piece aside. */
double meanInterval(const std::vector<double>& t_s, const std::vector<int64_t>& cells)
{
	double time_s = 0;
	int64_t count = 0;
	for (size_t i = 1; i < t_s.size(); ++i)
	{
		if (t_s[i] - t_s[i - 1] > kLongestGap_s) continue;
		time_s += t_s[i] - t_s[i - 1];
		count += cells[i] - cells[i - 1];
	}
	return time_s / static_cast<double>(std::max<int64_t>(1, count));
}

double jitterOf(const std::vector<double>& t_s, const std::vector<int64_t>& cells, double interval_s)
{
	std::vector<double> offsets;
	for (size_t i = 1; i < t_s.size(); ++i)
		if (cells[i] == cells[i - 1] + 1) offsets.push_back(std::abs(t_s[i] - t_s[i - 1] - interval_s));
	if (offsets.empty()) return 0;
	return valueAtRank(offsets, static_cast<size_t>(0.9 * static_cast<double>(offsets.size() - 1)));
}

struct Run
{
	size_t begin, end;  //!< samples of one piece
};

std::vector<Run> runsOf(const std::vector<double>& t_s)
{
	std::vector<Run> runs{{0, t_s.size()}};
	for (size_t i = 1; i < t_s.size(); ++i)
		if (t_s[i] - t_s[i - 1] > kLongestGap_s)
		{
			runs.back().end = i;
			runs.push_back({i, t_s.size()});
		}
	return runs;
}
}  // namespace

const char* imuAxisName(size_t axis)
{
	static constexpr const char* kNames[kImuAxes] = {"acc x", "acc y", "acc z", "gyro x", "gyro y", "gyro z"};
	return kNames[axis];
}

const char* imuAxisUnit(size_t axis)
{
	return axis < 3 ? "m/s^2" : "rad/s";
}

double EvenImu::duration_s() const
{
	double sum = 0;
	for (const Piece& piece : pieces) sum += static_cast<double>(piece.cells) * interval_s;
	return sum;
}

int64_t EvenImu::t_ns(size_t piece, size_t cell) const
{
	return pieces[piece].first_t_ns + nanoseconds(static_cast<double>(cell) * interval_s);
}

EvenImu evenlySampled(ImuRecord&& record)
{
	std::vector<double> t_s;
	t_s.reserve(record.t_ns.size());
	for (const int64_t t_ns : record.t_ns) t_s.push_back(secondsBetween(record.t_ns.front(), t_ns));
	const double first_guess_s = meanInterval(t_s, Counter(t_s, typicalInterval(t_s)).cells());
	const std::vector<int64_t> cells = Counter(t_s, first_guess_s).cells();

	EvenImu even;
	even.interval_s = meanInterval(t_s, cells);
	even.log_start_ns = record.t_ns.front();
	even.samples = t_s.size();
	even.jitter_s = jitterOf(t_s, cells, even.interval_s);
	const std::vector<Run> runs = runsOf(t_s);
	for (size_t i = 1; i < t_s.size(); ++i)
		if (cells[i] > cells[i - 1] + 1) even.longest_gap_s = std::max(even.longest_gap_s, t_s[i] - t_s[i - 1]);
	for (const Run& run : runs)
	{
		const int64_t first = cells[run.begin];
		even.pieces.push_back({record.t_ns[run.begin], static_cast<size_t>(cells[run.end - 1] - first + 1)});
		even.lost += even.pieces.back().cells - (run.end - run.begin);
	}
	if (static_cast<double>(even.lost) > kMostCells * static_cast<double>(even.samples))
		throw Error("the stamps of " + std::to_string(even.samples) + " samples leave room for " + std::to_string(even.lost) +
		            " more between them: no even series");
	for (size_t axis = 0; axis < kImuAxes; ++axis)
	{
		for (size_t k = 0; k < runs.size(); ++k)
		{
			std::vector<double> values(even.pieces[k].cells, std::numeric_limits<double>::quiet_NaN());
			for (size_t i = runs[k].begin; i < runs[k].end; ++i)
				values[static_cast<size_t>(cells[i] - cells[runs[k].begin])] = record.axes[axis][i];
			even.axes[axis].push_back(std::move(values));
		}
		std::vector<double>().swap(record.axes[axis]);
	}
	return even;
}
}  // namespace viwo
