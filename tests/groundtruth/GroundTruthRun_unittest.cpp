#include "RoomRun.h"

#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDF.h>
#include <mrpt/serialization/CArchive.h>
#include <viwo/mapping/OccupancyImage.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <iostream>
#include <sstream>

using namespace viwo;
using namespace viwo::gt;
using namespace viwo::testing;

namespace
{
nlohmann::json summaryOf(const TempFolder& folder, const std::string& out = "out")
{
	return nlohmann::json::parse(readFile(folder.file(out + "/summary.json")));
}

void expectSameFiles(const TempFolder& folder, const std::string& a, const std::string& b, std::initializer_list<const char*> names)
{
	for (const char* name : names) EXPECT_EQ(readFile(folder.file(a + "/" + name)), readFile(folder.file(b + "/" + name))) << name;
}
/** The image is the grid, free where the robot was, and occupied where the walls are. */
void expectMapIsTheRoom(const TempFolder& folder, const RoomLog& log)
{
	mrpt::maps::COccupancyGridMap2D grid;
	mrpt::io::CFileGZInputStream file(folder.file("out/map.gridmap.gz"));
	mrpt::serialization::archiveFrom(file) >> grid;
	OccupancyImage image = loadMapServer(folder.file("out/map.yaml"));
	EXPECT_EQ(image.columns, static_cast<int>(grid.getSizeX()));
	EXPECT_EQ(image.rows, static_cast<int>(grid.getSizeY()));
	EXPECT_NEAR(image.min_x_m, static_cast<double>(grid.getXMin()), 1e-4);
	EXPECT_NEAR(image.min_y_m, static_cast<double>(grid.getYMin()), 1e-4);
	EXPECT_TRUE(image.cells == occupancyImage(grid).cells);
	const auto cellAt = [&](const Eigen::Vector2d& p)
	{
		return image.cell(static_cast<int>((p.x() - image.min_x_m) / image.resolution_m),
		                  static_cast<int>((p.y() - image.min_y_m) / image.resolution_m));
	};
	const Trajectory trajectory = Trajectory::loadTum(folder.file("out/trajectory.tum"));
	size_t free = 0;
	for (const StampedPose& pose : trajectory.poses()) free += cellAt(pose.T.p.head<2>()) == OccupancyImage::kFree;
	EXPECT_EQ(free, trajectory.size());
	// From where the robot was to the wall on its right: a metre or less.
	size_t near_walls = 0;
	for (const StampedPose& pose : trajectory.poses())
	{
		const double range_m = static_cast<double>(log.range(log.truth.at(pose.t_ns), -M_PI / 2));
		bool occupied = false;
		for (double d = -0.1; d <= 0.1; d += 0.025)
			occupied |= cellAt(pose2(pose.T) * Eigen::Vector2d(0, -range_m + d)) == OccupancyImage::kOccupied;
		near_walls += occupied;
	}
	EXPECT_GT(near_walls, trajectory.size() * 9 / 10);
}

/** Its key frames are the vertices of the graph, with their scans. */
void expectSimpleMapIsTheGraph(const TempFolder& folder, const RoomLog& log, const GroundTruthRunResult& result)
{
	mrpt::maps::CSimpleMap map;
	ASSERT_TRUE(map.loadFromFile(folder.file("out/map.simplemap")));
	EXPECT_EQ(map.size(), result.key_scans);
	std::istringstream graph(readFile(folder.file("out/graph.g2o")));
	std::string tag;
	size_t id = 0;
	double x = 0, y = 0, yaw = 0;
	for (size_t k = 0; k < map.size(); ++k)
	{
		graph >> tag >> id >> x >> y >> yaw;
		ASSERT_EQ(tag, "VERTEX_SE2");
		mrpt::poses::CPose3DPDF::Ptr pose;
		mrpt::obs::CSensoryFrame::Ptr frame;
		map.get(k, pose, frame);
		const auto mean = pose->getMeanVal();
		EXPECT_NEAR(mean.x(), x, 1e-6);
		EXPECT_NEAR(mean.y(), y, 1e-6);
		EXPECT_NEAR(wrapped(mean.yaw() - yaw), 0, 1e-6);
		const auto scan = frame->getObservationByClass<mrpt::obs::CObservation2DRangeScan>();
		ASSERT_TRUE(scan);
		ASSERT_EQ(scan->getScanSize(), static_cast<size_t>(log.beams));
		const Pose2 truth = RoomLog::poseAt(0.12 * static_cast<double>(id));
		EXPECT_NEAR(scan->getScanRange(90), log.range(truth, 0), 6 * log.noise_m);
	}
}
}  // namespace

