#include <mrpt/core/format.h>
#include <viwo/core/AtomicFile.h>
#include <viwo/core/Error.h>
#include <viwo/core/Svg.h>
#include <viwo/mapping/MapPlot.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "PlotCanvas.h"

namespace viwo
{
namespace
{
constexpr int kLongSide_px = 900, kShortestSide_px = 260;
constexpr int kLeft_px = 60, kRight_px = 20, kTop_px = 36, kAxis_px = 44, kLegendLine_px = 20;
constexpr int kGridLines = 10;
constexpr int kLargestSide_px = 6000;
constexpr double kLeastMargin_m = 0.5, kFarthest_m = 1e8;
constexpr double kWidestTitle_px = 2000;
constexpr double kSwatch_px = 24, kCharacter_px = 8.5;
constexpr PlotColour kInk{32, 33, 36}, kMuted{95, 99, 104}, kGrid{178, 184, 194}, kPaper{255, 255, 255};

using Bounds = Eigen::AlignedBox2d;

Bounds boundsOf(const OccupancyImage& map)
{
	const Eigen::Vector2d low(map.min_x_m, map.min_y_m);
	return {low, low + map.resolution_m * Eigen::Vector2d(map.columns, map.rows)};
}

/** Of what is drawn, m. */
Bounds boundsOf(const MapPlot& plot)
{
	Bounds bounds;
	if (plot.map) bounds.extend(boundsOf(*plot.map));
	for (const PlotLayer& layer : plot.layers)
		for (const Eigen::Vector2d& p : layer.points_m)
		{
			if (!p.allFinite()) continue;
			if (p.cwiseAbs().maxCoeff() > kFarthest_m)
				throw Error((layer.file.empty() ? layer.name : layer.file) +
				            mrpt::format(": x = %.4g m, y = %.4g m cannot be drawn; correct the file", p.x(), p.y()));
			bounds.extend(p);
		}
	if (bounds.isEmpty()) throw Error("nothing to draw: map and trajectories are empty");
	return bounds;
}

/** A map with cells so large that the whole picture has a size that programs open. */
MapPlot ofBearableSize(MapPlot plot)
{
	if (!plot.map) return plot;
	const double cells = boundsOf(plot).sizes().maxCoeff() / plot.map->resolution_m, factor = std::ceil(cells / kLargestSide_px);
	if (factor > std::max(plot.map->columns, plot.map->rows))
		throw Error("beside all else, which spans " + onGrid(cells * plot.map->resolution_m, 1) +
		            " m, the map is smaller than a pixel; draw them without each other");
	if (factor > 1) plot.map = coarser(*plot.map, static_cast<int>(factor));
	return plot;
}

/** Where metres fall on the paper. Cells of a map cover whole pixels. */
class Paper
{
   public:
	explicit Paper(const MapPlot& plot)
	{
		const Bounds bounds = boundsOf(plot);
		Eigen::Vector2d low = bounds.min(), high = bounds.max();
		if (!plot.map)
		{
			const double margin_m = std::max(0.05 * (high - low).maxCoeff(), kLeastMargin_m);
			low.array() -= margin_m;
			high.array() += margin_m;
		}
		const double extent_m = (high - low).maxCoeff();
		scale_ = kLongSide_px / extent_m;
		if (plot.map)
		{
			cell_px_ = std::max(1, static_cast<int>(kLongSide_px * plot.map->resolution_m / extent_m));
			scale_ = cell_px_ / plot.map->resolution_m;
		}
		const Eigen::Vector2d missing = (Eigen::Vector2d::Constant(kShortestSide_px / scale_) - (high - low)).cwiseMax(0.0);
		low_m_ = low - 0.5 * missing;
		high_m_ = high + 0.5 * missing;
		step_m_ = niceStep((high_m_ - low_m_).maxCoeff(), kGridLines);
	}

	Eigen::Vector2d at(const Eigen::Vector2d& p_m) const
	{
		return {kLeft_px + scale_ * (p_m.x() - low_m_.x()), kTop_px + scale_ * (high_m_.y() - p_m.y())};
	}
	double right() const { return kLeft_px + scale_ * (high_m_.x() - low_m_.x()); }
	double bottom() const { return kTop_px + scale_ * (high_m_.y() - low_m_.y()); }
	double scale() const { return scale_; }
	double step_m() const { return step_m_; }
	int cell_px() const { return cell_px_; }
	const Eigen::Vector2d& low_m() const { return low_m_; }
	const Eigen::Vector2d& high_m() const { return high_m_; }

