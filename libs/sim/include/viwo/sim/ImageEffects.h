#pragma once

#include <viwo/core/Options.h>
#include <viwo/sim/GreyImage.h>

#include <array>
#include <cstdint>
#include <vector>

namespace viwo::sim
{
/** The sensor behind the lens. One grey level is full_well_e / 255 electrons at gain 1. */
struct ImageEffectsOptions : Options<ImageEffectsOptions>
{
	double white_grey = 190;
	double vignetting = 0.25;
	bool shot_noise = true;
	double full_well_e = 10000;
	double read_noise_e = 12;

	template <class Visitor>
	void visit(Visitor& v)
	{
		v("white_grey", white_grey, "grey level of a white wall at nominal illumination and brightness 1", 1.0, 1000.0);
		v("vignetting", vignetting, "loss of light in the image corners against the centre, 0..1 (0: none)", 0.0, 1.0);
		v("shot_noise", shot_noise, "photon noise: variance proportional to the light");
		v("full_well_e", full_well_e, "electrons at grey level 255 and gain 1", 100.0, 1e7);
		v("read_noise_e", read_noise_e, "standard deviation of the read-out noise, electrons (0: none)", 0.0, 1e4);
	}
};

/** How one frame is exposed. */
struct Exposure
{
	double brightness = 1;    //!< amount of light collected against nominal: shutter time, aperture
	double gain = 1;          //!< electronic amplification: noise in grey levels grows with it
	bool black = false;       //!< the sensor delivers zeros
	uint64_t noise_seed = 0;  //!< same seed, same noise
};

/** Turns radiance into grey levels: vignetting, exposure, shot and read noise, saturation, 8-bit rounding. */
class ImageEffects
{
   public:
	ImageEffects(int width_px, int height_px, const ImageEffectsOptions& options);

	/** @throws Error when the radiance is of another size, or brightness or gain are negative. */
	GreyImage apply(const RadianceImage& radiance, const Exposure& exposure) const;

	const ImageEffectsOptions& options() const { return options_; }

   private:
	int width_px_, height_px_;
	ImageEffectsOptions options_;
	std::vector<float> lens_transmission_;
	std::array<float, 4096> normal_quantiles_;
};
}  // namespace viwo::sim
