#include <mrpt/config/CConfigFile.h>
#include <viwo/core/Error.h>
#include <viwo/core/Options.h>

#include <filesystem>

#include "WorldElements.h"
#include "viwo/sim/World.h"

namespace viwo::sim
{
namespace
{
struct MaterialOptions : Options<MaterialOptions>
{
	Material material;

	template <class Visitor>
	void visit(Visitor& v)
	{
		v.choice("texture", material.texture, "pattern",
		         {"plain", "checker", "paint", "tiles", "carpet", "wood", "fabric", "leaves", "metal", "poster", "notices", "sign", "door",
		          "light", "window", "scuffs"});
		v("albedo", material.albedo, "mean reflectance for the camera", 0.0, 1.0);
		v("contrast", material.contrast, "strength of the pattern", 0.0, 1.0);
		v("cell_m", material.cell_m, "side of checker squares and tiles", 0.001, 10.0);
		v("emission", material.emission, "radiance of a lamp; 0: none", 0.0, 1000.0);
		v("reflectivity", material.reflectivity, "for the LiDAR", 0.0, 1.0);
		v("glass", material.glass, "LiDAR rays may pass or be thrown off");
		v("seed", material.seed, "of the pattern", 0, 1000000);
	}
};

struct WorldOptions : Options<WorldOptions>
{
	double ambient = 0.35;

	template <class Visitor>
	void visit(Visitor& v)
	{
		v("ambient", ambient, "light that comes from everywhere, share of nominal illumination", 0.0, 1.0);
	}
};

struct Sections
{
	WorldOptions world;
	std::vector<std::unique_ptr<MaterialOptions>> materials;
	std::vector<std::pair<std::string, std::unique_ptr<WorldElement>>> elements;
	std::vector<OptionsSection> list;
};

/** One object for every section that the file has. */
Sections sectionsOf(const std::string& path)
{
	Sections sections;
	std::vector<std::string> names;
	mrpt::config::CConfigFile(path).getAllSections(names);
	sections.list.push_back({"world", nullptr});
	for (const auto& name : names)
	{
		const size_t dot = name.find('.');
		if (name == "world") continue;
		if (dot != std::string::npos && name.compare(0, dot, "material") == 0)
		{
			sections.materials.push_back(std::make_unique<MaterialOptions>());
			sections.materials.back()->material.name = name.substr(dot + 1);
			sections.list.push_back({name, sections.materials.back().get()});
			continue;
		}
		auto element = dot == std::string::npos ? nullptr : makeWorldElement(name.substr(0, dot));
		if (!element)
			throw Error(path + ": [" + name +
			            "]: expected [world], [material.NAME] or [KIND.NAME] with KIND one of: " + worldElementKinds());
		sections.list.push_back({name, &element->options()});
		sections.elements.emplace_back(name, std::move(element));
	}
	return sections;
}
}  // namespace

World World::load(const std::string& ini_path)
{
	if (!std::filesystem::is_regular_file(ini_path)) throw Error(ini_path + ": there is no such world file; check its name");
	Sections sections = sectionsOf(ini_path);
	sections.list.front().options = &sections.world;
	loadOptions(ini_path, sections.list);

	std::vector<Material> materials;
	for (const auto& m : sections.materials) materials.push_back(m->material);
	SurfaceList list(materials);
	for (const auto& [name, element] : sections.elements)
	{
		try
		{
			element->appendTo(list);
		}
		catch (const Error& e)
		{
			throw Error(ini_path + ": [" + name + "] " + e.what());
		}
	}
	if (list.surfaces.empty()) throw Error(ini_path + ": the world is empty; add a section such as [room.NAME]");
	return World(materials, list.surfaces, sections.world.ambient);
}
}  // namespace viwo::sim
