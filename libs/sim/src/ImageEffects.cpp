#include "viwo/sim/ImageEffects.h"

#include <viwo/core/Error.h>

#include <algorithm>
#include <cmath>

namespace viwo::sim
{
namespace
{
/** Counter-based generator (the finaliser of SplitMix64, Steele et al. 2014): any pixel's bits without those before it. */
uint64_t mixed(uint64_t x)
{
	x += 0x9E3779B97F4A7C15ull;
	x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ull;
	x = (x ^ (x >> 27)) * 0x94D049BB133111EBull;
	return x ^ (x >> 31);
}

/** Inverse of the normal distribution function by bisection; only used to fill a table. */
double normalQuantile(double probability)
{
	double low = -10, high = 10;
	for (int i = 0; i < 60; ++i)
	{
		const double middle = 0.5 * (low + high);
		(0.5 * std::erfc(-middle / std::sqrt(2.0)) < probability ? low : high) = middle;
	}
	return 0.5 * (low + high);
}
}  // namespace

ImageEffects::ImageEffects(int width_px, int height_px, const ImageEffectsOptions& options)
    : width_px_(width_px), height_px_(height_px), options_(options)
{
	const double cx = 0.5 * (width_px - 1), cy = 0.5 * (height_px - 1), corner2 = cx * cx + cy * cy;
	for (int y = 0; y < height_px; ++y)
		for (int x = 0; x < width_px; ++x)
		{
			const double r2 = ((x - cx) * (x - cx) + (y - cy) * (y - cy)) / corner2;
			lens_transmission_.push_back(static_cast<float>(1 - options.vignetting * r2));
		}

	double sum2 = 0;
	std::array<double, 4096> quantiles{};
	for (size_t i = 0; i < quantiles.size(); ++i)
	{
		quantiles[i] = normalQuantile((static_cast<double>(i) + 0.5) / static_cast<double>(quantiles.size()));
		sum2 += quantiles[i] * quantiles[i];
	}
	// The table ends at 3.5 sigma: rescaled, so that its variance is 1.
	const double scale = std::sqrt(static_cast<double>(quantiles.size()) / sum2);
	std::transform(quantiles.begin(), quantiles.end(), normal_quantiles_.begin(), [&](double q) { return static_cast<float>(q * scale); });
}

GreyImage ImageEffects::apply(const RadianceImage& radiance, const Exposure& exposure) const
{
	if (radiance.width_px != width_px_ || radiance.height_px != height_px_)
		throw Error("image effects: the frame is not of the camera's size");
	if (!(exposure.brightness >= 0) || !(exposure.gain >= 0)) throw Error("image effects: brightness and gain must not be negative");
	const size_t n = lens_transmission_.size();
	GreyImage image{width_px_, height_px_, std::vector<uint8_t>(n)};
	if (exposure.black) return image;

	const auto grey_per_electron = static_cast<float>(exposure.gain * 255 / options_.full_well_e);
	const auto grey_per_radiance = static_cast<float>(options_.white_grey * exposure.brightness * exposure.gain);
	const float shot = options_.shot_noise ? grey_per_electron : 0;
	const float read = static_cast<float>(options_.read_noise_e) * grey_per_electron;
	const float read_variance = read * read;
	const uint64_t stream = mixed(exposure.noise_seed);
	constexpr size_t kBlock = 4;  // pixels served by the 64 bits of one counter
	for (size_t begin = 0; begin < n; begin += kBlock)
	{
		uint64_t bits = mixed(stream + begin);
		for (size_t i = begin; i < std::min(n, begin + kBlock); ++i, bits >>= 16)
		{
			const float mean = radiance.pixels[i] * lens_transmission_[i] * grey_per_radiance;
			const float grey = mean + std::sqrt(shot * mean + read_variance) * normal_quantiles_[bits & 4095];
			image.pixels[i] = static_cast<uint8_t>(std::clamp(grey + 0.5f, 0.0f, 255.0f));
		}
	}
	return image;
}
}  // namespace viwo::sim
