#include "ExpectError.h"
#include "RunProgram.h"
#include "StampRepair.h"
#include "TempFolder.h"

#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <viwo/core/MrptPose.h>
#include <viwo/core/Scalars.h>
#include <viwo/importers/CarmenImporter.h>
#include <viwo/rawlog/MrptTime.h>
#include <viwo/rawlog/RawlogReader.h>

#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <limits>

using namespace viwo;
using namespace viwo::testing;

namespace
{

std::string beams(size_t count)
{
	std::string text = std::to_string(count);
	for (size_t i = 0; i < count; ++i) text += " " + std::to_string(1.0 + 0.01 * static_cast<double>(i));
	return text;
}

std::string laserLine(const std::string& kind, size_t count, const std::string& stamp, const std::string& odometry = "1 2 0.5")
{
	return kind + " " + beams(count) + " 9 9 9 " + odometry + " " + stamp + " host 0.1\n";
}

struct Content
{
	std::vector<mrpt::obs::CObservation2DRangeScan::Ptr> scans;
	std::vector<mrpt::obs::CObservationOdometry::Ptr> odometry;

	explicit Content(const std::string& path)
	{
		RawlogReader reader(path);
		while (const auto o = reader.next())
		{
			if (auto scan = std::dynamic_pointer_cast<mrpt::obs::CObservation2DRangeScan>(o)) scans.push_back(scan);
			if (auto odo = std::dynamic_pointer_cast<mrpt::obs::CObservationOdometry>(o)) odometry.push_back(odo);
		}
	}
};

Content import(const TempFolder& folder, const std::string& log, ImportResult* result = nullptr)
{
	writeFile(folder.file("x.clf"), log);
	const ImportResult r = importCarmen({folder.file("x.clf"), folder.file("x.rawlog")});
	if (result) *result = r;
	return Content(folder.file("x.rawlog"));
}

/** Angle of a beam in the robot's frame. */
double beamAngle(const mrpt::obs::CObservation2DRangeScan& scan, size_t beam)
{
	const double n = static_cast<double>(scan.getScanSize());
	return scan.sensorPose.yaw() - 0.5 * scan.aperture + static_cast<double>(beam) * scan.aperture / (n - 1);
}
}  // namespace

TEST(CarmenImporter, FirstBeamStepAndApertureByNumberOfBeams)
{
	struct Case
	{
		size_t beams;
		double step_deg, aperture_deg;
	};
	for (const Case& c : {Case{180, 1, 179}, {181, 1, 180}, {360, 0.5, 179.5}, {361, 0.5, 180}})
	{
		const TempFolder folder;
		const Content content = import(folder, laserLine("FLASER", c.beams, "100.5"));
		ASSERT_EQ(content.scans.size(), 1u);
		const auto& scan = *content.scans[0];
		EXPECT_EQ(scan.getScanSize(), c.beams);
		EXPECT_NEAR(scan.aperture, c.aperture_deg * kDegree, 1e-6);
		EXPECT_NEAR(beamAngle(scan, 0), -90 * kDegree, 1e-6) << c.beams;
		EXPECT_NEAR(beamAngle(scan, 1), (-90 + c.step_deg) * kDegree, 1e-6) << c.beams;
		EXPECT_TRUE(scan.rightToLeft);
		EXPECT_FLOAT_EQ(scan.getScanRange(7), 1.07f);
	}
}

TEST(CarmenImporter, OdometryIsThatOfTheScansOwnLine)
{
	const TempFolder folder;
	const Content content =
	    import(folder,
	           "# a comment\nPARAM robot_frontlaser_offset -0.04 host 0\nPARAM robot_rearlaser_offset -0.3 host 0\n"
	           "ODOM 5 6 0.7 0 0 0 100.1 host 0\n" +
	               laserLine("FLASER", 180, "100.2", "1 2 0.5") + laserLine("RLASER", 181, "100.25", "1 2 0.5") + "SYNC tagname 1\n");
	ASSERT_EQ(content.scans.size(), 2u);
	ASSERT_EQ(content.odometry.size(), 2u);
	EXPECT_EQ(content.odometry[0]->sensorLabel, "ODOM");
	EXPECT_EQ(content.odometry[0]->odometry.x(), 5);
	EXPECT_EQ(content.odometry[1]->sensorLabel, "ODOMETRY");
	EXPECT_EQ(content.odometry[1]->odometry, mrpt::poses::CPose2D(1, 2, 0.5));
	EXPECT_EQ(content.odometry[1]->timestamp, content.scans[0]->timestamp);
	EXPECT_NEAR(content.scans[0]->sensorPose.x(), -0.04, 1e-9);
	EXPECT_NEAR(content.scans[1]->sensorPose.x(), -0.3, 1e-9);
	EXPECT_NEAR(std::abs(content.scans[1]->sensorPose.yaw()), M_PI, 1e-6);
}

