#include "ExpectError.h"
#include "RandomTrajectory.h"
#include "RunProgram.h"

#include <viwo/core/Scalars.h>
#include <viwo/core/TimeText.h>
#include <viwo/evaluation/RelationErrors.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <iostream>
#include <random>

using namespace viwo;
using namespace viwo::testing;

namespace
{
Pose3 planar(double x, double y, double yaw_rad)
{
	return {Eigen::Quaterniond(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ())), Eigen::Vector3d(x, y, 0)};
}

Trajectory threePoses()
{
	Trajectory trajectory;
	trajectory.push_back({1'000'000'000, planar(1, 2, M_PI / 2)});
	trajectory.push_back({2'000'000'000, planar(1, 3, M_PI)});
	trajectory.push_back({3'000'000'000, planar(-1, 3, -M_PI / 2)});
	return trajectory;
}
}  // namespace

TEST(RelationErrors, ByHand)
{
	// Seen from the first pose the second is at (1, 0), turned by 90 deg; from the second the third is at (2, 0), turned by 90 deg.
	const std::vector<Relation> relations{{1'000'000'000, 2'000'000'000, 1, 0, M_PI / 2},
	                                      {1'000'000'000, 2'000'000'000, 0.7, 0.4, M_PI / 2 - 0.1},
	                                      {2'000'000'000, 3'000'001'999, 2, 0.3, M_PI / 2 + 0.2},
	                                      {2'000'000'000, 3'000'002'001, 5, 5, 0}};
	const RelationErrors e = relationErrors(relations, threePoses());
	EXPECT_EQ(e.relations, 4u);
	EXPECT_EQ(e.evaluated, 3u) << "the last one is 1 ns too far from any pose";
	EXPECT_NEAR(e.translation_m.mean, (0 + 0.5 + 0.3) / 3, 1e-12);
	EXPECT_NEAR(e.translation_m.max, 0.5, 1e-12);
	EXPECT_NEAR(e.translation_m.rms, std::sqrt((0.25 + 0.09) / 3), 1e-12);
	const double mean = 0.8 / 3;
	EXPECT_NEAR(e.translation_m.deviation, std::sqrt((mean * mean + square(0.5 - mean) + square(0.3 - mean)) / 3), 1e-12);
	EXPECT_NEAR(e.rotation_deg.mean, 0.1 / kDegree, 1e-9);
	EXPECT_NEAR(e.rotation_deg.max, 0.2 / kDegree, 1e-9);
}

TEST(RelationErrors, RotationsWrapAround)
{
	const RelationErrors e = relationErrors({{1'000'000'000, 3'000'000'000, 1, 2, -M_PI + 0.01}}, threePoses());
	EXPECT_NEAR(e.translation_m.max, 0, 1e-12);
	EXPECT_NEAR(e.rotation_deg.max, 0.01 / kDegree, 1e-9);
}

TEST(RelationErrors, OfASensorOnTheRobot)
{
	RelationOptions options;
	options.T_OS = planar(0.5, 0, 0);
	// The sensor is half a metre ahead: at (1, 2.5) first and at (0.5, 3) then; seen from the first one that is half a metre ahead and half
	// a metre to the left.
	const RelationErrors e = relationErrors({{1'000'000'000, 2'000'000'000, 0.5, 0.5, M_PI / 2}}, threePoses(), options);
	EXPECT_NEAR(e.translation_m.max, 0, 1e-12);
	EXPECT_NEAR(e.rotation_deg.max, 0, 1e-9);
}

TEST(RelationErrors, OriginalStampsLeadToThoseOfTheRawlog)
{
	const TempFolder folder;
	writeFile(folder.file("s.csv"), "rawlog_ns,original_s\n1000000000,77.123456\n2000000000,76.9\n");
	writeFile(folder.file("r.relations"), "# a remark\n\n77.123456 76.900000 1 0 0 0 0 1.5707963\n77.123456 99 1 0 0 0 0 0\n");
	RelationOptions options;
	options.stamps = loadStampTable(folder.file("s.csv"));
	const RelationErrors e = relationErrors(loadRelations(folder.file("r.relations")), threePoses(), options);
	EXPECT_EQ(e.relations, 2u);
	EXPECT_EQ(e.evaluated, 1u);
	EXPECT_LT(e.translation_m.max, 1e-9);
}

TEST(RelationErrors, SaysWhatIsWrongInOneLine)
{
	const TempFolder folder;
	const auto expectBad = [&](const std::string& text, std::initializer_list<std::string> parts)
	{
		writeFile(folder.file("r"), text);
		expectError([&] { loadRelations(folder.file("r")); }, parts);
	};
	expectBad("", {"r", "empty"});
	expectBad("# x\n", {"r", "holds no relation"});
	expectBad("# x\n1 2 3 4\n", {"r:2", "4 columns", "t1 t2 x y z roll pitch yaw"});
	expectBad("1 two 0 0 0 0 0 0\n", {"r:1", "'two'"});
	expectBad("1 2 0 0 0 0 0 nan\n", {"r:1", "'nan'"});
	expectError([&] { loadRelations(folder.file("absent")); }, {"absent", "cannot read"});
	writeFile(folder.file("s"), "1,2\n");
	expectError([&] { loadStampTable(folder.file("s")); }, {"s:1", "no column 'rawlog_ns'"});
	writeFile(folder.file("s"), "rawlog_ns,original_s\nx,2\n");
	expectError([&] { loadStampTable(folder.file("s")); }, {"s:2", "'x'"});
	expectError([&] { relationErrors({{5, 6, 0, 0, 0}}, threePoses()); }, {"none of the 1 relations", "--stamps"});
}

/** Beside the field's script in Python, where it and its numpy are there. */
TEST(RelationsProgram, AgreesWithTheReferenceScript)
{
	const char* root = std::getenv("VIWO_TEST_DATA");
	const std::string script = root == nullptr ? "" : std::string(root) + "/../tools/relation_error.py";
	if (root == nullptr || !std::filesystem::exists(script))
		GTEST_SKIP() << "VIWO_TEST_DATA is not set, or has no ../tools/relation_error.py";
	if (runProgram("/usr/bin/python3", {"-c", "import numpy"}).status != 0) GTEST_SKIP() << "python3-numpy is not installed";

	const TempFolder folder;
	const Trajectory drive = windingDrive(200, 60);
	drive.saveTum(folder.file("e.tum"));
	std::mt19937_64 random(3);
	std::uniform_int_distribution<size_t> any(0, drive.size() - 1);
	std::normal_distribution<double> noise;
	std::string relations, stamps = "rawlog_ns,original_s\n";
	const auto original = [&](size_t i) { return formatSeconds(drive.poses()[i].t_ns / 1000 * 1000 + 500'000'000'000); };
	for (size_t i = 0; i < drive.size(); ++i) stamps += std::to_string(drive.poses()[i].t_ns) + "," + original(i) + "\n";
	for (int k = 0; k < 300; ++k)
	{
		const size_t i = any(random), j = any(random);
		const Pose3 T = drive.poses()[i].T.inverse() * drive.poses()[j].T;
		char text[256];
		std::snprintf(text, sizeof text, "%s %s %.9f %.9f 0 0 0 %.9f\n", original(i).c_str(), original(j).c_str(),
		              T.p.x() + 0.05 * noise(random), T.p.y() + 0.05 * noise(random), yawOf(T.R) + 0.01 * noise(random));
		relations += text;
	}
	writeFile(folder.file("r.relations"), relations + "1 2 0 0 0 0 0 0\n");
	writeFile(folder.file("s.csv"), stamps);
	const ProgramResult ours =
	    runProgram(VIWO_BINARY_DIR "/bin/viwo-evaluate", {"relations", "-r", folder.file("r.relations"), "-e", folder.file("e.tum"),
	                                                      "--stamps", folder.file("s.csv"), "--json", folder.file("e.json")});
	ASSERT_EQ(ours.status, 0) << ours.err;
	// Six digits behind the point instead of the script's own four.
	const std::string print =
	    "import sys; sys.path.insert(0, sys.argv[1]); import numpy as np, relation_error as r\n"
	    "T, P = r.load(sys.argv[2], 'tum')\n"
	    "M = {round(float(w[1]) * 1e6): int(w[0]) * 1e-9 for w in (l.split(',') for l in list(open(sys.argv[4]))[1:])}\n"
	    "R = np.array([[float(v) for v in l.split()] for l in open(sys.argv[3])])\n"
	    "R[:, :2] = [[M.get(round(v * 1e6), np.nan) for v in row] for row in R[:, :2]]\n"
	    "R = R[~np.isnan(R[:, :2]).any(1)]\n"
	    "ok, t, w, ref = r.evaluate(T, P, R, 2e-6)\n"
	    "d = np.degrees(w)\n"
	    "print(ok.sum(), *('%.9f' % v for v in (t.mean(), t.std(), t.max(), d.mean(), d.std(), d.max())))\n";
	const ProgramResult theirs = runProgram("/usr/bin/python3", {"-c", print, std::filesystem::path(script).parent_path().string(),
	                                                             folder.file("e.tum"), folder.file("r.relations"), folder.file("s.csv")});
	ASSERT_EQ(theirs.status, 0) << theirs.err;
	const Json json = loadJson(folder.file("e.json"));
	std::istringstream figures(theirs.out);
	size_t evaluated = 0;
	figures >> evaluated;
	EXPECT_EQ(json["evaluated"], evaluated);
	EXPECT_EQ(json["relations"], 301u);
	for (const char* key : {"trans_mean_m", "trans_deviation_m", "trans_max_m", "rot_mean_deg", "rot_deviation_deg", "rot_max_deg"})
	{
		double theirs_value = std::nan("");
		figures >> theirs_value;
		std::cout << "[measured] " << key << " " << json[key] << ", script " << theirs_value << "\n";
		EXPECT_NEAR(json[key].get<double>(), theirs_value, 1e-6) << key;
	}
}

TEST(RelationsProgram, HelpUsageAndTable)
{
	const std::string program = VIWO_BINARY_DIR "/bin/viwo-evaluate";
	EXPECT_EQ(runProgram(program, {"relations", "--help"}).status, 0);
	const ProgramResult usage = runProgram(program, {"relations"});
	EXPECT_EQ(usage.status, 2);
	EXPECT_EQ(usage.errorLines(), 1u) << usage.err;

	const TempFolder folder;
	threePoses().saveTum(folder.file("e.tum"));
	writeFile(folder.file("r"), "1 2 1 0 0 0 0 1.5707963\n");
	const ProgramResult result =
	    runProgram(program, {"relations", "-r", folder.file("r"), "-e", folder.file("e.tum"), "--sensor", "0.1", "0", "90"});
	EXPECT_EQ(result.status, 0) << result.err;
	EXPECT_NE(result.out.find("sensor"), std::string::npos) << result.out;
	EXPECT_EQ(result.err, "");
	writeFile(folder.file("r"), "1 2 1 0 0 0 0 1.5707963\n1 12 1 0 0 0 0 1.5707963\n11 2 1 0 0 0 0 1.5707963\n");
	const ProgramResult some = runProgram(program, {"relations", "-r", folder.file("r"), "-e", folder.file("e.tum")});
	EXPECT_EQ(some.status, 0);
	EXPECT_NE(some.out.find("1/3"), std::string::npos) << some.out;
	EXPECT_EQ(some.errorLines(), 1u) << some.err;
	EXPECT_NE(some.err.find("only 1 of 3 relations"), std::string::npos) << some.err;
	EXPECT_NE(some.err.find("--stamps"), std::string::npos) << some.err;
	const ProgramResult nowhere =
	    runProgram(program, {"relations", "-r", folder.file("r"), "-e", folder.file("e.tum"), "--sensor", "0.1", "nan", "90"});
	EXPECT_EQ(nowhere.status, 2);
	EXPECT_NE(nowhere.err.find("--sensor: 'nan' is not a finite number"), std::string::npos) << nowhere.err;
	writeFile(folder.file("r"), "11 12 1 0 0 0 0 1.5707963\n");
	const ProgramResult none = runProgram(program, {"relations", "-r", folder.file("r"), "-e", folder.file("e.tum")});
	EXPECT_EQ(none.status, 1);
	EXPECT_EQ(none.errorLines(), 1u) << none.err;
	EXPECT_NE(none.err.find("e.tum against"), std::string::npos) << none.err;
}
