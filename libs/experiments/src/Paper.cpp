#include <viwo/core/Error.h>
#include <viwo/experiments/Paper.h>

#include <limits>

namespace viwo::experiments
{
namespace
{
constexpr double kDash = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kStraight = "straight lines and pure rotations";

std::vector<PaperSequence> corridors()
{
	return {{"seq01",
	         37.22,
	         kStraight,
	         {0.70, 0.08, 0.71},
	         {0.30, 0.04, 0.33},
	         {0.29, 0.04, 0.30},
	         {30, 60, 90, 120, 150, 180, 210},
	         {{3.84, 2.45, 3.16, 4.33, 2.43, 3.31, 2.52}, 3.14},
	         {{3.81, 2.44, 2.69, 4.33, 2.39, 3.28, 2.49}, 3.06},
	         {{0.23, 0.60, 0.76, 0.36, kDash, 0.39, 0.31}, 0.44},
	         {{0.18, 0.16, 0.19, 0.30, 0.15, 0.29, 0.28}, 0.22}},
	        {"seq02",
	         55.85,
	         kStraight,
	         {6.13, 0.04, 6.13},
	         {2.10, 0.04, 2.14},
	         {1.10, 0.03, 1.10},
	         {30, 60, 90, 120, 150, 180, 210},
	         {{3.82, 1.88, 5.87, 2.43, 3.24, 2.55, 4.76}, 3.51},
	         {{3.86, 2.21, 4.69, 2.32, 3.27, 2.56, 4.53}, 3.35},
	         {{0.39, 2.09, 1.60, 0.54, kDash, 2.95, 2.32}, 1.65},
	         {{0.36, 2.09, 1.07, 0.48, 0.21, 3.58, 1.52}, 1.33}},
	        {"seq03",
	         16.62,
	         kStraight,
	         {0.74, 0.05, 0.74},
	         {0.30, 0.16, 0.34},
	         {0.15, 0.14, 0.20},
	         {30, 60, 90, 120, 150},
	         {{4.67, 9.30, 4.04, 7.77, 6.07}, 6.37},
	         {{4.38, 9.05, 4.03, 7.72, 3.82}, 5.80},
	         {{0.23, kDash, 0.17, 0.37, 0.30}, 0.27},
	         {{0.21, 0.17, 0.04, 0.38, 0.28}, 0.21}}};
}

std::vector<PaperSequence> lobbies()
{
	return {{"seq04",
	         28.21,
	         kStraight,
	         {0.78, 0.35, 0.78},
	         {0.89, 0.26, 0.93},
	         {0.27, 0.21, 0.27},
	         {30, 60, 90, 120, 150, 180},
	         {{3.68, 3.39, 3.65, 5.36, 8.62, 9.13}, 5.64},
	         {{3.34, 3.54, 3.67, 5.89, 8.39, 6.55}, 5.23},
	         {{0.51, 0.89, 1.27, 0.67, 0.16, 0.30}, 0.63},
	         {{0.12, 0.88, 0.83, 0.08, 0.20, 0.13}, 0.39}},
	        {"seq05",
	         31.64,
	         "circular arcs",
	         {1.71, 0.03, 1.71},
	         {0.37, 0.02, 0.38},
	         {0.03, 0.01, 0.03},
	         {30, 60, 90, 120, 150, 180},
	         {{7.21, 12.79, 6.55, 12.15, 1.68, 2.10}, 7.08},
	         {{4.74, 3.32, 2.78, 6.18, 1.48, 2.00}, 3.42},
	         {{0.24, 0.33, 0.72, 0.56, 0.25, 0.33}, 0.41},
	         {{0.12, 0.11, 0.32, 0.16, 0.10, 0.07}, 0.15}},
	        {"seq06",
	         19.48,
	         "free motion",
	         {0.43, 0.05, 0.44},
	         {0.27, 0.04, 0.27},
	         {0.10, 0.03, 0.10},
	         {30, 60, 90, 120, 150},
	         {{2.16, 5.46, 4.93, 4.75, 5.36}, 4.53},
	         {{2.17, 5.48, 4.86, 4.28, 5.18}, 4.39},
	         {{0.43, 0.18, 0.13, 0.27, 0.39}, 0.28},
	         {{0.03, 0.04, 0.03, 0.10, 0.35}, 0.11}}};
}
}  // namespace

const std::vector<PaperSequence>& paperSequences()
{
	static const std::vector<PaperSequence> all = []
	{
		std::vector<PaperSequence> sequences = corridors();
		for (PaperSequence& sequence : lobbies()) sequences.push_back(std::move(sequence));
		return sequences;
	}();
	return all;
}

const PaperSequence& paperSequence(const std::string& name)
{
	std::string names;
	for (const PaperSequence& sequence : paperSequences())
	{
		if (sequence.name == name) return sequence;
		names += (names.empty() ? "" : ", ") + sequence.name;
	}
	throw Error("there is no sequence " + name + "; the paper's are " + names);
}
}  // namespace viwo::experiments
