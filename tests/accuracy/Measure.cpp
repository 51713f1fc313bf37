#include "Measure.h"

#include <viwo/core/Error.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <set>

namespace viwo::accuracy
{
namespace
{
std::string number(double value)
{
	char text[32];
	std::snprintf(text, sizeof text, "%.3g", value);
	return text;
}

Score failure(Score score, const std::string& problem)
{
	score.ate_m = score.ate_xy_m = std::numeric_limits<double>::infinity();
	score.problem = problem;
	return score;
}
}  // namespace

Score scoreOf(const Outcome& outcome, double required_coverage)
{
	Score score;
	score.length_m = std::numeric_limits<double>::quiet_NaN();
	if (outcome.failed()) return failure(score, outcome.error);
	try
	{
		const TrajectoryErrors errors = outcome.errors();
		score = {errors.ate_xyz_m, errors.ate_xy_m, outcome.truth().length_m(), errors.coverage, ""};
	}
	catch (const Error& e)
	{
		return failure(score, e.what());
	}
	if (score.coverage < required_coverage) return failure(score, "coverage only " + number(score.coverage));
	return score;
}

double worst(const std::vector<double>& values)
{
	double result = -std::numeric_limits<double>::infinity();
	for (const double value : values)
	{
		if (std::isnan(value)) return value;
		result = std::max(result, value);
	}
	return values.empty() ? std::numeric_limits<double>::quiet_NaN() : result;
}

std::string listOf(const std::string& what, const std::vector<double>& values, double factor, const std::string& unit)
{
	std::string text = what;
	for (const double value : values) text += " " + number(factor * value);
	return unit.empty() ? text : text + " " + unit;
}

std::string problemsOf(const std::vector<Score>& scores)
{
	std::set<std::string> problems;
	for (const Score& score : scores)
		if (!score.problem.empty()) problems.insert(score.problem);
	std::string text;
	for (const std::string& problem : problems) text += "; " + problem;
	return text;
}

std::vector<double> each(const std::vector<Score>& scores, const std::function<double(const Score&)>& member)
{
	std::vector<double> values;
	for (const Score& score : scores) values.push_back(member(score));
	return values;
}
}  // namespace viwo::accuracy