TEST(GroundTruthRun, TwiceAroundTheBlock)
{
	const TempFolder folder;
	RoomLog log;
	log.write(folder.file("x.rawlog"));
	GroundTruthRunOptions options = optionsFor(folder);
	const GroundTruthRunResult result = runGroundTruth(options);
	const RoomErrors e = errorsOf(folder, log);
	std::cout << "[measured] " << result.loops_accepted << " loops, rms " << e.rms_m << " m, max " << e.max_m << " m\n";
	EXPECT_GT(result.loops_accepted, 2u);
	EXPECT_LT(e.rms_m, 0.04);
	EXPECT_EQ(result.odometry_only, 0u);
	for (const char* name : {"trajectory.tum", "trajectory_covariance.csv", "graph.g2o", "graph_stamps.csv", "map.yaml", "map.pgm",
	                         "map.png", "map.simplemap", "map.gridmap.gz", "summary.json", "config.ini"})
		EXPECT_GT(std::filesystem::file_size(folder.file(std::string("out/") + name)), 0u) << name;

	EXPECT_EQ(e.poses, log.truth.size());
	const auto odometry = summaryOf(folder)["odometry"];
	std::cout << "[measured] odometry " << odometry << "\n";
	EXPECT_NEAR(odometry["turn_scale"].get<double>(), 1 / log.turn_scale, 0.01);
	EXPECT_NEAR(odometry["distance_scale"].get<double>(), 1 / log.distance_scale, 0.01);
	EXPECT_FALSE(odometry["time_offset_significant"]);
	expectMapIsTheRoom(folder, log);
	expectSimpleMapIsTheGraph(folder, log, result);

	// The same bytes with two threads.
	options = optionsFor(folder, "two");
	options.threads = 2;
	runGroundTruth(options);
	expectSameFiles(folder, "out", "two",
	                {"trajectory.tum", "trajectory_covariance.csv", "graph.g2o", "graph_stamps.csv", "map.yaml", "map.pgm", "map.png",
	                 "map.simplemap", "map.gridmap.gz", "config.ini"});

	// Another program reads the map.
	const ProgramResult read = runProgram("/usr/bin/ros-map-yaml2mrpt", {"-i", folder.file("out/map.yaml"), "-d", folder.path(), "-w"});
	EXPECT_EQ(read.status, 0) << read.out << read.err;
}

TEST(GroundTruthRun, AWrongLoopByHandIsRejected)
{
	const TempFolder folder;
	RoomLog log;
	log.write(folder.file("x.rawlog"));
	GroundTruthRunOptions options = optionsFor(folder);
	options.extra_loops = {{20, 140, 0, 0, 0}, {60, 250, 1, 0, 1.5}};
	const GroundTruthRunResult result = runGroundTruth(options);
	const GroundTruthRunResult clean = runGroundTruth(optionsFor(folder, "clean"));
	const RoomErrors with = errorsOf(folder, log), without = errorsOf(folder, log, "clean");
	std::cout << "[measured] rms with wrong loops " << with.rms_m << " m, without " << without.rms_m << " m\n";
	EXPECT_EQ(clean.loops_rejected, 0u);
	EXPECT_EQ(result.loops_rejected, 2u);
	EXPECT_NEAR(with.rms_m, without.rms_m, 0.01);
}

TEST(GroundTruthRun, WithoutOdometry)
{
	const TempFolder folder;
	RoomLog log;
	log.with_odometry = false;
	log.write(folder.file("x.rawlog"));
	const GroundTruthRunResult result = runGroundTruth(optionsFor(folder));
	const RoomErrors e = errorsOf(folder, log);
	std::cout << "[measured] rms " << e.rms_m << " m\n";
	EXPECT_LT(e.rms_m, 0.05);
	ASSERT_FALSE(result.notes.empty());
	EXPECT_NE(result.notes.back().find("constant velocity"), std::string::npos);
}

TEST(GroundTruthRun, ScansAloneAreComparedWithOdometryToo)
{
	const TempFolder folder;
	RoomLog log;
	log.write(folder.file("x.rawlog"));
	GroundTruthRunOptions options = optionsFor(folder);
	options.options.graph.odometry_edges = false;
	runGroundTruth(options);
	const RoomErrors e = errorsOf(folder, log);
	const auto json = summaryOf(folder);
	std::cout << "[measured] rms " << e.rms_m << " m; against the graph with odometry " << json["against_odometry_edges"] << "\n";
	EXPECT_LT(e.rms_m, 0.05);
	EXPECT_EQ(json["odometry_edges"], false);
	EXPECT_GT(json["against_odometry_edges"]["max_m"], 0.0);
	EXPECT_LT(json["against_odometry_edges"]["mean_m"], 0.03);

	runGroundTruth(optionsFor(folder, "with"));
	EXPECT_FALSE(summaryOf(folder, "with").contains("against_odometry_edges"));
	EXPECT_NE(readFile(folder.file("out/trajectory.tum")), readFile(folder.file("with/trajectory.tum")));
}

