#include "Texture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numeric>

#include "Lighting.h"
#include "TexturePainter.h"

using namespace viwo::sim;
using Eigen::Vector3d;

namespace
{
Footprint square(float side_m)
{
	return {side_m, 0, 0, side_m};
}

double meanOf(const Canvas& canvas)
{
	return std::accumulate(canvas.albedo.begin(), canvas.albedo.end(), 0.0) / static_cast<double>(canvas.albedo.size());
}

double deviationOf(const Canvas& canvas)
{
	const double mean = meanOf(canvas);
	double sum = 0;
	for (float a : canvas.albedo) sum += (a - mean) * (a - mean);
	return std::sqrt(sum / static_cast<double>(canvas.albedo.size()));
}

Material materialOf(int kind)
{
	Material m;
	m.texture = static_cast<TextureKind>(kind);
	m.albedo = 0.6;
	m.seed = 3;
	return m;
}
bool hasChance(TextureKind kind)
{
	return kind != TextureKind::plain && kind != TextureKind::checker && kind != TextureKind::light;
}
}  // namespace

class TextureKinds : public testing::TestWithParam<int>
{
};

TEST_P(TextureKinds, arePossibleReflectancesAndKeepTheirMeanFromAfar)
{
	const Canvas canvas = paintTexture(materialOf(GetParam()), 0.9, 1.2, 5);
	EXPECT_GE(*std::min_element(canvas.albedo.begin(), canvas.albedo.end()), 0);
	EXPECT_LE(*std::max_element(canvas.albedo.begin(), canvas.albedo.end()), 1);
	const Texture texture(canvas);
	const float far = texture.sample(0.4f, 0.5f, square(100));
	EXPECT_NEAR(far, meanOf(canvas), 1e-3);
	EXPECT_EQ(canvas.albedo, paintTexture(materialOf(GetParam()), 0.9, 1.2, 5).albedo);
	EXPECT_EQ(canvas.albedo != paintTexture(materialOf(GetParam()), 0.9, 1.2, 6).albedo, hasChance(materialOf(GetParam()).texture));
}

INSTANTIATE_TEST_SUITE_P(All, TextureKinds, testing::Range(0, static_cast<int>(TextureKind::scuffs) + 1));

TEST(Texture, paintedWallsArePoorInTexture)
{
	Material paint = materialOf(static_cast<int>(TextureKind::paint));
	const double deviation = deviationOf(paintTexture(paint, 1, 1, 0)) / paint.albedo;
	std::cout << "[measured] painted wall: relative deviation " << deviation << "\n";
	EXPECT_GT(deviation, 0.001);
	EXPECT_LT(deviation, 0.02);
}

TEST(Texture, texelsAreReadWhereTheyAre)
{
	Canvas canvas{4, 2, 0.4, 0.2, false, {0.f, 0.1f, 0.2f, 0.3f, 0.4f, 0.5f, 0.6f, 0.7f}};
	const Texture texture(canvas);
	const Footprint fine = square(0.01f);
	for (int y = 0; y < 2; ++y)
		for (int x = 0; x < 4; ++x)
			EXPECT_NEAR(texture.sample(0.05f + 0.1f * static_cast<float>(x), 0.05f + 0.1f * static_cast<float>(y), fine), 0.1 * x + 0.4 * y,
			            2e-5);
	EXPECT_NEAR(texture.sample(0.1f, 0.05f, fine), 0.05, 2e-5);
	EXPECT_NEAR(texture.sample(0.1f, 0.1f, fine), 0.25, 2e-5);
	EXPECT_NEAR(texture.sample(-3.f, 9.f, fine), 0.4, 2e-5);  // its rim continues
	canvas.tiled = true;
	EXPECT_NEAR(Texture(canvas).sample(0.f, 0.05f, fine), 0.15, 2e-5);
	EXPECT_NEAR(Texture(canvas).sample(0.45f - 4.f, 0.35f, fine), 0.4, 2e-4);
}

TEST(Texture, longFootprintsAverageAlongThemselvesOnly)
{
	// Stripes across u: a pixel stretched along v keeps them, one stretched along u does not.
	Canvas canvas{64, 64, 0.64, 0.64, true, std::vector<float>(64 * 64)};
	for (size_t i = 0; i < canvas.albedo.size(); ++i) canvas.albedo[i] = i / 8 % 2 == 0 ? 0.2f : 0.8f;
	const Texture texture(canvas);
	EXPECT_NEAR(texture.sample(0.04f, 0.1f, {0.01f, 0, 0, 0.06f}), 0.2, 0.01);
	EXPECT_NEAR(texture.sample(0.12f, 0.1f, {0.01f, 0, 0, 0.06f}), 0.8, 0.01);
	EXPECT_NEAR(texture.sample(0.04f, 0.1f, {0.16f, 0, 0, 0.01f}), 0.5, 0.08);
}

TEST(Lighting, worldWithoutLampsIsEven)
{
	std::vector<Surface> s;
	appendBox(s, {0, 0, 0}, {1, 1, 1}, 0, 0);
	const Lighting lighting(World({Material{}}, s));
	for (size_t i = 0; i < s.size(); ++i) EXPECT_EQ(lighting.at(i, 0.3f, 0.9f), 1.0f);
}

TEST(Lighting, fadesWithDistanceAndThrowsShadows)
{
	Material wall, lamp;
	lamp.emission = 3;
	std::vector<Surface> s;
	s.push_back({{-5, -5, 0}, Vector3d::UnitX(), Vector3d::UnitY(), 10, 10, 0, 0, false});
	s.push_back({{-0.3, 0.3, 2.5}, Vector3d::UnitX(), -Vector3d::UnitY(), 0.6, 0.6, 1, 0, false});
	appendBox(s, {1.5, 0, 0.9}, {0.8, 0.8, 0.05}, 0, 0);
	const Lighting lighting(World({wall, lamp}, s, 0.2));
	const float below = lighting.at(0, 5, 5), aside = lighting.at(0, 2, 5), corner = lighting.at(0, 0.3f, 0.3f),
	            shadow = lighting.at(0, 7.25f, 5);
	EXPECT_GT(below, 1.3f * aside);
	EXPECT_GT(aside, 1.3f * corner);
	EXPECT_LT(shadow, 0.6f * lighting.at(0, 5 - 2.25f, 5));
}
