#pragma once

#include <viwo/evaluation/PlotSvg.h>
#include <viwo/evaluation/Report.h>

#include <string>
#include <vector>

namespace viwo
{
/** A trajectory and its name in the legend. */
struct NamedTrajectory
{
	std::string name;
	Trajectory trajectory;
};

/** Estimates against their reference, as SVG. */
struct TrajectoryPictures
{
	std::string paths;                //!< from above, aligned
	std::string error_over_time;      //!< distance from the reference, aligned
	std::string drift_over_distance;  //!< relative error of pieces of growing length, % of the length
};

/** @throws Error when an estimate has no two poses in common with the reference. */
TrajectoryPictures trajectoryPictures(const Trajectory& reference, const std::vector<NamedTrajectory>& estimates,
                                      const EvaluationOptions& options, PlotColours colours);

/** A page of the errors of a user's own trajectories. */
std::string evaluationHtml(const std::string& reference, const EvaluationOptions& options, const std::vector<EstimateReport>& reports,
                           const TrajectoryPictures& pictures);
}  // namespace viwo