TEST(GroundTruthRun, AlignsWallsWithTheAxes)
{
	const TempFolder folder;
	RoomLog log;
	log.scans = 300;
	log.start_m = 9;  // in the first bend, between two directions of walls
	log.write(folder.file("x.rawlog"));
	const double first_yaw = log.truth.begin()->second.yaw;
	ASSERT_GT(std::abs(std::remainder(first_yaw, M_PI / 2)), 0.3);
	GroundTruthRunOptions options = optionsFor(folder);
	options.align_axes = true;
	runGroundTruth(options);
	// The true walls lie along the axes: so each yaw is the true one, up to quarters.
	double worst = 0;
	const Trajectory aligned = Trajectory::loadTum(folder.file("out/trajectory.tum"));
	for (const StampedPose& pose : aligned.poses())
		worst = std::max(worst, std::abs(std::remainder(yawOf(pose.T.R) - log.truth.at(pose.t_ns).yaw, M_PI / 2)));
	std::cout << "[measured] yaw against the axes of the walls: at most " << worst * 180 / M_PI << " deg\n";
	EXPECT_LT(worst, 1.0 * M_PI / 180);
	EXPECT_LT(errorsOf(folder, log).rms_m, 0.05);

	runGroundTruth(optionsFor(folder, "as_driven"));
	const Trajectory as_driven = Trajectory::loadTum(folder.file("as_driven/trajectory.tum"));
	EXPECT_NEAR(yawOf(as_driven.poses()[0].T.R), 0, 0.01) << "without the option the first pose is the origin";
}

TEST(GroundTruthRun, SeveralRawlogsAreOneSession)
{
	const TempFolder folder;
	RoomLog log;
	log.scans = 200;
	log.write(folder.file("x.rawlog"));
	runGroundTruth(optionsFor(folder));
	log.second_from = 90;
	log.second_path = folder.file("b.rawlog");
	log.write(folder.file("a.rawlog"));
	GroundTruthRunOptions options = optionsFor(folder, "parts");
	options.rawlogs = {folder.file("a.rawlog"), folder.file("b.rawlog")};
	runGroundTruth(options);
	EXPECT_EQ(summaryOf(folder, "parts")["scans"], 200);
	expectSameFiles(folder, "out", "parts", {"trajectory.tum", "trajectory_covariance.csv", "graph.g2o", "map.pgm"});
}

TEST(GroundTruthRun, HoldsScansOut)
{
	const TempFolder folder;
	RoomLog log;
	log.write(folder.file("x.rawlog"));
	GroundTruthRunOptions options = optionsFor(folder);
	options.holdout = true;
	runGroundTruth(options);
	const auto holdout = summaryOf(folder)["holdout"];
	std::cout << "[measured] hold-out " << holdout << "\n";
	EXPECT_GT(holdout["scans"], 50);
	EXPECT_LT(holdout["median_m"], 0.01);
	EXPECT_GT(holdout["p95_m"], holdout["median_m"]);
	// The ninth of each ten is no key scan.
	std::istringstream stamps(readFile(folder.file("out/graph_stamps.csv")));
	std::string line;
	std::getline(stamps, line);
	while (std::getline(stamps, line)) EXPECT_NE(std::stoul(line) % 10, 9u) << line;
}

TEST(GroundTruthProgram, HelpAndUsage)
{
	const std::string program = VIWO_BINARY_DIR "/bin/viwo-groundtruth";
	const ProgramResult help = runProgram(program, {"--help"});
	EXPECT_EQ(help.status, 0);
	EXPECT_NE(help.out.find("Examples:"), std::string::npos);
	EXPECT_EQ(runProgram(program, {}).status, 2);
	for (const char* resolution : {"nan", "inf", "0", "-1", "1e-9", "1e9"})
	{
		const ProgramResult bad = runProgram(program, {"-i", "x.rawlog", "-o", "/nowhere/at/all", "--resolution", resolution});
		EXPECT_EQ(bad.status, 2) << resolution;
		EXPECT_EQ(bad.errorLines(), 1u) << bad.err;
	}
	const TempFolder folder;
	const ProgramResult failed = runProgram(program, {"-i", "absent.rawlog", "-o", folder.file("nowhere/at/all")});
	EXPECT_EQ(failed.status, 1);
	EXPECT_EQ(failed.errorLines(), 1u) << failed.err;
	EXPECT_FALSE(std::filesystem::exists(folder.file("nowhere")));
}

TEST(GroundTruthProgram, SampleRawlog)
{
	const TempFolder folder;
	const ProgramResult result = runProgram(VIWO_BINARY_DIR "/bin/viwo-groundtruth",
	                                        {"-i", VIWO_SOURCE_DIR "/rawlogs/sample.rawlog", "-o", folder.file("out"), "--holdout"});
	EXPECT_EQ(result.status, 0) << result.err;
	EXPECT_NE(readFile(folder.file("out/summary.json")).find("\"holdout\""), std::string::npos);
}
