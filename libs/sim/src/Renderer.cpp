#include "viwo/sim/Renderer.h"

#include <viwo/core/Ranking.h>
#include <viwo/core/So3.h>

#include <algorithm>
#include <cmath>

#include "FrameCaster.h"

namespace viwo::sim
{
class Renderer::Impl
{
   public:
	Impl(const World& world, const CameraModel& camera, const RendererOptions& options, const ImageEffectsOptions& effects)
	    : options_(options),
	      world_(world),
	      camera_(camera),
	      caster_(world, camera),
	      effects_(camera.width_px(), camera.height_px(), effects)
	{
		image_.width_px = camera.width_px();
		image_.height_px = camera.height_px();
	}

	const RadianceImage& expose(const Motion& T_WC)
	{
		clear();
		sub_exposures_ = subExposures(T_WC);
		const float weight = 1 / static_cast<float>(sub_exposures_);
		for (int i = 0; i < sub_exposures_; ++i) caster_.add(T_WC((i + 0.5) / sub_exposures_), weight, image_);
		return image_;
	}

	GreyImage render(const Motion& T_WC, const Exposure& exposure)
	{
		// A black frame needs no light.
		if (exposure.black) clear();
		return effects_.apply(exposure.black ? image_ : expose(T_WC), exposure);
	}

	int lastSubExposures() const { return sub_exposures_; }

   private:
	void clear() { image_.pixels.assign(static_cast<size_t>(image_.width_px) * static_cast<size_t>(image_.height_px), 0.0f); }

	/** By the image movement, during the exposure, of what is near. */
	int subExposures(const Motion& T_WC) const
	{
		if (!options_.motion_blur) return 1;
		const Pose3 first = T_WC(0), last = T_WC(1);
		const double turn_rad = so3::log(Eigen::Quaterniond(first.R.conjugate() * last.R)).norm(), way_m = (last.p - first.p).norm();
		if (turn_rad == 0 && way_m == 0) return 1;
		const double movement_px = camera_.meanFocal_px() * (turn_rad + way_m * nearInverseDepth(first));
		return std::clamp(static_cast<int>(std::ceil(movement_px / options_.blur_step_px)), 1, options_.max_sub_exposures);
	}

	/** Inverse depth (1/m) that nine tenths of the image stay below. */
	double nearInverseDepth(const Pose3& T_WC) const
	{
		constexpr int kColumns = 12, kRows = 9;
		constexpr double kFar_m = 100;
		std::vector<double> inverse_depths;
		for (int y = 0; y < kRows; ++y)
			for (int x = 0; x < kColumns; ++x)
			{
				const Eigen::Vector2d pixel((x + 0.5) / kColumns * camera_.width_px(), (y + 0.5) / kRows * camera_.height_px());
				const auto hit = world_.castRay(T_WC.p, (T_WC.R * camera_.unproject(pixel)).normalized(), kFar_m);
				inverse_depths.push_back(hit ? 1 / hit->distance_m : 0);
			}
		return valueAtRank(inverse_depths, inverse_depths.size() * 9 / 10);
	}

	RendererOptions options_;
	World world_;
	CameraModel camera_;
	FrameCaster caster_;
	ImageEffects effects_;
	RadianceImage image_;
	int sub_exposures_ = 0;
};

Renderer::Renderer(const World& world, const CameraModel& camera, const RendererOptions& options, const ImageEffectsOptions& effects)
    : impl_(std::make_unique<Impl>(world, camera, options, effects))
{
}

Renderer::Renderer(const Renderer& other) : impl_(std::make_unique<Impl>(*other.impl_)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

GreyImage Renderer::render(const Motion& T_WC, const Exposure& exposure)
{
	return impl_->render(T_WC, exposure);
}

RadianceImage Renderer::radiance(const Pose3& T_WC)
{
	// Both ends of the exposure alike: one moment, whatever the options.
	return impl_->expose([&](double) { return T_WC; });
}

int Renderer::lastSubExposures() const
{
	return impl_->lastSubExposures();
}
}  // namespace viwo::sim
