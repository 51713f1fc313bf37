#include "RandomTrajectory.h"
#include "RunProgram.h"

#include <viwo/evaluation/Json.h>

#include <gtest/gtest.h>

#include <cstdio>
#include <sstream>

using namespace viwo;
using namespace viwo::testing;

/** viwo-evaluate as a user runs it. */
class EvaluateProgram : public ::testing::Test
{
   protected:
	void SetUp() override
	{
		reference_ = windingDrive(50, 30);
		reference_.saveTum(folder_.file("ref.tum"));
		const Pose3 T(Eigen::Quaterniond(Eigen::AngleAxisd(1, Eigen::Vector3d::UnitZ())), Eigen::Vector3d(1, 2, 3));
		transformed(reference_, [&](const Pose3& pose) { return T * pose; }).saveTum(folder_.file("moved.tum"));
		transformed(reference_, [&](Pose3 pose) { return pose.p *= 1.1, pose; }).saveTum(folder_.file("scaled.tum"));
	}

	static ProgramResult run(const std::vector<std::string>& arguments)
	{
		return runProgram(VIWO_BINARY_DIR "/bin/viwo-evaluate", arguments);
	}

	/** Expects a failure told in one line that holds `text`. */
	void expectFailure(const std::vector<std::string>& arguments, int status, const std::string& text)
	{
		const ProgramResult result = run(arguments);
		EXPECT_EQ(result.status, status) << result.err;
		EXPECT_EQ(result.errorLines(), 1u) << result.err;
		EXPECT_NE(result.err.find(text), std::string::npos) << result.err;
		EXPECT_EQ(result.out, "");
	}

	TempFolder folder_;
	Trajectory reference_;
};

TEST_F(EvaluateProgram, AlignsAndWritesJson)
{
	const ProgramResult result =
	    run({"-r", folder_.file("ref.tum"), "-e", folder_.file("moved.tum"), "--json", folder_.file("e.json"), "--max-ate", "1e-6"});
	EXPECT_EQ(result.status, 0) << result.err;
	EXPECT_EQ(result.err, "");
	const Json json = loadJson(folder_.file("e.json"));
	EXPECT_LT(json["ate_xyz_m"].get<double>(), 1e-7);
	EXPECT_LT(json["yaw_rmse_deg"].get<double>(), 1e-5);
	EXPECT_EQ(json["matched"], reference_.size());
	EXPECT_NEAR(json["coverage"].get<double>(), 1, 1e-9);
	EXPECT_NEAR(json["length_m"].get<double>(), reference_.length_m(), 1e-4);
}

TEST_F(EvaluateProgram, SeveralEstimates)
{
	const ProgramResult result = run({"-r", folder_.file("ref.tum"), "-e", folder_.file("moved.tum"), "-e", folder_.file("scaled.tum"),
	                                  "--align", "none", "--json", folder_.file("e.json")});
	EXPECT_EQ(result.status, 0) << result.err;
	EXPECT_NE(result.out.find("moved.tum"), std::string::npos);
	EXPECT_NE(result.out.find("scaled.tum"), std::string::npos);
	const Json json = loadJson(folder_.file("e.json"));
	ASSERT_EQ(json["estimates"].size(), 2u);
	EXPECT_GT(json["estimates"][0]["ate_xyz_m"].get<double>(), 3);
	EXPECT_NEAR(json["estimates"][1]["rpe_trans_percent"].get<double>(), 10, 1.5) << "chord against arc";
}

TEST_F(EvaluateProgram, DrawsTheAlignedPaths)
{
	const ProgramResult result = run({"-r", folder_.file("ref.tum"), "-e", folder_.file("moved.tum"), "-e", folder_.file("scaled.tum"),
	                                  "--svg", folder_.file("paths.svg")});
	EXPECT_EQ(result.status, 0) << result.err;
	const std::string svg = readFile(folder_.file("paths.svg"));
	EXPECT_EQ(svg.compare(0, 4, "<svg"), 0);
	EXPECT_NE(svg.find("moved (ATE 0.000 m)"), std::string::npos) << svg.substr(0, 400);
	const ProgramResult failed =
	    run({"-r", folder_.file("ref.tum"), "-e", folder_.file("moved.tum"), "--svg", folder_.file("ref.tum") + "/paths.svg"});
	EXPECT_EQ(failed.status, 1);
	EXPECT_EQ(failed.errorLines(), 1u) << failed.err;
	EXPECT_NE(failed.err.find("paths.svg"), std::string::npos) << failed.err;
}