TEST(CarmenImporter, RobotLaserLineCarriesItsOwnGeometry)
{
	const TempFolder folder;
	// Robot at (1, 2) looking along y, laser 0.2 m ahead of it; 3 beams from -10 deg in steps of 10 deg, one beyond 30 m.
	const std::string line = "ROBOTLASER1 0 " + std::to_string(-10 * kDegree) + " 0.35 " + std::to_string(10 * kDegree) +
	                         " 30 0.01 0 3 4 5 31 2 7 7 1 2.2 " + std::to_string(M_PI / 2) + " 1 2 " + std::to_string(M_PI / 2) +
	                         " 0.3 0.1 1 1 0 123.5 host 0.5\n";
	const Content content = import(folder, line);
	ASSERT_EQ(content.scans.size(), 1u);
	const auto& scan = *content.scans[0];
	EXPECT_NEAR(scan.sensorPose.x(), 0.2, 1e-6);
	EXPECT_NEAR(scan.sensorPose.y(), 0, 1e-6);
	EXPECT_NEAR(beamAngle(scan, 0), -10 * kDegree, 1e-5);
	EXPECT_NEAR(beamAngle(scan, 2), 10 * kDegree, 1e-5);
	EXPECT_TRUE(scan.getScanRangeValidity(1));
	EXPECT_FALSE(scan.getScanRangeValidity(2));
	EXPECT_EQ(nanosecondsOf(scan.timestamp), 123500000000);
	EXPECT_NEAR(content.odometry[0]->odometry.phi(), M_PI / 2, 1e-5);
}

TEST(CarmenImporter, StampsThatRunBackKeepTheOrderOfTheFile)
{
	const TempFolder folder;
	std::string log;
	const std::vector<std::string> stamps{"10.000001", "10.2", "10.9", "10.6", "10.8", "11.0"};
	for (size_t i = 0; i < stamps.size(); ++i) log += laserLine("FLASER", 180, stamps[i], std::to_string(i) + " 0 0");
	ImportResult result;
	const Content content = import(folder, log, &result);
	ASSERT_EQ(content.odometry.size(), stamps.size());
	for (size_t i = 0; i < stamps.size(); ++i) EXPECT_EQ(content.odometry[i]->odometry.x(), static_cast<double>(i));
	for (size_t i = 1; i < stamps.size(); ++i) EXPECT_LT(content.scans[i - 1]->timestamp, content.scans[i]->timestamp);
	ASSERT_EQ(result.notes.size(), 1u);
	EXPECT_NE(result.notes[0].find("run back 1 time;"), std::string::npos) << result.notes[0];

	std::istringstream csv(readFile(folder.file("x_stamps.csv")));
	std::string line;
	std::getline(csv, line);
	EXPECT_EQ(line, "rawlog_ns,original_s");
	for (size_t i = 0; std::getline(csv, line); ++i)
		EXPECT_EQ(line, std::to_string(nanosecondsOf(content.scans.at(i)->timestamp)) + "," + stamps.at(i));
	EXPECT_EQ(nanosecondsOf(content.scans[0]->timestamp), 10000001000) << "a stamp that is in order stays";
}

TEST(StampRepair, IncreasesAndChangesNothingElse)
{
	const std::vector<int64_t> good{1000, 2000, 5000, 900000};
	EXPECT_EQ(repairStamps(good).t_ns, good);
	EXPECT_EQ(repairStamps(good).changed, 0u);
	const RepairedStamps repaired = repairStamps({0, 1000000, 1000000, 1000000, 500000, 2000000, -1000000, 3000000});
	for (size_t i = 1; i < repaired.t_ns.size(); ++i) EXPECT_GT(repaired.t_ns[i], repaired.t_ns[i - 1]);
	EXPECT_EQ(repaired.backwards, 4u);
	EXPECT_TRUE(repairStamps({}).t_ns.empty());
}

