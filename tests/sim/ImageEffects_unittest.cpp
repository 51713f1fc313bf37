#include <gtest/gtest.h>
#include <viwo/core/Error.h>
#include <viwo/sim/ImageEffects.h>

#include <cmath>
#include <iostream>

using namespace viwo;
using namespace viwo::sim;

namespace
{
constexpr int kWidth = 640, kHeight = 480;

RadianceImage even(float radiance)
{
	return {kWidth, kHeight, std::vector<float>(static_cast<size_t>(kWidth * kHeight), radiance)};
}

ImageEffectsOptions withoutVignetting()
{
	ImageEffectsOptions options;
	options.vignetting = 0;
	return options;
}

struct Moments
{
	double mean = 0, variance = 0;
};

Moments momentsOf(const GreyImage& image)
{
	double sum = 0, sum2 = 0;
	for (uint8_t p : image.pixels)
	{
		sum += p;
		sum2 += static_cast<double>(p) * p;
	}
	const double n = static_cast<double>(image.pixels.size()), mean = sum / n;
	return {mean, sum2 / n - mean * mean};
}
}  // namespace

TEST(ImageEffects, noiseVarianceGrowsWithTheLightAndTheGain)
{
	const ImageEffectsOptions options = withoutVignetting();
	const ImageEffects effects(kWidth, kHeight, options);
	for (double gain : {1.0, 4.0})
		for (float radiance : {0.05f, 0.1f, 0.15f, 0.25f})
		{
			Exposure exposure;
			exposure.gain = gain;
			exposure.noise_seed = 11;
			const Moments m = momentsOf(effects.apply(even(radiance), exposure));
			const double mean = radiance * options.white_grey * gain, grey_per_electron = gain * 255 / options.full_well_e;
			const double expected =
			    grey_per_electron * mean + std::pow(options.read_noise_e * grey_per_electron, 2) + 1.0 / 12;  // rounding
			std::cout << "[measured] gain " << gain << " grey " << m.mean << " variance " << m.variance << ", expected " << expected
			          << "\n";
			EXPECT_NEAR(m.mean, mean, 0.02 * gain);
			EXPECT_NEAR(m.variance, expected, 0.06 * expected);
		}
}

TEST(ImageEffects, neighbouringPixelsAndFramesHaveIndependentNoise)
{
	const ImageEffects effects(kWidth, kHeight, withoutVignetting());
	const auto frame = [&](uint64_t seed)
	{
		Exposure exposure;
		exposure.noise_seed = seed;
		return effects.apply(even(0.6f), exposure);
	};
	const GreyImage a = frame(1), b = frame(2);
	EXPECT_EQ(a.pixels, frame(1).pixels);
	const Moments m = momentsOf(a);
	const auto correlation = [&](const GreyImage& other, size_t shift)
	{
		double sum = 0;
		for (size_t i = 0; i + shift < a.pixels.size(); ++i) sum += (a.pixels[i] - m.mean) * (other.pixels[i + shift] - m.mean);
		return sum / static_cast<double>(a.pixels.size()) / m.variance;
	};
	const double limit = 5 / std::sqrt(static_cast<double>(a.pixels.size()));
	for (size_t shift : {1u, 2u, 3u, 4u, 5u, 640u}) EXPECT_LT(std::abs(correlation(a, shift)), limit) << shift;
	for (size_t shift : {0u, 1u, 4u}) EXPECT_LT(std::abs(correlation(b, shift)), limit) << shift;
}

TEST(ImageEffects, idealSensorRoundsTheLight)
{
	ImageEffectsOptions options = withoutVignetting();
	options.shot_noise = false;
	options.read_noise_e = 0;
	options.white_grey = 200;
	const ImageEffects effects(kWidth, kHeight, options);
	Exposure exposure;
	EXPECT_EQ(effects.apply(even(0.5f), exposure).at(17, 300), 100);
	exposure.brightness = 0.5;
	EXPECT_EQ(effects.apply(even(0.5f), exposure).at(17, 300), 50);
	exposure.gain = 3;
	EXPECT_EQ(effects.apply(even(0.5f), exposure).at(17, 300), 150);
	EXPECT_EQ(effects.apply(even(5.0f), exposure).at(17, 300), 255);
	exposure.black = true;
	EXPECT_EQ(effects.apply(even(5.0f), exposure).at(17, 300), 0);
}

TEST(ImageEffects, vignettingTakesItsShareInTheCorners)
{
	ImageEffectsOptions options;
	options.vignetting = 0.4;
	options.shot_noise = false;
	options.read_noise_e = 0;
	options.white_grey = 200;
	const GreyImage image = ImageEffects(kWidth, kHeight, options).apply(even(1), {});
	EXPECT_EQ(image.at(320, 240), 200);
	for (int x : {0, kWidth - 1})
		for (int y : {0, kHeight - 1}) EXPECT_EQ(image.at(x, y), 120);
}

TEST(ImageEffects, refusesFramesOfAnotherSizeAndNegativeLight)
{
	const ImageEffects effects(320, 240, {});
	EXPECT_THROW(effects.apply(even(1), {}), Error);
	Exposure exposure;
	exposure.gain = -1;
	EXPECT_THROW(ImageEffects(kWidth, kHeight, {}).apply(even(1), exposure), Error);
}