TEST_F(EvaluateProgram, WritesAPage)
{
	const ProgramResult result = run({"-r", folder_.file("ref.tum"), "-e", folder_.file("moved.tum"), "-e", folder_.file("none.tum"),
	                                  "--allow-missing", "--html", folder_.file("report.html")});
	EXPECT_EQ(result.status, 0) << result.err;
	const std::string html = readFile(folder_.file("report.html"));
	size_t pictures = 0;
	for (size_t at = html.find("<svg"); at != std::string::npos; at = html.find("<svg", at + 1)) ++pictures;
	EXPECT_EQ(pictures, 3u) << "paths, error over time, drift over distance";
	for (const char* part : {"moved.tum", "none.tum", ">x-y-z<", "Drift", "</html>"}) EXPECT_NE(html.find(part), std::string::npos) << part;
	EXPECT_EQ(run({"-r", folder_.file("ref.tum"), "-e", folder_.file("moved.tum"), "--html", folder_.file("ref.tum") + "/x.html"}).status,
	          1);
}

/** Over a tenth of the way, an error is small. */
TEST_F(EvaluateProgram, APieceOfTheWayIsNotTheBestInThePage)
{
	std::istringstream lines(readFile(folder_.file("ref.tum")));
	std::string piece, line;
	for (int i = 0; i < 20 && std::getline(lines, line); ++i) piece += line + "\n";
	writeFile(folder_.file("piece.tum"), piece);
	run({"-r", folder_.file("ref.tum"), "-e", folder_.file("piece.tum"), "-e", folder_.file("scaled.tum"), "--html",
	     folder_.file("x.html")});
	const std::string html = readFile(folder_.file("x.html"));
	const size_t bold = html.find("<b>");
	ASSERT_NE(bold, std::string::npos);
	EXPECT_GT(bold, html.find("scaled.tum</td>"));
	EXPECT_EQ(html.find("<b>", bold + 1), std::string::npos);
}

TEST_F(EvaluateProgram, MissingEstimateIsARowWithoutFigures)
{
	const std::vector<std::string> arguments{"-r", folder_.file("ref.tum"),  "-e",     folder_.file("moved.tum"),
	                                         "-e", folder_.file("none.tum"), "--json", folder_.file("e.json")};
	EXPECT_EQ(run(arguments).status, 1) << "without the flag it is an error";
	std::vector<std::string> allowed = arguments;
	allowed.push_back("--allow-missing");
	const ProgramResult result = run(allowed);
	EXPECT_EQ(result.status, 0) << result.err;
	EXPECT_NE(result.out.find("none.tum"), std::string::npos);
	const Json json = loadJson(folder_.file("e.json"));
	EXPECT_LT(json["estimates"][0]["ate_xyz_m"].get<double>(), 1e-7);
	EXPECT_TRUE(json["estimates"][1]["ate_xyz_m"].is_null());
	EXPECT_EQ(json["estimates"][1]["matched"], 0);
	allowed.insert(allowed.end(), {"--max-ate", "10"});
	EXPECT_EQ(run(allowed).status, 1) << "what is not there keeps no limit";
}

TEST_F(EvaluateProgram, Sim3TakesOutScale)
{
	run({"-r", folder_.file("ref.tum"), "-e", folder_.file("scaled.tum"), "--align", "sim3", "--json", folder_.file("e.json")});
	EXPECT_NEAR(loadJson(folder_.file("e.json"))["scale"].get<double>(), 1 / 1.1, 1e-6);
}