TEST(CarmenImporter, ReadsGzip)
{
	const TempFolder folder;
	const std::string log = laserLine("FLASER", 181, "100.5");
	gzFile file = gzopen(folder.file("x.clf.gz").c_str(), "wb");
	ASSERT_GT(gzwrite(file, log.data(), static_cast<unsigned>(log.size())), 0);
	gzclose(file);
	EXPECT_EQ(importCarmen({folder.file("x.clf.gz"), folder.file("x.rawlog")}).scans, 1u);
	const std::string whole = readFile(folder.file("x.clf.gz"));
	writeFile(folder.file("cut.gz"), whole.substr(0, whole.size() / 2));
	expectError([&] { importCarmen({folder.file("cut.gz"), folder.file("y.rawlog")}); }, {"cut.gz", "cut short"});
}

TEST(CarmenImporter, SaysWhatIsWrongInOneLine)
{
	const TempFolder folder;
	const auto expectFailure = [&](const std::string& log, std::initializer_list<std::string> parts)
	{
		writeFile(folder.file("x.clf"), log);
		expectError([&] { importCarmen({folder.file("x.clf"), folder.file("x.rawlog")}); }, parts);
	};
	expectFailure("", {"x.clf", "the file is empty"});
	expectFailure("hello\n", {"x.clf", "no FLASER"});
	expectFailure("FLASER\n", {"x.clf:1", "ends too early"});
	expectFailure("# c\nFLASER 3 1 2\n", {"x.clf:2", "ends too early"});
	expectFailure("FLASER -3 1 2\n", {"x.clf:1", "'-3'"});
	expectFailure("FLASER 2 1 x 0 0 0 0 0 0 1 host 1\n", {"x.clf:1", "'x'"});
	expectFailure("FLASER 2 1 nan 0 0 0 0 0 0 1 host 1\n", {"x.clf:1", "'nan'"});
	expectFailure("FLASER 2 1 1 0 0 0 0 0 0 soon host 1\n", {"x.clf:1", "'soon'"});
	expectFailure("FLASER 0 0 0 0 0 0 0 1 host 1\n", {"x.clf", "without readings"});
	expectFailure(std::string("FLASER 1\0 1", 11), {"x.clf", "not text"});
	expectFailure("BZh9 is no archive", {"x.clf", "bzip2"});
	expectError([&] { importCarmen({folder.file("absent"), folder.file("x.rawlog")}); }, {"absent", "no such file"});
	expectError([&] { importCarmen({folder.path(), folder.file("x.rawlog")}); }, {"is a folder"});
	EXPECT_FALSE(std::filesystem::exists(folder.file("x.rawlog")));
}

TEST(CarmenImporter, Program)
{
	const TempFolder folder;
	writeFile(folder.file("x.clf"), laserLine("FLASER", 180, "1.5") + laserLine("FLASER", 180, "1.7"));
	const ProgramResult result =
	    runProgram(VIWO_BINARY_DIR "/bin/viwo-import", {"carmen", folder.file("x.clf"), "-o", folder.file("x.rawlog")});
	EXPECT_EQ(result.status, 0) << result.err;
	EXPECT_NE(result.out.find("2 scans, 2 odometry samples"), std::string::npos) << result.out;
	EXPECT_NE(result.out.find("x_stamps.csv"), std::string::npos) << result.out;
}

TEST(CarmenImporter, RealIntelLog)
{
	const char* root = std::getenv("VIWO_TEST_DATA");
	if (root == nullptr) GTEST_SKIP() << "VIWO_TEST_DATA is not set";
	const TempFolder folder;
	const ImportResult result = importCarmen({std::string(root) + "/slam_benchmark/intel.clf.bz2", folder.file("x.rawlog")});
	EXPECT_EQ(result.scans, 13631u);
	ASSERT_FALSE(result.notes.empty());
	std::cout << "[measured] " << result.notes[0] << "\n";
	EXPECT_NE(result.notes[0].find("run back 631 times"), std::string::npos);
	const Content content(folder.file("x.rawlog"));
	ASSERT_EQ(content.scans.size(), 13631u);
	double path_m = 0;
	const mrpt::obs::CObservationOdometry* last = nullptr;
	for (const auto& odometry : content.odometry)
	{
		if (odometry->sensorLabel != "ODOMETRY") continue;
		if (last) path_m += last->odometry.distanceTo(odometry->odometry);
		last = odometry.get();
	}
	std::cout << "[measured] odometry path " << path_m << " m (508 m in the order of the file, 661 m by original stamps)\n";
	EXPECT_NEAR(path_m, 508.35, 0.1);
}
