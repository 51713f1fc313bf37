#include "WorldElements.h"

#include <viwo/core/Error.h>

#include <cmath>

#include "Room.h"

namespace viwo::sim
{
namespace
{
using Eigen::Vector2d;
using Eigen::Vector3d;
using Numbers = std::vector<double>;

constexpr double kDegree_rad = M_PI / 180;

void expectCount(const char* key, const Numbers& numbers, size_t count)
{
	if (numbers.size() != count)
		throw Error(std::string(key) + ": expected " + std::to_string(count) + " numbers, not " + std::to_string(numbers.size()));
}

void expectPositive(const char* key, const Numbers& numbers)
{
	for (double n : numbers)
		if (!(n > 0)) throw Error(std::string(key) + ": expected sizes above 0");
}

/** Options of an element, and how often it repeats. */
template <class Derived>
class Element : public WorldElement, public Options<Derived>
{
   public:
	mrpt::config::CLoadableOptions& options() override { return *this; }
	void appendTo(SurfaceList& list) const override
	{
		expectCount("step_m", step_m, 3);
		for (int i = 0; i < count; ++i) static_cast<const Derived&>(*this).appendOne(list, i * Vector3d(step_m[0], step_m[1], step_m[2]));
	}

   protected:
	template <class Visitor>
	void visitRepetition(Visitor& v)
	{
		v("count", count, "how many, each moved by step_m against the one before", 1, 1000);
		v("step_m", step_m, "x y z");
	}
	int count = 1;
	Numbers step_m{0, 0, 0};
};

class Box : public Element<Box>
{
   public:
	template <class Visitor>
	void visit(Visitor& v)
	{
		v("base_m", base_m, "x y z of the middle of its base");
		v("size_m", size_m, "along its own x, y, z");
		v("yaw_deg", yaw_deg, "turn about z");
		v("material", material, "of all faces");
		visitRepetition(v);
	}
	void appendOne(SurfaceList& list, const Vector3d& shift) const
	{
		expectCount("base_m", base_m, 3);
		expectCount("size_m", size_m, 3);
		expectPositive("size_m", size_m);
		appendBox(list.surfaces, Vector3d(base_m.data()) + shift, Vector3d(size_m.data()), yaw_deg * kDegree_rad, list.material(material),
		          list.nextVariant());
	}

   private:
	Numbers base_m{0, 0, 0}, size_m{1, 1, 1};
	double yaw_deg = 0;
	std::string material;
};

class Rect : public Element<Rect>
{
   public:
	template <class Visitor>
	void visit(Visitor& v)
	{
		v("origin_m", origin_m, "x y z of a corner");
		v("u_m", u_m, "first side, as a vector: to the right as seen from the front");
		v("v_m", v_m, "second side, perpendicular: up as seen from the front");
		v("two_sided", two_sided, "to be seen from behind too");
		v("material", material, "of the face");
		visitRepetition(v);
	}
	void appendOne(SurfaceList& list, const Vector3d& shift) const
	{
		expectCount("origin_m", origin_m, 3);
		expectCount("u_m", u_m, 3);
		expectCount("v_m", v_m, 3);
		const Vector3d u(u_m.data()), v(v_m.data());
		if (!(u.norm() > 0 && v.norm() > 0) || std::abs(u.dot(v)) > 1e-9 * u.norm() * v.norm())
			throw Error("u_m, v_m: expected perpendicular sides");
		list.surfaces.push_back({Vector3d(origin_m.data()) + shift, u.normalized(), v.normalized(), u.norm(), v.norm(),
		                         list.material(material), list.nextVariant(), two_sided});
	}

   private:
	Numbers origin_m{0, 0, 0}, u_m{1, 0, 0}, v_m{0, 0, 1};
	bool two_sided = true;
	std::string material;
};

/** Axes of something that hangs on a wall: `out` away from it, `right` as one sees it. */
struct WallAxes
{
	explicit WallAxes(double yaw_deg)
	    : yaw_rad(yaw_deg * kDegree_rad), out(std::cos(yaw_rad), std::sin(yaw_rad), 0), right(-std::sin(yaw_rad), std::cos(yaw_rad), 0)
	{
	}
	double yaw_rad;
	Vector3d out, right;
};

/** A box of depth, width, height whose back touches the plane through `back_base`. */
void appendOnWall(SurfaceList& list, const WallAxes& axes, const Vector3d& back_base, const Vector3d& depth_width_height, size_t material)
{
	appendBox(list.surfaces, back_base + 0.5 * depth_width_height.x() * axes.out, depth_width_height, axes.yaw_rad, material,
	          list.nextVariant());
}

class Panel : public Element<Panel>
{
   public:
	template <class Visitor>
	void visit(Visitor& v)
	{
		v("centre_m", centre_m, "x y z of its middle, on the wall");
		v("size_m", size_m, "width and height");
		v("depth_m", depth_m, "how far its face stands out from the wall", 0.001, 1.0);
		v("yaw_deg", yaw_deg, "direction that it looks to");
		v("material", material, "of the face");
		v("rim", rim, "material of the rim; empty: no rim");
		visitRepetition(v);
	}
	void appendOne(SurfaceList& list, const Vector3d& shift) const
	{
		expectCount("centre_m", centre_m, 3);
		expectCount("size_m", size_m, 2);
		expectPositive("size_m", size_m);
		const WallAxes axes(yaw_deg);
		const Vector3d centre = Vector3d(centre_m.data()) + shift;
		// The rim's box ends half a millimetre behind the face.
		if (!rim.empty())
			appendOnWall(list, axes, centre - 0.5 * size_m[1] * Vector3d::UnitZ(), {depth_m - 0.0005, size_m[0], size_m[1]},
			             list.material(rim));
		appendPanel(list.surfaces, centre + depth_m * axes.out, size_m[0], size_m[1], axes.yaw_rad, list.material(material),
		            list.nextVariant());
	}

