#include <gtest/gtest.h>
#include <viwo/core/Error.h>
#include <viwo/sim/Renderer.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <iostream>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <random>

using namespace viwo;
using namespace viwo::sim;
using Eigen::Vector3d;

namespace
{
CameraModel plumbBob()
{
	return {640, 480, 252, 250, 318.7, 243.4, CameraModel::Distortion::plumb_bob, {-0.08, 0.012, 4e-4, -3e-4, 0}};
}

CameraModel kannalaBrandt()
{
	return {640, 480, 348, 347, 321.2, 238.9, CameraModel::Distortion::kannala_brandt, {-0.02, 0.003, -0.001, 0.0002, 0}};
}

Material checkerMaterial(double cell_m)
{
	Material m;
	m.texture = TextureKind::checker;
	m.albedo = 0.5;
	m.contrast = 0.6;
	m.cell_m = cell_m;
	return m;
}

/** An upright wall 4 x 3 m at x = 2 that looks towards the origin, its corner (u, v) = (0, 0) at y = 2, z = -1.5. */
World wallAhead(const Material& material)
{
	std::vector<Surface> s;
	appendPanel(s, {2, 0, 0}, 4, 3, M_PI, 0);
	return World({material}, s);
}

Pose3 lookingAlongX(const Vector3d& p, double yaw = 0, double pitch = 0, double roll = 0)
{
	const Eigen::Quaterniond R(Eigen::AngleAxisd(yaw, Vector3d::UnitZ()) * Eigen::AngleAxisd(pitch, Vector3d::UnitY()) *
	                           Eigen::AngleAxisd(roll, Vector3d::UnitX()));
	return {R * forwardOpticalAxes(), p};
}

Pose3 randomPose(std::mt19937_64& generator)
{
	std::uniform_real_distribution<double> x(-1, 1);
	Vector3d p;
	for (int i = 0; i < 3; ++i) p[i] = 0.5 * x(generator);
	const double yaw = 0.5 * x(generator), pitch = 0.2 * x(generator), roll = 0.1 * x(generator);
	return lookingAlongX(p, yaw, pitch, roll);
}

struct Deviation
{
	Eigen::Vector2d sum = Eigen::Vector2d::Zero();
	double sum2 = 0, worst = 0;
	int count = 0;

	void add(const Eigen::Vector2d& d)
	{
		sum += d;
		sum2 += d.squaredNorm();
		worst = std::max(worst, d.norm());
		count++;
	}
	Eigen::Vector2d bias() const { return sum / count; }
	double rms() const { return std::sqrt(sum2 / count / 2); }
	void print(const std::string& what) const
	{
		std::cout << "[measured] " << what << ": " << count << " corners, bias " << bias().x() << " " << bias().y() << " px, RMS " << rms()
		          << " px an axis, worst " << worst << " px\n";
	}
};

/** Locates the corner near each true position in a noise-free render. */
void locateCorners(Renderer& renderer, const CameraModel& camera, const Pose3& T_WC, const std::vector<Vector3d>& corners_W,
                   Deviation& deviation)
{
	RadianceImage radiance = renderer.radiance(T_WC);
	const cv::Mat sharp(radiance.height_px, radiance.width_px, CV_32F, radiance.pixels.data());
	// The locator itself errs by 0.05 px on pixels of sharp edges, by 0.02 px on smooth ones.
	cv::Mat image;
	cv::GaussianBlur(sharp, image, {0, 0}, 1.0);
	for (const auto& corner : corners_W)
	{
		const auto truth = camera.project(T_WC.inverse() * corner);
		if (!truth || !camera.contains(*truth, 14)) continue;
		std::vector<cv::Point2f> found{{static_cast<float>(std::round(truth->x())), static_cast<float>(std::round(truth->y()))}};
		cv::cornerSubPix(image, found, {6, 6}, {-1, -1}, {cv::TermCriteria::EPS + cv::TermCriteria::COUNT, 50, 1e-4});
		deviation.add(Eigen::Vector2d(found[0].x, found[0].y) - *truth);
	}
}

double meanOf(const RadianceImage& image)
{
	return std::accumulate(image.pixels.begin(), image.pixels.end(), 0.0) / static_cast<double>(image.pixels.size());
}
}  // namespace

class RendererCorners : public testing::TestWithParam<CameraModel>
{
};

