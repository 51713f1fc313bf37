#include "Room.h"

#include <viwo/core/Error.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace viwo::sim
{
namespace
{
using Eigen::Vector3d;
using Numbers = std::vector<double>;

struct Opening
{
	double from, to, height;
};

/** One wall: an upright rectangle from `begin` towards `right`, as seen from within the room. */
struct Wall
{
	Vector3d begin, right;
	double length_m;
	double along_begin;  // coordinate of `begin` on the axis that openings are given in
	double along_sign;   // +1 when that axis runs to the right
};

class Room : public WorldElement, public Options<Room>
{
   public:
	mrpt::config::CLoadableOptions& options() override { return *this; }

	template <class Visitor>
	void visit(Visitor& v)
	{
		v("x_m", x_m, "from and to");
		v("y_m", y_m, "from and to");
		v("height_m", height_m, "of the ceiling over the floor at z = 0", 0.5, 100.0);
		v("wall", wall, "material");
		v("floor", floor, "material");
		v("ceiling", ceiling, "material");
		v("skirting", skirting, "material; empty: none");
		v("skirting_height_m", skirting_height_m, "", 0.01, 1.0);
		v("openings_x0", openings[0], "in the wall at the lower x: y from, y to, height, and so on");
		v("openings_x1", openings[1], "in the wall at the higher x");
		v("openings_y0", openings[2], "in the wall at the lower y: x from, x to, height");
		v("openings_y1", openings[3], "in the wall at the higher y");
	}

	void appendTo(SurfaceList& list) const override
	{
		if (x_m.size() != 2 || y_m.size() != 2 || !(x_m[0] < x_m[1]) || !(y_m[0] < y_m[1]))
			throw Error("x_m, y_m: expected two rising numbers each");
		const double x0 = x_m[0], x1 = x_m[1], y0 = y_m[0], y1 = y_m[1];
		const Vector3d X = Vector3d::UnitX(), Y = Vector3d::UnitY();
		list.surfaces.push_back({{x0, y0, 0}, X, Y, x1 - x0, y1 - y0, list.material(floor), list.nextVariant(), false});
		list.surfaces.push_back({{x0, y1, height_m}, X, -Y, x1 - x0, y1 - y0, list.material(ceiling), list.nextVariant(), false});
		// Who looks at the wall at the lower x has growing y on his right, and so on.
		const std::array<Wall, 4> walls{Wall{{x0, y0, 0}, Y, y1 - y0, y0, 1}, Wall{{x1, y1, 0}, -Y, y1 - y0, y1, -1},
		                                Wall{{x1, y0, 0}, -X, x1 - x0, x1, -1}, Wall{{x0, y1, 0}, X, x1 - x0, x0, 1}};
		for (size_t i = 0; i < walls.size(); ++i) appendWall(list, walls[i], openingsOf(i, walls[i]));
	}

   private:
	/** Rising along the wall, from its begin. */
	std::vector<Opening> openingsOf(size_t side, const Wall& w) const
	{
		const Numbers& numbers = openings[side];
		if (numbers.size() % 3 != 0) throw Error("openings: expected from, to, height for each");
		std::vector<Opening> result;
		for (size_t i = 0; i < numbers.size(); i += 3)
		{
			const double a = w.along_sign * (numbers[i] - w.along_begin), b = w.along_sign * (numbers[i + 1] - w.along_begin);
			result.push_back({std::min(a, b), std::max(a, b), numbers[i + 2]});
		}
		std::sort(result.begin(), result.end(), [](const Opening& a, const Opening& b) { return a.from < b.from; });
		double last = 0;
		for (const auto& o : result)
		{
			if (o.from < last || o.to > w.length_m || !(o.height > 0 && o.height <= height_m))
				throw Error("openings: expected them within the wall and apart from each other");
			last = o.to;
		}
		return result;
	}

	void appendWall(SurfaceList& list, const Wall& w, const std::vector<Opening>& gaps) const
	{
		const size_t material = list.material(wall);
		double begin = 0;
		for (size_t i = 0; i <= gaps.size(); ++i)
		{
			const double end = i < gaps.size() ? gaps[i].from : w.length_m;
			if (end > begin) appendPiece(list, w, begin, end, 0, height_m, material);
			if (end > begin && !skirting.empty()) appendSkirting(list, w, begin, end);
			if (i == gaps.size()) break;
			if (gaps[i].height < height_m) appendPiece(list, w, gaps[i].from, gaps[i].to, gaps[i].height, height_m, material);
			begin = gaps[i].to;
		}
	}

	static void appendPiece(SurfaceList& list, const Wall& w, double begin, double end, double low, double high, size_t material)
	{
		list.surfaces.push_back({w.begin + begin * w.right + low * Vector3d::UnitZ(), w.right, Vector3d::UnitZ(), end - begin, high - low,
		                         material, list.nextVariant(), false});
	}

	void appendSkirting(SurfaceList& list, const Wall& w, double begin, double end) const
	{
		constexpr double kDepth_m = 0.012;
		const Vector3d out = w.right.cross(Vector3d::UnitZ());
		appendBox(list.surfaces, w.begin + 0.5 * (begin + end) * w.right + 0.5 * kDepth_m * out, {end - begin, kDepth_m, skirting_height_m},
		          std::atan2(w.right.y(), w.right.x()), list.material(skirting), list.nextVariant());
	}

	Numbers x_m, y_m;
	double height_m = 2.6;
	std::string wall, floor, ceiling, skirting;
	double skirting_height_m = 0.08;
	std::array<Numbers, 4> openings;
};
}  // namespace

std::unique_ptr<WorldElement> makeRoom()
{
	return std::make_unique<Room>();
}
}  // namespace viwo::sim