   private:
	Numbers centre_m{0, 0, 1.5}, size_m{0.6, 0.8};
	double depth_m = 0.01, yaw_deg = 0;
	std::string material, rim;
};

class Door : public Element<Door>
{
   public:
	template <class Visitor>
	void visit(Visitor& v)
	{
		v("base_m", base_m, "x y z of the middle of its threshold, on the wall");
		v("size_m", size_m, "width and height of the leaf");
		v("yaw_deg", yaw_deg, "direction that it looks to");
		v("leaf", leaf, "material of the leaf");
		v("frame", frame, "material of the frame");
		v("handle", handle, "material of the handle; empty: none");
		v("sign", sign, "material of the plate beside it; empty: none");
		visitRepetition(v);
	}
	void appendOne(SurfaceList& list, const Vector3d& shift) const
	{
		expectCount("base_m", base_m, 3);
		expectCount("size_m", size_m, 2);
		expectPositive("size_m", size_m);
		const WallAxes axes(yaw_deg);
		const Vector3d base = Vector3d(base_m.data()) + shift, up = Vector3d::UnitZ();
		const double width = size_m[0], height = size_m[1];
		constexpr double kPost_m = 0.06, kFrameDepth_m = 0.05, kLeafDepth_m = 0.02;
		appendPanel(list.surfaces, base + kLeafDepth_m * axes.out + 0.5 * height * up, width, height, axes.yaw_rad, list.material(leaf),
		            list.nextVariant());
		const size_t frame_material = list.material(frame);
		for (double side : {-0.5, 0.5})
			appendOnWall(list, axes, base + side * (width + kPost_m) * axes.right, {kFrameDepth_m, kPost_m, height}, frame_material);
		appendOnWall(list, axes, base + height * up, {kFrameDepth_m, width + 2 * kPost_m, kPost_m}, frame_material);
		if (!handle.empty())
		{
			const size_t metal = list.material(handle);
			const Vector3d at = base + kLeafDepth_m * axes.out + (0.5 * width - 0.07) * axes.right + 1.03 * up;
			appendOnWall(list, axes, at, {0.05, 0.025, 0.025}, metal);
			appendOnWall(list, axes, at + 0.05 * axes.out - 0.05 * axes.right, {0.018, 0.13, 0.022}, metal);
		}
		if (!sign.empty())
			appendPanel(list.surfaces, base + 0.006 * axes.out + (0.5 * width + 0.25) * axes.right + 1.55 * up, 0.18, 0.15, axes.yaw_rad,
			            list.material(sign), list.nextVariant());
	}

   private:
	Numbers base_m{0, 0, 0}, size_m{0.9, 2.05};
	double yaw_deg = 0;
	std::string leaf, frame, handle, sign;
};

class Lamp : public Element<Lamp>
{
   public:
	template <class Visitor>
	void visit(Visitor& v)
	{
		v("centre_m", centre_m, "x y z of the middle of its lower side");
		v("size_m", size_m, "along x and y");
		v("height_m", height_m, "of its housing", 0.001, 1.0);
		v("material", material, "of the lower side: the one that shines");
		v("housing", housing, "material of the housing");
		visitRepetition(v);
	}
	void appendOne(SurfaceList& list, const Vector3d& shift) const
	{
		expectCount("centre_m", centre_m, 3);
		expectCount("size_m", size_m, 2);
		expectPositive("size_m", size_m);
		const Vector3d centre = Vector3d(centre_m.data()) + shift;
		appendBox(list.surfaces, centre + 0.001 * Vector3d::UnitZ(), {size_m[0], size_m[1], height_m - 0.001}, 0, list.material(housing),
		          list.nextVariant());
		list.surfaces.push_back({centre + Vector3d(-0.5 * size_m[0], 0.5 * size_m[1], 0), Vector3d::UnitX(), -Vector3d::UnitY(), size_m[0],
		                         size_m[1], list.material(material), list.nextVariant(), false});
	}

   private:
	Numbers centre_m{0, 0, 2.5}, size_m{0.6, 0.6};
	double height_m = 0.05;
	std::string material, housing;
};
}  // namespace

size_t SurfaceList::material(const std::string& name) const
{
	std::string known;
	for (size_t i = 0; i < materials_.size(); ++i)
	{
		if (materials_[i].name == name) return i;
		known += (i ? ", " : "") + materials_[i].name;
	}
	throw Error("material '" + name + "' is not defined: add [material." + name + "] or use one of: " + known);
}

std::unique_ptr<WorldElement> makeWorldElement(const std::string& kind)
{
	if (kind == "room") return makeRoom();
	if (kind == "box") return std::make_unique<Box>();
	if (kind == "rect") return std::make_unique<Rect>();
	if (kind == "panel") return std::make_unique<Panel>();
	if (kind == "door") return std::make_unique<Door>();
	if (kind == "lamp") return std::make_unique<Lamp>();
	return nullptr;
}

std::string worldElementKinds()
{
	return "room, box, rect, panel, door, lamp";
}
}  // namespace viwo::sim
