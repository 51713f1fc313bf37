#include <gtest/gtest.h>
#include <viwo/rawlog/MrptTime.h>
#include <viwo/rawlog/ObservationAdapter.h>
#include <viwo/rawlog/RawlogReader.h>
#include <viwo/sim/Simulation.h>

#include <filesystem>
#include <map>

#include "ExpectError.h"
#include "SimFixtures.h"
#include "TempFolder.h"

namespace viwo::sim
{
namespace
{
World room()
{
	std::vector<Material> materials(2);
	materials[1].texture = TextureKind::checker;
	std::vector<Surface> surfaces;
	appendPanel(surfaces, {4, 0, 1.5}, 8, 3, M_PI, 1);
	appendPanel(surfaces, {-4, 0, 1.5}, 8, 3, 0, 1);
	appendPanel(surfaces, {0, 4, 1.5}, 8, 3, -M_PI / 2, 1);
	appendPanel(surfaces, {0, -4, 1.5}, 8, 3, M_PI / 2, 1);
	return World(materials, surfaces);
}

Route shortRoute()
{
	Route route;
	route.segments = "straight 0.3 m, rotate 10 deg, stand 0.5 s";
	return route;
}

/** Small images, for speed. */
Rig smallRig()
{
	Rig rig;
	rig.camera.width_px = 160;
	rig.camera.height_px = 120;
	rig.camera.fx_px = rig.camera.fy_px = 84.5;
	rig.camera.cx_px = 79.6;
	rig.camera.cy_px = 59.7;
	return rig;
}

std::map<std::string, std::string> filesOf(const std::string& folder)
{
	std::map<std::string, std::string> files;
	for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
		if (entry.is_regular_file())
			files[std::filesystem::relative(entry.path(), folder).string()] = testing::readFile(entry.path().string());
	return files;
}

TEST(Simulation, SameSeedSameBytesOnAnyNumberOfThreads)
{
	const testing::TempFolder a, b, c;
	SimulationRunOptions options;
	Simulation(room(), shortRoute(), smallRig(), 7).run(a.file("x.rawlog"), options);
	options.threads = 3;
	const SimulationResult result = Simulation(room(), shortRoute(), smallRig(), 7).run(b.file("x.rawlog"), options);
	Simulation(room(), shortRoute(), smallRig(), 8).run(c.file("x.rawlog"), options);
	const auto first = filesOf(a.path()), second = filesOf(b.path()), other = filesOf(c.path());
	EXPECT_EQ(first.size(), static_cast<size_t>(result.images) + 3);
	ASSERT_EQ(first.size(), second.size());
	for (const auto& [name, content] : first) EXPECT_TRUE(second.at(name) == content) << name;
	EXPECT_FALSE(first.at("x.rawlog") == other.at("x.rawlog"));
	EXPECT_FALSE(first.begin()->second == other.begin()->second) << "image noise comes from the seed";
}

TEST(Simulation, LogHoldsWhatTheSensorsGave)
{
	const testing::TempFolder folder;
	const Rig rig = smallRig();
	Simulation simulation(room(), shortRoute(), rig, 3);
	const SimulationResult result = simulation.run(folder.file("x.rawlog"));
	const AdapterOptions adapter_options;
	ObservationAdapter adapter(adapter_options);
	RawlogReader reader(result.rawlog);
	const ImuModel imu(simulation.motion(), rig.imu, 3);
	const WheelModel wheels(simulation.motion(), rig.wheels, 3);
	int64_t imu_count = 0, wheel_count = 0, image_count = 0, scan_count = 0;
	while (const auto observation = reader.next())
	{
		if (observation->sensorLabel == "LMS100") scan_count++;
		const AdaptedObservation adapted = adapter.convert(observation);
		EXPECT_FALSE(adapted.rejected);
		if (const auto* s = std::get_if<ImuSample>(&adapted.sample))
		{
			const ImuSample& expected = imu.samples()[static_cast<size_t>(imu_count++)];
			EXPECT_EQ(s->t_ns, expected.t_ns);
			EXPECT_EQ(s->acc_m_s2, expected.acc_m_s2);
			EXPECT_EQ(s->gyro_rad_s, expected.gyro_rad_s);
		}
		if (const auto* s = std::get_if<WheelSample>(&adapted.sample))
		{
			const WheelReading& expected = wheels.readings()[static_cast<size_t>(wheel_count++)];
			EXPECT_NEAR(0.5 * (s->v_left_m_s + s->v_right_m_s), expected.mean_twist.v_m_s, 1e-9);
		}
		if (const auto* image = std::get_if<ImageRef>(&adapted.sample))
		{
			EXPECT_EQ(image->grey().getWidth(), 160u);
			image_count++;
		}
	}
	EXPECT_EQ(imu_count, result.imu);
	EXPECT_EQ(wheel_count, result.odometry);
	EXPECT_EQ(image_count, result.images);
	EXPECT_EQ(scan_count, result.scans);
	EXPECT_EQ(reader.counts().late, 0u);
	EXPECT_NEAR(static_cast<double>(result.images), 10 * result.duration_s, 1.01);
	EXPECT_NEAR(static_cast<double>(result.scans), 25 * result.duration_s, 2.01);

	const Calibration nominal = readCalibration(result.rawlog, adapter_options, true, true);
	EXPECT_NEAR((nominal.T_OC.p - rig.nominalCalibration().T_OC.p).norm(), 0, 1e-6);
	EXPECT_NEAR(nominal.T_OB.R.angularDistance(rig.nominalCalibration().T_OB.R), 0, 1e-6);
	EXPECT_NEAR(nominal.camera.fx_px(), 84.5, 1e-9);

	const Trajectory truth = Trajectory::loadTum(result.ground_truth);
	EXPECT_EQ(truth.size(), static_cast<size_t>(std::floor(200 * result.duration_s + 1e-9)) + 1);
	const StampedPose& pose = truth.poses()[200];
	EXPECT_NEAR((pose.T.p - simulation.motion().at_ns(pose.t_ns).T_WO.p).norm(), 0, 1e-6);

	Rig read_rig;
	Route read_route;
	loadRun(result.configuration, result.configuration, {}, read_rig, read_route);
	EXPECT_EQ(read_route.segments, shortRoute().segments);
	EXPECT_EQ(read_rig.camera.fx_px, rig.camera.fx_px);
}

TEST(Simulation, BlackOutAndMissingCamera)
{
	const testing::TempFolder folder;
	Rig rig = smallRig();
	rig.camera.black_from_s = 1;
	rig.camera.black_to_s = 1.5;
	rig.lidar.enabled = false;
	const SimulationResult result = Simulation(room(), shortRoute(), rig, 3).run(folder.file("x.rawlog"));
	EXPECT_EQ(result.scans, 0);
	RawlogReader reader(result.rawlog);
	ObservationAdapter adapter;
	const int64_t epoch_ns = Motion::kDefaultEpoch_ns;
	int black = 0;
	while (const auto observation = reader.next())
	{
		const AdaptedObservation adapted = adapter.convert(observation);
		const auto* image = std::get_if<ImageRef>(&adapted.sample);
		if (image == nullptr) continue;
		const double t_s = secondsBetween(epoch_ns, image->t_ns);
		const mrpt::img::CImage grey = image->grey();
		int brightest = 0;
		for (unsigned y = 0; y < 120; y += 5)
			for (unsigned x = 0; x < 160; x += 5) brightest = std::max<int>(brightest, *grey.ptr<uint8_t>(x, y));
		const bool is_black = brightest < 5;
		EXPECT_EQ(is_black, t_s >= 1 && t_s < 1.5) << t_s;
		black += is_black;
	}
	EXPECT_EQ(black, 5);
	SimulationRunOptions no_images;
	no_images.images = false;
	const SimulationResult blind = Simulation(room(), shortRoute(), rig, 3).run(folder.file("blind.rawlog"), no_images);
	EXPECT_EQ(blind.images, 0);
	EXPECT_GT(blind.imu, 500);
}

/** Centre of the dark pixels, against that of the projected panel, cell by cell. */
TEST(Simulation, ImagesShowWhatIsSeenAtTheirTimesOffsetIncluded)
{
	std::vector<Material> materials(2);
	materials[0].albedo = 0.9;
	materials[1].albedo = 0.02;
	std::vector<Surface> surfaces;
	appendPanel(surfaces, {4, 0, 1.5}, 80, 80, M_PI, 0);
	appendPanel(surfaces, {3.99, 0.4, 0.6}, 0.8, 0.8, M_PI, 1);
	const World world(materials, surfaces, 1);
	Route route;
	route.start_yaw_deg = -15;
	route.segments = "rotate 30 deg";
	route.yaw_rate_rad_s = 0.3;
	route.initial_speed = true;
	route.final_stop = false;
	Rig rig = smallRig();
	rig.camera.format = CameraOptions::Format::png;
	rig.camera.time_offset_ms = 40;
	rig.image_effects.shot_noise = false;
	rig.image_effects.read_noise_e = rig.image_effects.vignetting = 0;
	rig.lidar.enabled = false;
	const testing::TempFolder folder;
	Simulation simulation(world, route, rig, 5);
	const Calibration actual = rig.actualCalibration(simulation.motion(), 5);
	RawlogReader reader(simulation.run(folder.file("x.rawlog")).rawlog);
	ObservationAdapter adapter;
	double worst_px = 0, first_x = -1, last_x = -1;
	while (const auto observation = reader.next())
	{
		const AdaptedObservation adapted = adapter.convert(observation);
		const auto* image = std::get_if<ImageRef>(&adapted.sample);
		if (image == nullptr) continue;
		const mrpt::img::CImage grey = image->grey();
		const double wall = *grey.ptr<uint8_t>(5, 5);
		Eigen::Vector2d found(0, 0), expected(0, 0);
		double weight = 0;
		for (int y = 0; y < 120; ++y)
			for (int x = 0; x < 160; ++x)
			{
				const double darkness = std::max(0.0, wall - *grey.ptr<uint8_t>(static_cast<unsigned>(x), static_cast<unsigned>(y)) - 2);
				found += darkness * Eigen::Vector2d(x, y);
				weight += darkness;
			}
		found /= weight;
		const Pose3 T_CW = (simulation.motion().at_ns(image->t_ns + nanoseconds(0.04)).T_WO * actual.T_OC).inverse();
		const auto pixel = [&](int i, int j) -> Eigen::Vector2d
		{ return *actual.camera.project(T_CW * Eigen::Vector3d(3.99, 0.4 + 0.04 * i, 0.6 + 0.04 * j)); };
		double area = 0;
		for (int i = -10; i < 10; ++i)
			for (int j = -10; j < 10; ++j)
			{
				const Eigen::Vector2d across = pixel(i + 1, j + 1) - pixel(i, j), back = pixel(i + 1, j) - pixel(i, j + 1);
				const double cell = std::abs(across.x() * back.y() - across.y() * back.x());
				expected += cell * 0.5 * (pixel(i, j) + pixel(i + 1, j + 1));
				area += cell;
			}
		expected /= area;
		worst_px = std::max(worst_px, (found - expected).norm());
		std::cout << (found - expected).transpose() << " at " << found.transpose() << "\n";
		if (first_x < 0) first_x = found.x();
		last_x = found.x();
	}
	measured("panel in the image against its projection, turning at 25 px/s", worst_px, "px");
	EXPECT_LT(worst_px, 0.05) << "0.04 s of the clock would be 1 px";
	EXPECT_GT(last_x - first_x, 30);
}

TEST(Simulation, InterruptedRunLeavesAShorterLog)
{
	const testing::TempFolder folder;
	SimulationRunOptions options;
	options.progress = [](double fraction) { return fraction < 0.4; };
	const SimulationResult result = Simulation(room(), shortRoute(), smallRig(), 3).run(folder.file("x.rawlog"), options);
	EXPECT_TRUE(result.interrupted);
	int64_t images = 0, last_imu_ns = 0;
	RawlogReader reader(result.rawlog);
	while (const auto observation = reader.next())
	{
		images += observation->sensorLabel == "CAM";
		if (observation->sensorLabel == "IMU") last_imu_ns = nanosecondsOf(observation->timestamp);
	}
	EXPECT_EQ(images, result.images);
	EXPECT_GT(images, 5);
	EXPECT_NEAR(secondsBetween(Motion::kDefaultEpoch_ns, last_imu_ns), result.duration_s, 0.011);
	EXPECT_NEAR(secondsBetween(Motion::kDefaultEpoch_ns, Trajectory::loadTum(result.ground_truth).poses().back().t_ns), result.duration_s,
	            0.006);
}

TEST(Simulation, OptionsThatCannotBeAreNamed)
{
	const testing::TempFolder folder;
	const std::string rig_ini = folder.file("rig.ini"), route_ini = folder.file("route.ini");
	testing::writeFile(rig_ini, "[imu]\nrate_hz = 100\n");
	testing::writeFile(route_ini, "[route]\nspeed_m_s = 0.2\n");
	Rig rig;
	Route route;
	loadRun(rig_ini, route_ini, {"imu.rate_hz=400", "wheels.slips=1 2 0.3 0", "route.segments=straight 1 m, stand 2 s"}, rig, route);
	EXPECT_EQ(rig.imu.rate_hz, 400);
	EXPECT_EQ(rig.wheels.slips.size(), 4u);
	EXPECT_EQ(route.parsedSegments().size(), 2u);
	EXPECT_EQ(route.speed_m_s, 0.2);
	for (const char* word : {"imu.rate=1", "imu.rate_hz=fast", "gyro.rate_hz=1", "imu.rate_hz", "rate_hz=3"})
		EXPECT_THROW(loadRun(rig_ini, route_ini, {word}, rig, route), Error) << word;
	testing::expectError([&] { loadRun(route_ini, route_ini, {}, rig, route); }, {route_ini, "not a rig"});
	testing::expectError([&] { loadRun(rig_ini, rig_ini, {}, rig, route); }, {rig_ini, "not a route"});
	EXPECT_THROW(Simulation(room(), shortRoute(), smallRig(), 1).run(folder.file("x.log")), Error);
	Rig bad = smallRig();
	bad.camera.pose = {1, 2, 3};
	EXPECT_THROW(Simulation(room(), shortRoute(), bad, 1).run(folder.file("x.rawlog")), Error);
}
}  // namespace
}  // namespace viwo::sim
