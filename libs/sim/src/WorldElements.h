#pragma once

#include <viwo/core/Options.h>
#include <viwo/sim/World.h>

#include <memory>
#include <string>
#include <vector>

namespace viwo::sim
{
/** What elements are appended to: surfaces, and the materials that they name. */
class SurfaceList
{
   public:
	explicit SurfaceList(const std::vector<Material>& materials) : materials_(materials) {}

	/** @throws Error that lists the materials there are. */
	size_t material(const std::string& name) const;
	/** Another one each time, so that no two posters are alike. */
	uint32_t nextVariant() { return variant_++; }

	std::vector<Surface> surfaces;

   private:
	const std::vector<Material>& materials_;
	uint32_t variant_ = 0;
};

/** One section of a world file that becomes surfaces. */
class WorldElement
{
   public:
	virtual ~WorldElement() = default;
	virtual mrpt::config::CLoadableOptions& options() = 0;
	virtual void appendTo(SurfaceList& list) const = 0;
};

/** The element of a section [kind.name]; null when there is no such kind. */
std::unique_ptr<WorldElement> makeWorldElement(const std::string& kind);

/** "room, box, ..." for messages. */
std::string worldElementKinds();
}  // namespace viwo::sim
