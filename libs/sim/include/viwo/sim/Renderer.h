#pragma once

#include <viwo/core/CameraModel.h>
#include <viwo/core/Options.h>
#include <viwo/core/Pose3.h>
#include <viwo/sim/GreyImage.h>
#include <viwo/sim/ImageEffects.h>
#include <viwo/sim/World.h>

#include <functional>
#include <memory>

namespace viwo::sim
{
/** How motion blur is made. */
struct RendererOptions : Options<RendererOptions>
{
	bool motion_blur = true;
	double blur_step_px = 1.5;
	int max_sub_exposures = 9;

	template <class Visitor>
	void visit(Visitor& v)
	{
		v("motion_blur", motion_blur, "average several sub-exposures when the image moves during the exposure");
		v("blur_step_px", blur_step_px, "largest movement between two sub-exposures, pixels", 0.1, 100.0);
		v("max_sub_exposures", max_sub_exposures, "most sub-exposures of a frame", 1, 99);
	}
};

/** Ray-caster on the CPU for worlds of rectangles: every pixel along its exact ray through the lens, textures averaged over the pixel's
 * area, outlines over 16 rays a pixel. The image depends on nothing but the arguments (same binary and type of processor). A renderer keeps
 * working memory: use one per thread.
 */
class Renderer
{
   public:
	/** Pose T_WC (optical axes) at s = 0 (shutter opens) to 1 (it closes). */
	using Motion = std::function<Pose3(double s)>;

	/** Paints the textures and computes the light of the world, which takes a second or so; keeps a copy of the world.
	 *  @throws Error when the camera is not calibrated or looks more than 86 deg off its axis.
	 */
	Renderer(const World& world, const CameraModel& camera, const RendererOptions& options = {}, const ImageEffectsOptions& effects = {});
	/** Shares textures and light with the original: cheap; for another thread. */
	Renderer(const Renderer& other);
	~Renderer();
	Renderer(Renderer&&) noexcept;
	Renderer& operator=(Renderer&&) noexcept;
	Renderer& operator=(const Renderer&) = delete;

	/** One frame of the camera. */
	GreyImage render(const Motion& T_WC, const Exposure& exposure);

	/** Light on the sensor at one moment, without any effect. */
	RadianceImage radiance(const Pose3& T_WC);

	/** Sub-exposures that the last render() averaged. */
	int lastSubExposures() const;

   private:
	class Impl;
	std::unique_ptr<Impl> impl_;
};
}  // namespace viwo::sim
