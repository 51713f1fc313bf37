#pragma once

#include <viwo/core/Trajectory.h>
#include <viwo/evaluation/TrajectoryErrors.h>

#include <string>
#include <vector>

namespace viwo
{
/** A path seen from above, with what the legend says of it. */
struct PlotCurve
{
	std::string name;
	std::vector<Eigen::Vector2d> points_m;  //!< x, y in the axes of the reference
};

/** The reference from above. */
PlotCurve plotCurve(const std::string& name, const Trajectory& reference);

/** Aligned poses from above. */
PlotCurve plotCurve(const std::string& name, const std::vector<MatchedPose>& matches);

/** Short names of result files for a legend: "wheel" for out/wheel/trajectory.tum, the file's own name where all names would be alike. */
std::vector<std::string> legendNames(const std::vector<std::string>& paths);

/** Colours of a picture: those of a file of its own, on white, or those of the page it stands in, light or dark. */
enum class PlotColours
{
	light,
	page
};

/** A picture of trajectories in x-y: equal axes, a grid with its metres, a bar of scale, a legend. The first curve is the
 * reference, drawn wide and grey below the others. Plain SVG 1.1 text that needs nothing else; the same curves give the same bytes.
 */
std::string toSvg(const std::vector<PlotCurve>& curves, const std::string& title, PlotColours colours = PlotColours::light);

/** Written to a temporary name and renamed. @throws Error when it cannot be written. */
void saveSvg(const std::string& path, const std::vector<PlotCurve>& curves, const std::string& title);
}  // namespace viwo
