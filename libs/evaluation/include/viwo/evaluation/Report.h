#pragma once

#include <viwo/evaluation/Consistency.h>
#include <viwo/evaluation/Json.h>
#include <viwo/evaluation/TrajectoryErrors.h>

#include <optional>
#include <string>
#include <vector>

namespace viwo
{
/** The errors of one estimate under the name of its file. */
struct EstimateReport
{
	std::string name;
	TrajectoryErrors errors;
	std::optional<Consistency> consistency;
};

/** Keys ate_xy_m, ate_z_m, ate_xyz_m, rpe_trans_percent, yaw_rmse_deg, length_m, matched, coverage, and the rest of TrajectoryErrors. */
Json toJson(const EstimateReport& report);

/** `reference`, `alignment`, `max_gap_s` and an array `estimates`; of a single estimate the keys are at top level too. */
Json toJson(const std::string& reference, const EvaluationOptions& options, const std::vector<EstimateReport>& reports);

/** One line an estimate, units in the header; columns of the consistency only when a report has it. */
std::string toTable(const std::vector<EstimateReport>& reports, const EvaluationOptions& options);
}  // namespace viwo
