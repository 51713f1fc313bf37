#pragma once

#include <viwo/evaluation/Json.h>
#include <viwo/evaluation/Table.h>
#include <viwo/experiments/Request.h>
#include <viwo/experiments/Runner.h>

#include <string>
#include <vector>

/** What each source of error costs: the drives are simulated with that source alone, and with all but that one. @file */
namespace viwo::experiments
{
/** Something that the simulator can leave out. */
struct ErrorSource
{
	std::string name;              //!< e.g. "slips"
	std::vector<std::string> off;  //!< section.key=value of the rig that switch it off
};

/** All that the rig of the sequences does wrong. */
const std::vector<ErrorSource>& errorSources();

/** ATE x-y-z of mode viwo on one sequence, m; medians over the seeds. Infinite where a run has no figure, NaN while one is open. */
struct ErrorBudget
{
	std::string sequence;
	double all_m = 0, none_m = 0;
	std::vector<double> alone_m, without_m;  //!< in the order of errorSources()
	std::vector<std::string> problems;       //!< runs that failed, a line each
};

void planErrorBudget(Runner& runner, const Request& request);

/** One for each sequence of Request::error_budget. @pre planned, and execute() was called. */
std::vector<ErrorBudget> errorBudgets(const Runner& runner, const Request& request);

Table errorBudgetTable(const std::vector<ErrorBudget>& budgets);
Json errorBudgetJson(const std::vector<ErrorBudget>& budgets);
}  // namespace viwo::experiments