   private:
	Eigen::Vector2d low_m_, high_m_;
	double scale_ = 1, step_m_ = 1;
	int cell_px_ = 1;
};

struct LegendPlace
{
	double x = 0, y = 0;
};

/** As many names in a line as go in. */
std::vector<LegendPlace> legendPlaces(const MapPlot& plot, const Paper& paper)
{
	std::vector<LegendPlace> places;
	double x = kLeft_px, y = paper.bottom() + kAxis_px + 16;
	for (const PlotLayer& layer : plot.layers)
	{
		const double width = kSwatch_px + 26 + kCharacter_px * static_cast<double>(layer.name.size());
		if (x > kLeft_px && x + width > std::max(paper.right(), static_cast<double>(kLongSide_px)))
		{
			x = kLeft_px;
			y += kLegendLine_px;
		}
		places.push_back({x, y});
		x += width;
	}
	return places;
}

/** What lies beyond the map is as unknown as what is unknown within. */
void drawMap(const OccupancyImage& map, const Paper& paper, PlotCanvas& canvas)
{
	const uint8_t unknown = OccupancyImage::kUnknown;
	canvas.fill({kLeft_px, kTop_px}, {paper.right() - kLeft_px, paper.bottom() - kTop_px}, {unknown, unknown, unknown});
	canvas.cells(paper.at({map.min_x_m, map.min_y_m + map.rows * map.resolution_m}), map, paper.cell_px());
}

void drawGrid(const Paper& paper, PlotCanvas& canvas)
{
	const double step = paper.step_m();
	for (double k = std::ceil(paper.low_m().x() / step); k * step <= paper.high_m().x(); k += 1)
	{
		const double x = paper.at({k * step, 0}).x();
		canvas.polyline({{x, kTop_px}, {x, paper.bottom()}}, kGrid, 1);
		canvas.text({x, paper.bottom() + 17}, onGrid(k * step, step), kMuted, TextAnchor::middle);
	}
	for (double k = std::ceil(paper.low_m().y() / step); k * step <= paper.high_m().y(); k += 1)
	{
		const double y = paper.at({0, k * step}).y();
		canvas.polyline({{kLeft_px, y}, {paper.right(), y}}, kGrid, 1);
		canvas.text({kLeft_px - 6, y + 4}, onGrid(k * step, step), kMuted, TextAnchor::end);
	}
	canvas.polyline(
	    {{kLeft_px, kTop_px}, {paper.right(), kTop_px}, {paper.right(), paper.bottom()}, {kLeft_px, paper.bottom()}, {kLeft_px, kTop_px}},
	    kMuted, 1);
	canvas.text({0.5 * (kLeft_px + paper.right()), paper.bottom() + 36}, "x, y in m", kMuted, TextAnchor::middle);
}

void drawScaleBar(const Paper& paper, PlotCanvas& canvas)
{
	const double length = paper.scale() * paper.step_m(), right = paper.right() - 28, left = right - length, y = paper.bottom() - 18;
	canvas.polyline({{left - 2, y - 6}, {right + 2, y - 6}}, kPaper, 28);
	for (const auto& [colour, width] : {std::pair{kPaper, 7.0}, std::pair{kInk, 3.0}})
		canvas.polyline({{left, y}, {right, y}}, colour, width);
	canvas.text({0.5 * (left + right), y - 8}, onGrid(paper.step_m(), paper.step_m()) + " m", kInk, TextAnchor::middle);
}

/** No line would show it. */
bool standsStill(const std::vector<Eigen::Vector2d>& piece)
{
	return !piece.empty() && std::all_of(piece.begin(), piece.end(), [&](const auto& p) { return (p - piece.front()).norm() < 1; });
}

void drawLayer(const PlotLayer& layer, const Paper& paper, PlotCanvas& canvas)
{
	std::vector<Eigen::Vector2d> piece;
	const auto flush = [&]
	{
		if (standsStill(piece))
			canvas.dot(piece.front(), layer.colour, 4);
		else if (!piece.empty())
			canvas.polyline(piece, layer.colour, 2);
		piece.clear();
	};
	for (const Eigen::Vector2d& p_m : layer.points_m)
	{
		if (!p_m.allFinite())
		{
			flush();
			continue;
		}
		if (layer.kind == PlotLayer::Kind::points)
			canvas.dot(paper.at(p_m), layer.colour, 1.5);
		else
			piece.push_back(paper.at(p_m));
	}
	flush();
}

void drawLegend(const MapPlot& plot, const std::vector<LegendPlace>& places, PlotCanvas& canvas)
{
	for (size_t i = 0; i < places.size(); ++i)
	{
		const PlotLayer& layer = plot.layers[i];
		const auto [x, y] = places[i];
		if (layer.kind == PlotLayer::Kind::points)
			canvas.dot({x + 0.5 * kSwatch_px, y - 4}, layer.colour, 3);
		else
			canvas.polyline({{x, y - 4}, {x + kSwatch_px, y - 4}}, layer.colour, 3);
		canvas.text({x + kSwatch_px + 6, y}, layer.name, kInk, TextAnchor::start);
	}
}
}  // namespace

PlotColour plotColour(size_t index)
{
	static const PlotColour kColours[] = {{0, 114, 178}, {213, 94, 0}, {0, 158, 115}, {204, 121, 167}, {230, 159, 0}, {86, 180, 233}};
	return kColours[index % (sizeof kColours / sizeof *kColours)];
}

void saveMapPlot(const std::string& path, const MapPlot& given)
{
	const std::string extension = std::filesystem::path(path).extension().string();
	if (extension != ".png" && extension != ".svg") throw Error(path + ": a picture's name ends in .png or .svg");
	AtomicFile file(path);
	const MapPlot plot = ofBearableSize(given);
	const Paper paper(plot);
	const std::vector<LegendPlace> places = legendPlaces(plot, paper);
	const double legend_end = places.empty() ? paper.bottom() + kAxis_px : places.back().y;
	const double title_end = kLeft_px + kCharacter_px * static_cast<double>(plot.title.size());
	const int width = static_cast<int>(std::max({paper.right(), kLongSide_px * 0.5, std::min(title_end, kWidestTitle_px)})) + kRight_px,
	          height = static_cast<int>(legend_end) + 14;
	const auto canvas = extension == ".png" ? pngCanvas(width, height) : svgCanvas(width, height);
	if (plot.map) drawMap(*plot.map, paper, *canvas);
	drawGrid(paper, *canvas);
	for (const PlotLayer& layer : plot.layers) drawLayer(layer, paper, *canvas);
	drawScaleBar(paper, *canvas);
	drawLegend(plot, places, *canvas);
	canvas->text({kLeft_px, 22}, plot.title, kInk, TextAnchor::start);
	const std::string bytes = canvas->finish();
	file.stream().write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
	file.commit();
}
}  // namespace viwo