TEST_P(RendererCorners, ofATextureStandWhereTheCameraModelProjectsThem)
{
	const World world = wallAhead(checkerMaterial(0.25));
	std::vector<Vector3d> corners;
	for (int i = 1; i < 16; ++i)
		for (int j = 1; j < 12; ++j) corners.push_back(world.surfaces()[0].point_W(0.25 * i, 0.25 * j));
	Renderer renderer(world, GetParam());
	std::mt19937_64 generator(3);
	Deviation deviation;
	for (int i = 0; i < 12; ++i) locateCorners(renderer, GetParam(), randomPose(generator), corners, deviation);
	deviation.print("texture corners");
	ASSERT_GT(deviation.count, 1000);
	EXPECT_LT(deviation.bias().norm(), 0.02);
	EXPECT_LT(deviation.rms(), 0.05);
}

TEST_P(RendererCorners, ofOutlinesStandWhereTheCameraModelProjectsThem)
{
	// Panels a tenth of a millimetre before the wall that touch at their corners: saddle points made of geometry.
	Material bright, dark;
	bright.albedo = 0.9;
	dark.albedo = 0.1;
	std::vector<Surface> s;
	appendPanel(s, {2, 0, 0}, 4, 3, M_PI, 0);
	std::vector<Vector3d> corners;
	for (int i = 0; i < 5; ++i)
		for (int j = 0; j < 4; ++j)
		{
			const Vector3d corner(2 - 1e-4, 1.4 - 0.7 * i, -1.05 + 0.7 * j);
			appendPanel(s, corner + Vector3d(0, 0.15, 0.15), 0.3, 0.3, M_PI, 1);
			appendPanel(s, corner - Vector3d(0, 0.15, 0.15), 0.3, 0.3, M_PI, 1);
			corners.push_back(corner);
		}
	Renderer renderer(World({bright, dark}, s), GetParam());
	std::mt19937_64 generator(4);
	Deviation deviation;
	for (int i = 0; i < 12; ++i) locateCorners(renderer, GetParam(), randomPose(generator), corners, deviation);
	deviation.print("outline corners");
	ASSERT_GT(deviation.count, 120);
	EXPECT_LT(deviation.bias().norm(), 0.02);
	EXPECT_LT(deviation.rms(), 0.05);
}

INSTANTIATE_TEST_SUITE_P(Lenses, RendererCorners, testing::Values(plumbBob(), kannalaBrandt()));

/** Mean and deviation of the pixels of a 640 pixels wide image. */
std::pair<double, double> statistics(const RadianceImage& image, const cv::Rect& part)
{
	double sum = 0, sum2 = 0, n = 0;
	for (int y = part.y; y < part.y + part.height; ++y)
		for (int x = part.x; x < part.x + part.width; ++x, ++n)
		{
			const double value = image.pixels[static_cast<size_t>(y * 640 + x)];
			sum += value;
			sum2 += value * value;
		}
	return {sum / n, std::sqrt(std::max(0.0, sum2 / n - sum / n * (sum / n)))};
}

TEST(Renderer, fineCheckerFarAwayIsGreyAndQuiet)
{
	// Squares of 2 mm at 2 m and more: a quarter of a pixel at most.
	Renderer renderer(wallAhead(checkerMaterial(0.002)), plumbBob());
	for (double yaw : {0.0, 0.03, 0.2})
	{
		const RadianceImage image = renderer.radiance(lookingAlongX({-0.3, 0.1, 0}, yaw));
		const auto [mean, deviation] = statistics(image, {240, 180, 160, 120});
		std::cout << "[measured] fine checker: mean " << mean << " deviation " << deviation << "\n";
		EXPECT_NEAR(mean, 0.5, 0.005);
		EXPECT_LT(deviation, 0.01);
	}
}

TEST(Renderer, fineFloorTowardsTheHorizonIsGreyAndQuiet)
{
	// Squares of 2 cm between 5 m and 20 m ahead, from 0.3 m above: seen along the floor, narrower than a pixel in one direction or both.
	std::vector<Surface> s{{{-1, -40, 0}, Vector3d::UnitX(), Vector3d::UnitY(), 80, 80, 0, 0, false}};
	Renderer renderer(World({checkerMaterial(0.02)}, s), CameraModel(640, 480, 250, 250, 319.5, 239.5));
	const RadianceImage image = renderer.radiance(lookingAlongX({0.004, 0.003, 0.3}, 0.2));
	const auto [mean, deviation] = statistics(image, {100, 244, 440, 11});
	std::cout << "[measured] fine floor: mean " << mean << " deviation " << deviation << " (0.3 unfiltered)\n";
	EXPECT_NEAR(mean, 0.5, 0.005);
	EXPECT_LT(deviation, 0.03);
}