TEST_F(EvaluateProgram, ExitStatusTellsOfLimits)
{
	const ProgramResult over = run({"-r", folder_.file("ref.tum"), "-e", folder_.file("scaled.tum"), "--max-ate", "0.01"});
	EXPECT_EQ(over.status, 1);
	EXPECT_EQ(over.errorLines(), 1u) << over.err;
	EXPECT_NE(over.err.find("over the limit of 0.01 m"), std::string::npos);
	EXPECT_NE(over.out.find("scaled.tum"), std::string::npos) << "the table is printed all the same";

	windingDrive(10, 10).saveTum(folder_.file("short.tum"));
	EXPECT_EQ(run({"-r", folder_.file("ref.tum"), "-e", folder_.file("short.tum")}).status, 0);
	EXPECT_EQ(run({"-r", folder_.file("ref.tum"), "-e", folder_.file("short.tum"), "--min-coverage", "0.97"}).status, 1);
}

TEST_F(EvaluateProgram, BadInputsAreOneLine)
{
	const std::string ref = folder_.file("ref.tum"), est = folder_.file("moved.tum");
	expectFailure({"-r", folder_.file("absent.tum"), "-e", est}, 1, "absent.tum");
	expectFailure({"-r", ref, "-e", write(folder_, "broken.tum", "1 2 3\n")}, 1, "broken.tum:1");
	expectFailure({"-r", ref, "-e", write(folder_, "double.tum", "1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n")}, 1, "double.tum:2");
	expectFailure({"-r", ref, "-e", write(folder_, "other.tum", "1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n")}, 1, "no overlap in time");
	expectFailure({"-r", ref, "-e", write(folder_, "single.tum", "1700000001 0 0 0 0 0 0 1\n")}, 1, "fewer than two poses");
	expectFailure({"-r", ref, "-e", est, "--nees"}, 1, "trajectory_covariance.csv");
}

TEST_F(EvaluateProgram, BadUsageIsStatusTwo)
{
	const std::string ref = folder_.file("ref.tum"), est = folder_.file("moved.tum");
	expectFailure({"-e", est}, 2, "--reference");
	expectFailure({"-r", ref, "-e", est, "--align", "so3"}, 2, "so3");
	expectFailure({"-r", ref, "-e", est, "--max-gap", "-1"}, 2, "--max-gap");
	expectFailure({"-r", ref, "-e", est, "--no-such-option"}, 2, "--no-such-option");
	expectFailure({"-r", ref, "-e", est, "--covariance", "a.csv", "--covariance", "b.csv"}, 2, "2 covariance files for 1 estimates");
}

TEST_F(EvaluateProgram, HelpAndVersion)
{
	const ProgramResult help = run({"--help"});
	EXPECT_EQ(help.status, 0);
	EXPECT_NE(help.out.find("Examples:"), std::string::npos);
	EXPECT_NE(help.out.find("--quiet"), std::string::npos);
	const ProgramResult version = run({"--version"});
	EXPECT_EQ(version.status, 0);
	EXPECT_EQ(version.out.rfind("viwo-evaluate (viwo) ", 0), 0u) << version.out;
}

TEST_F(EvaluateProgram, NeesOfAnHonestFile)
{
	std::string csv = "# frame: O relative to the first pose\nt_s";
	for (int i = 0; i < 21; ++i) csv += ",c" + std::to_string(i);
	csv += ",flag\n";
	std::mt19937_64 random(5);
	Trajectory noisy;
	for (const StampedPose& pose : reference_.poses())
	{
		Pose3 T = pose.T;
		if (!noisy.empty()) T.p += randomVector(random, 0.02);
		noisy.push_back({pose.t_ns, T});
		char stamp[40];
		std::snprintf(stamp, sizeof stamp, "%lld.%09lld", static_cast<long long>(pose.t_ns / 1000000000),
		              static_cast<long long>(pose.t_ns % 1000000000));
		csv += stamp;
		for (int r = 0; r < 6; ++r)
			for (int c = r; c < 6; ++c) csv += r == c ? ",4e-4" : ",0";
		csv += ",tracking\n";
	}
	noisy.saveTum(folder_.file("trajectory.tum"));
	write(folder_, "trajectory_covariance.csv", csv);
	const ProgramResult result =
	    run({"-r", folder_.file("ref.tum"), "-e", folder_.file("trajectory.tum"), "--nees", "--json", folder_.file("e.json")});
	EXPECT_EQ(result.status, 0) << result.err;
	EXPECT_NEAR(loadJson(folder_.file("e.json"))["anees_position"].get<double>(), 1, 0.1);
	EXPECT_NE(result.out.find("ANEES"), std::string::npos);
}
