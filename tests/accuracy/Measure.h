#pragma once

#include <viwo/experiments/Runner.h>

#include <functional>
#include <string>
#include <vector>

#include "StandardDrives.h"

namespace viwo::accuracy
{
using namespace experiments;

/** What the bars on accuracy compare: one run's error. */
struct Score
{
	double ate_m = 0;  //!< x-y-z; infinite when the run failed, or covers less than required of the reference
	double ate_xy_m = 0;
	double length_m = 0;  //!< of the true path
	double coverage = 0;
	std::string problem;  //!< empty, or why ate_m is infinite

	double percent() const { return problem.empty() ? 100 * ate_m / length_m : ate_m; }
	double percentXy() const { return problem.empty() ? 100 * ate_xy_m / length_m : ate_m; }
};

/** Every bar on the ATE demands that this much of the reference is covered. */
constexpr double kRequiredCoverage = 0.97;

/** @param required_coverage 0 for runs that others are compared with. */
Score scoreOf(const Outcome& outcome, double required_coverage = kRequiredCoverage);

double worst(const std::vector<double>& values);

/** "viwo 3.1 2.9 4.0 cm": the figures of the seeds, in their order. */
std::string listOf(const std::string& what, const std::vector<double>& values, double factor, const std::string& unit);

/** The problems of the scores, each once, after a semicolon. */
std::string problemsOf(const std::vector<Score>& scores);

/** member(score) of each. */
std::vector<double> each(const std::vector<Score>& scores, const std::function<double(const Score&)>& member);
}  // namespace viwo::accuracy