TEST(Renderer, outlinesWeighEachSurfaceByItsShareOfThePixel)
{
	// The image of a bright panel on a dark wall holds as much light as its solid angle says, wherever it falls on the pixel grid.
	Material bright, dark;
	bright.albedo = 1;
	dark.albedo = 0;
	const CameraModel camera(640, 480, 250, 250, 319.5, 239.5);
	for (double shift : {0.0, 0.0013, 0.0029, 0.0041})
	{
		std::vector<Surface> s;
		appendPanel(s, {2, 0, 0}, 8, 8, M_PI, 1);
		appendPanel(s, {1.999, shift, 0.7 * shift}, 0.1, 0.05, M_PI, 0);
		Renderer renderer(World({bright, dark}, s), camera);
		const RadianceImage image = renderer.radiance(lookingAlongX(Vector3d::Zero()));
		const double expected_px2 = 250 * 250 * 0.1 * 0.05 / (1.999 * 1.999);
		EXPECT_NEAR(meanOf(image) * 640 * 480, expected_px2, 0.02 * expected_px2);
	}
}

TEST(Renderer, stripsNarrowerThanAPixelDoNotVanish)
{
	Material bright, dark;
	bright.albedo = 1;
	dark.albedo = 0;
	std::vector<Surface> s;
	appendPanel(s, {2, 0, 0}, 8, 8, M_PI, 1);
	appendPanel(s, {1.999, 0, 0}, 0.002, 2, M_PI, 0);  // a quarter of a pixel wide
	Renderer renderer(World({bright, dark}, s), CameraModel(640, 480, 250, 250, 319.5, 239.5));
	for (double yaw : {0.0, 0.0007, 0.0013, 0.0021, 0.3})
	{
		const RadianceImage image = renderer.radiance(lookingAlongX(Vector3d::Zero(), yaw));
		double row = 0;
		for (size_t x = 0; x < 640; ++x) row += image.pixels[240 * 640 + x];
		EXPECT_NEAR(row * std::cos(yaw) * std::cos(yaw), 0.25, 0.07) << yaw;
	}
}

TEST(Renderer, evenlyLitSurfaceHasItsAlbedoEverywhere)
{
	Material plain;
	plain.albedo = 0.37;
	std::vector<Surface> s;
	appendPanel(s, {1, 0, 0}, 50, 50, M_PI, 0);
	Renderer renderer(World({plain}, s), plumbBob());
	const RadianceImage image = renderer.radiance(lookingAlongX(Vector3d::Zero()));
	for (float value : image.pixels) ASSERT_FLOAT_EQ(value, 0.37f);
}

TEST(Renderer, sameSurfaceAsTheExactRay)
{
	const World world = World::load(std::string(VIWO_SOURCE_DIR) + "/share/viwo/worlds/lobby.ini");
	std::vector<Material> labels;
	std::vector<Surface> surfaces = world.surfaces();
	// Every surface in a grey of its own, evenly lit: the radiance names the surface.
	for (size_t i = 0; i < surfaces.size(); ++i)
	{
		Material m;
		m.albedo = (static_cast<double>(i) + 1) / 2000;
		labels.push_back(m);
		surfaces[i].material = i;
	}
	const CameraModel camera = kannalaBrandt();
	const World labelled(labels, surfaces);
	Renderer renderer(labelled, camera);
	std::mt19937_64 generator(5);
	std::uniform_int_distribution<int> x(1, 638), y(1, 478);
	int inside = 0, agreeing = 0;
	for (double yaw : {0.0, 1.0, 2.2, -1.9})
	{
		const Pose3 T_WC = lookingAlongX({0.3, -0.2, 0.3}, yaw);
		const RadianceImage image = renderer.radiance(T_WC);
		for (int i = 0; i < 2000; ++i)
		{
			const int px = x(generator), py = y(generator);
			const auto label = [&](int a, int b) { return std::lround(image.pixels[static_cast<size_t>(b * 640 + a)] * 2000.0) - 1; };
			const long here = label(px, py);
			if (here != label(px - 1, py) || here != label(px + 1, py) || here != label(px, py - 1) || here != label(px, py + 1)) continue;
			const auto hit = labelled.castRay(T_WC.p, T_WC.R * camera.unproject({px, py}), 100);
			inside++;
			agreeing += hit && static_cast<long>(hit->surface) == here;
		}
	}
	std::cout << "[measured] " << agreeing << " of " << inside << " pixels show the surface that castRay meets\n";
	ASSERT_GT(inside, 5000);
	EXPECT_GE(agreeing, inside - inside / 500);
}

