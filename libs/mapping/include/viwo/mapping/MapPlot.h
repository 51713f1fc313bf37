#pragma once

#include <viwo/mapping/OccupancyImage.h>

#include <Eigen/Core>
#include <Eigen/StdVector>
#include <optional>
#include <string>
#include <vector>

namespace viwo
{
/** A colour, 0 to 255 each. */
struct PlotColour
{
	uint8_t red = 0, green = 0, blue = 0;
};

/** Colour of the curve of this index: Okabe and Ito's, which the colour-blind tell apart, too. */
PlotColour plotColour(size_t index);

/** What is drawn from above: a path, a cloud of points. A point that is not finite breaks a path. */
struct PlotLayer
{
	enum class Kind
	{
		path,
		points
	};
	std::string name;  //!< in the legend
	PlotColour colour;
	Kind kind = Kind::path;
	std::vector<Eigen::Vector2d> points_m;  //!< x, y in the map
	std::string file = {};                  //!< where they are from, for messages
};

/** A map from above with layers on top: equal axes, a grid with its metres, a bar of scale, a legend. Maps of more than 6000 cells a side,
 *  together with what else is drawn, are drawn with coarser ones.
 */
struct MapPlot
{
	std::string title;
	std::optional<OccupancyImage> map;
	std::vector<PlotLayer> layers;
};

/** As .png or .svg, by the name's extension; the same plot gives the same bytes.
 *  @throws Error: another extension, nothing to draw, a coordinate that is out of all reason, not writable.
 */
void saveMapPlot(const std::string& path, const MapPlot& plot);
}  // namespace viwo
