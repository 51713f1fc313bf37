#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace viwo::sim
{
/** What is painted on a surface. Tiled kinds repeat over the surface; fitted kinds (poster, notices, sign, door, light, window) fill it
 * once. */
enum class TextureKind
{
	plain,
	checker,  //!< squares of cell_m: the first one (at u = v = 0) bright, albedo * (1 +- contrast)
	paint,    //!< painted plaster: faint mottling
	tiles,    //!< square tiles of cell_m with joints and specks
	carpet,
	wood,
	fabric,
	leaves,
	metal,
	poster,
	notices,  //!< board with paper sheets
	sign,
	door,
	light,
	window,
	scuffs  //!< paint with marks of trolleys and shoes in its lower part
};

/** What a surface looks like, to the camera and to the LiDAR. */
struct Material
{
	std::string name = "plain";
	TextureKind texture = TextureKind::plain;
	double albedo = 0.7;        //!< mean diffuse reflectance in the camera's band, 0..1
	double contrast = 0.5;      //!< strength of the pattern, 0..1
	double cell_m = 0.3;        //!< period of checker and tiles
	double emission = 0;        //!< radiance of a lamp, in units of a white wall at nominal illumination
	double reflectivity = 0.6;  //!< in the LiDAR's band, 0..1
	bool glass = false;         //!< a LiDAR ray may pass or be thrown off; the camera sees the pane itself
	int seed = 0;               //!< of the pattern
};

/** A rectangle in the world: origin_W + u * u_W + v * v_W, 0 <= u <= width_m, 0 <= v <= height_m. Its front is the side of u_W x v_W. */
struct Surface
{
	Eigen::Vector3d origin_W = Eigen::Vector3d::Zero();
	Eigen::Vector3d u_W = Eigen::Vector3d::UnitX();  //!< unit, right as seen from the front
	Eigen::Vector3d v_W = Eigen::Vector3d::UnitY();  //!< unit, perpendicular to u_W, up
	double width_m = 1;
	double height_m = 1;
	size_t material = 0;
	uint32_t variant = 0;    //!< tells apart the patterns of surfaces of one material
	bool two_sided = false;  //!< otherwise rays pass from behind

	Eigen::Vector3d normal_W() const { return u_W.cross(v_W); }
	Eigen::Vector3d point_W(double u_m, double v_m) const { return origin_W + u_m * u_W + v_m * v_W; }
};

/** Where a ray meets the world. */
struct Hit
{
	double distance_m = 0;
	size_t surface = 0;                                   //!< index into World::surfaces()
	double u_m = 0, v_m = 0;                              //!< on the surface
	Eigen::Vector3d normal_W = Eigen::Vector3d::UnitZ();  //!< unit, on the side the ray comes from
	double cos_incidence = 1;                             //!< of the angle between the ray and the normal; 0..1, 1 is head-on
	double reflectivity = 0;
	bool glass = false;
};

class RectangleTree;

/** A static scene of rectangles, world frame z up, floor at z = 0, metres. Immutable; const calls are safe from several threads. */
class World
{
   public:
	/** @throws Error when an axis is not of unit length, axes are not perpendicular, a side is not positive or a material is missing. */
	World(std::vector<Material> materials, std::vector<Surface> surfaces, double ambient = 0.35);

	/** Reads an INI world; the sections are described in share/viwo/worlds/README.md.
	 *  @throws Error naming file, section and key.
	 */
	static World load(const std::string& ini_path);

	/** First surface that the ray meets, exact in double precision; nothing within max_range_m.
	 *  @param direction_W of unit length.
	 */
	std::optional<Hit> castRay(const Eigen::Vector3d& origin_W, const Eigen::Vector3d& direction_W, double max_range_m) const;

	/** n points, uniform over the area of what can be seen from within the rooms (not behind a poster, not below a cupboard), for synthetic
	 *  feature tracks. Same seed, same points. @throws Error when hardly anything can be seen.
	 */
	std::vector<Eigen::Vector3d> samplePoints(size_t n, uint64_t seed) const;

	const std::vector<Surface>& surfaces() const { return surfaces_; }
	const std::vector<Material>& materials() const { return materials_; }
	const Material& materialOf(const Surface& s) const { return materials_[s.material]; }
	/** Light that reaches every point whatever is in between, in units of nominal illumination. */
	double ambient() const { return ambient_; }

   private:
	bool isVisible(const Surface& s, const Eigen::Vector3d& point_W) const;

	std::vector<Material> materials_;
	std::vector<Surface> surfaces_;
	double ambient_;
	std::shared_ptr<const RectangleTree> tree_;
};

/** Appends the faces of an upright box: `size_m` along its own axes, standing at `base_centre_W`, turned by yaw about z, fronts outwards.
 *  A box on the floor (z = 0) has no bottom face.
 */
void appendBox(std::vector<Surface>& surfaces, const Eigen::Vector3d& base_centre_W, const Eigen::Vector3d& size_m, double yaw_rad,
               size_t material, uint32_t variant = 0);

/** Appends an upright rectangle whose front looks along yaw (rad, about z), centred at `centre_W`. */
void appendPanel(std::vector<Surface>& surfaces, const Eigen::Vector3d& centre_W, double width_m, double height_m, double yaw_rad,
                 size_t material, uint32_t variant = 0);
}  // namespace viwo::sim