TEST(Renderer, sameArgumentsSameBytesWhateverCameBefore)
{
	const World world = wallAhead(checkerMaterial(0.2));
	Renderer a(world, plumbBob()), b(a);
	const auto turning = [](double s) { return lookingAlongX(Vector3d::Zero(), 0.03 * s); };
	Exposure exposure;
	exposure.noise_seed = 42;
	const GreyImage first = a.render(turning, exposure);
	b.render([](double) { return lookingAlongX({0.5, 0.5, 0}, 0.3); }, {});
	EXPECT_EQ(first.pixels, b.render(turning, exposure).pixels);
	exposure.noise_seed = 43;
	EXPECT_NE(first.pixels, b.render(turning, exposure).pixels);
	exposure.black = true;
	const GreyImage black = b.render(turning, exposure);
	EXPECT_TRUE(std::all_of(black.pixels.begin(), black.pixels.end(), [](uint8_t p) { return p == 0; }));
}

TEST(Renderer, motionBlurSmearsByTheMovementDuringTheExposure)
{
	Material bright, dark;
	bright.albedo = 1;
	dark.albedo = 0;
	std::vector<Surface> s;
	appendPanel(s, {2, 0, 0}, 8, 8, M_PI, 1);
	appendPanel(s, {1.999, -0.5, 0}, 1, 8, M_PI, 0);  // bright on the right half
	RendererOptions options;
	options.blur_step_px = 1;
	options.max_sub_exposures = 20;
	ImageEffectsOptions ideal;
	ideal.vignetting = 0;
	ideal.shot_noise = false;
	ideal.read_noise_e = 0;
	Renderer renderer(World({bright, dark}, s), CameraModel(640, 480, 250, 250, 319.5, 239.5), options, ideal);
	const auto edgeWidth = [&](double turn_rad)
	{
		const GreyImage image = renderer.render([&](double s) { return lookingAlongX(Vector3d::Zero(), turn_rad * (s - 0.5)); }, {});
		int between = 0;
		for (int x = 300; x < 340; ++x) between += image.at(x, 240) > 2 && image.at(x, 240) < 187;
		return between;
	};
	EXPECT_LE(edgeWidth(0), 1);
	EXPECT_EQ(renderer.lastSubExposures(), 1);
	EXPECT_NEAR(edgeWidth(10.0 / 250), 10, 1.5);
	EXPECT_GE(renderer.lastSubExposures(), 10);
}

TEST(Renderer, refusesWhatItCannotDraw)
{
	const World world = wallAhead(checkerMaterial(0.2));
	EXPECT_THROW(Renderer(world, CameraModel()), Error);
	// 640 pixels at 120 pixels a radian: 150 deg to the left.
	EXPECT_THROW(Renderer(world, CameraModel(640, 480, 120, 120, 320, 240, CameraModel::Distortion::kannala_brandt, {})), Error);
}

class ShippedWorlds : public testing::TestWithParam<const char*>
{
};

TEST_P(ShippedWorlds, giveFramesWithCornersToFollowAtAnUsefulRate)
{
	const World world = World::load(std::string(VIWO_SOURCE_DIR) + "/share/viwo/worlds/" + GetParam());
	Renderer renderer(world, plumbBob());
	double cpu_s = 0;
	int frames = 0;
	for (double yaw = 0; yaw < 6.2; yaw += 0.5)
	{
		const Pose3 T_WC = lookingAlongX({1, 0.1, 0.3}, yaw);
		Exposure exposure;
		exposure.noise_seed = static_cast<uint64_t>(++frames);
		const auto begin = std::clock();
		GreyImage image = renderer.render([&](double) { return T_WC; }, exposure);
		cpu_s += static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
		std::vector<cv::Point2f> corners;
		cv::goodFeaturesToTrack(cv::Mat(480, 640, CV_8U, image.pixels.data()), corners, 500, 0.01, 20);
		const double mean = std::accumulate(image.pixels.begin(), image.pixels.end(), 0.0) / static_cast<double>(image.pixels.size());
		std::cout << "[measured] " << GetParam() << " yaw " << yaw << ": " << corners.size() << " corners, mean grey " << mean << "\n";
		EXPECT_GE(corners.size(), 30u);
		EXPECT_LE(corners.size(), 250u);
		EXPECT_GT(mean, 70);
		EXPECT_LT(mean, 190);
	}
	std::cout << "[measured] " << GetParam() << ": " << frames / cpu_s << " frames of 640x480 a second of one core\n";
}

INSTANTIATE_TEST_SUITE_P(All, ShippedWorlds, testing::Values("corridor.ini", "lobby.ini"));
