#include <gtest/gtest.h>
#include <viwo/core/Error.h>
#include <viwo/evaluation/Json.h>
#include <viwo/experiments/ErrorBudget.h>
#include <viwo/experiments/Experiments.h>
#include <viwo/sim/Rig.h>

#include "FakePrograms.h"

namespace viwo::experiments
{
namespace
{
class Experiments : public ::testing::Test
{
   protected:
	ExperimentResult run(const JobHooks& hooks = {}) { return runExperiments(request_, {out_.path(), "", programs_.folder()}, 2, hooks); }

	Experiments()
	{
		request_.sequences = {"seq05", "seq06"};
		request_.seeds = {1, 2};
	}

	viwo::testing::FakePrograms programs_;
	viwo::testing::TempFolder out_;
	Request request_;
};

TEST_F(Experiments, EveryRunIsDoneOnceAndKept)
{
	EXPECT_TRUE(run().problems.empty());
	EXPECT_EQ(programs_.count("sim --"), 4) << "two sequences, two seeds";
	EXPECT_EQ(programs_.count("odometry"), 4 * 3 + 2 * (6 + 5) * 2) << "three modes of each drive, two methods of each start";
	EXPECT_EQ(programs_.count("--mode wheel"), 4);
	EXPECT_EQ(programs_.count("--from 60.000000 --to 105.000000"), 8);
	const int before = programs_.count("");
	EXPECT_TRUE(run().problems.empty());
	EXPECT_EQ(programs_.count(""), before) << "nothing is done again";
	request_.seeds.push_back(3);
	request_.tables = {1};
	run();
	EXPECT_EQ(programs_.count(""), before + 2 * (1 + 3)) << "only what is new";
}

TEST_F(Experiments, AnInterruptionLeavesTablesOfWhatIsMeasured)
{
	int ended = 0;
	JobHooks hooks;
	hooks.ended = [&](const JobReport&) { ++ended; };
	// The drives of seq05 come first: two logs, three modes of each.
	hooks.interrupted = [&] { return ended >= 10; };
	const ExperimentResult result = run(hooks);
	EXPECT_TRUE(result.problems.empty()) << result.problems.front();
	EXPECT_NE(result.interruption.find(" of 60 programs have not run"), std::string::npos) << result.interruption;
	const std::string table1 = viwo::testing::readFile(out_.file("table1.md"));
	const size_t second = table1.find("seq06");
	EXPECT_LT(second, table1.find("...")) << "what is complete has figures\n" << table1;
	EXPECT_LT(table1.find("..."), table1.find("The same command goes on")) << table1;
	EXPECT_EQ(table1.find("fails"), std::string::npos) << table1;
	const Json json = loadJson(out_.file("table1.json"));
	EXPECT_FALSE(json.at("complete").get<bool>());
	EXPECT_TRUE(json.at("results").at(0).at("median").at("ate_xyz_m").is_number());
	EXPECT_TRUE(json.at("results").back().at("median").at("ate_xyz_m").is_null());
	EXPECT_EQ(viwo::testing::readFile(out_.file("table3.md")).find("**"), std::string::npos) << "no method is better yet";
	EXPECT_NE(viwo::testing::readFile(out_.file("report.html")).find("The same command goes on"), std::string::npos);
}

TEST_F(Experiments, GoOnAfterAnInterruption)
{
	request_.tables = {1};
	request_.error_budget = {"seq05"};
	programs_.addGroundTruth();
	int ended = 0;
	JobHooks hooks;
	hooks.ended = [&](const JobReport&) { ++ended; };
	hooks.interrupted = [&] { return ended >= 5; };
	EXPECT_FALSE(run(hooks).interruption.empty());
	EXPECT_TRUE(run().problems.empty());
	EXPECT_LE(programs_.count("odometry"), 12 + 2 * 25 + 2) << "at most what was running is done again";
	EXPECT_TRUE(loadJson(out_.file("table1.json")).at("complete").get<bool>());
	for (const char* table : {"table1.md", "table1_lidar.md", "error_budget.md"})
		EXPECT_EQ(viwo::testing::readFile(out_.file(table)).find("..."), std::string::npos) << table;
}

/** What is there is seen even where it stands behind what is not. */
TEST_F(Experiments, AnInterruptionForgetsNothing)
{
	request_.tables = {1};
	request_.seeds = {2};
	run();
	request_.seeds = {1, 2};
	JobHooks hooks;
	hooks.interrupted = [] { return true; };
	const ExperimentResult result = run(hooks);
	EXPECT_NE(result.interruption.find("8 of 16 programs"), std::string::npos) << result.interruption;
	const Json table = loadJson(out_.file("table1.json"));
	for (const Json& row : table.at("results"))
	{
		EXPECT_EQ(row.at("seeds").at(0).at("problem"), "not measured yet");
		EXPECT_EQ(row.at("seeds").at(1).at("problem"), "");
	}
}

TEST_F(Experiments, TwoAtATimeInOneFolderAreRefused)
{
	request_.tables = {1};
	JobHooks hooks;
	std::string refusal;
	hooks.ended = [&](const JobReport&)
	{
		if (!refusal.empty()) return;
		try
		{
			run();
			refusal = "none";
		}
		catch (const Error& e)
		{
			refusal = e.what();
		}
	};
	EXPECT_TRUE(run(hooks).problems.empty());
	EXPECT_NE(refusal.find("another viwo-experiments is at work"), std::string::npos) << refusal;
}

TEST_F(Experiments, TwoAtATimeMayShareACache)
{
	request_.tables = {1};
	const viwo::testing::TempFolder other, cache;
	JobHooks hooks;
	bool begun = false;
	hooks.running = [&](const JobReport&)
	{
		if (begun) return;
		begun = true;
		EXPECT_TRUE(runExperiments(request_, {other.path(), cache.path(), programs_.folder()}, 2, {}).problems.empty());
	};
	EXPECT_TRUE(runExperiments(request_, {out_.path(), cache.path(), programs_.folder()}, 2, hooks).problems.empty());
	for (const auto& entry : std::filesystem::directory_iterator(cache.path()))
		EXPECT_EQ(entry.path().string().find(".part"), std::string::npos) << entry.path();
}

/** Files that somebody has removed or a full disk has cut are made again, or told as a problem; the rest of the tables stands. */
TEST_F(Experiments, DamagedFilesDoNotStopTheRest)
{
	request_.sequences = {"seq05"};
	run();
	const std::string runs = out_.file("runs/");
	std::filesystem::remove(runs + "seq05-s1-viwo/trajectory.tum");
	viwo::testing::writeFile(runs + "seq05-s2-viwo/trajectory.tum", "1 2 3\n");
	viwo::testing::writeFile(runs + "seq05-s1-viwo-start30/summary.json", "{");
	const int before = programs_.count("odometry");
	const ExperimentResult result = run();
	EXPECT_EQ(programs_.count("odometry"), before + 1) << "the one without a trajectory";
	ASSERT_EQ(result.problems.size(), 2u) << result.problems.front();
	EXPECT_NE(result.problems[0].find("seq05, seed 2, viwo: "), std::string::npos) << result.problems[0];
	EXPECT_NE(result.problems[1].find("seq05, seed 1, start at 30 s: "), std::string::npos) << result.problems[1];
	EXPECT_NE(viwo::testing::readFile(out_.file("table1.md")).find("fails"), std::string::npos);
}

TEST_F(Experiments, LogsThatWereCutAreMadeAgain)
{
	request_.tables = {1};
	request_.sequences = {"seq05"};
	request_.seeds = {1};
	run();
	EXPECT_EQ(programs_.count("sim --"), 1);
	for (const auto& folder : std::filesystem::directory_iterator(out_.file("cache"))) std::ofstream(folder.path() / "log.rawlog") << "l";
	EXPECT_TRUE(run().problems.empty());
	EXPECT_EQ(programs_.count("sim --"), 2);
	run();
	EXPECT_EQ(programs_.count("sim --"), 2);
}

/** Without logs nothing can be measured, and all that was asked for is still written. */
TEST_F(Experiments, LogsThatCannotBeMadeAreProblems)
{
	programs_.addGroundTruth();
	request_.error_budget = {"seq06"};
	programs_.failToSimulate();
	const ExperimentResult result = run();
	ASSERT_FALSE(result.problems.empty());
	EXPECT_NE(result.problems.back().find("no space"), std::string::npos) << result.problems.back();
	for (const char* table : {"table1.md", "table2.md", "table3.md", "error_budget.md"})
		EXPECT_TRUE(std::filesystem::exists(out_.file(table))) << table;
}

TEST_F(Experiments, RunsThatFailAreRowsWithoutFiguresAndTriedAgain)
{
	request_.tables = {1};
	programs_.fail(true);
	const ExperimentResult failed = run();
	EXPECT_EQ(failed.problems.size(), 12u);
	EXPECT_NE(failed.problems.front().find("told to fail"), std::string::npos) << failed.problems.front();
	EXPECT_NE(viwo::testing::readFile(out_.file("table1.md")).find("fails"), std::string::npos);
	programs_.fail(false);
	EXPECT_TRUE(run().problems.empty());
	EXPECT_EQ(viwo::testing::readFile(out_.file("table1.md")).find("fails"), std::string::npos);
}

/** That the estimator does not start is a result, and no failure of the experiment. */
TEST_F(Experiments, RunsWithoutAPoseAreDashesAndKept)
{
	programs_.neverStart("vio");
	request_.tables = {1};
	EXPECT_TRUE(run().problems.empty());
	const Json table1 = loadJson(out_.file("table1.json"));
	for (const Json& row : table1.at("results"))
		for (const Json& seed : row.at("seeds"))
			EXPECT_EQ(seed.at("problem"), row.at("run") == "vio" ? "no pose: the estimator is still initialising after 751 frames" : "");
	const int before = programs_.count("");
	EXPECT_TRUE(run().problems.empty());
	EXPECT_EQ(programs_.count(""), before) << "nothing is done again";
}

TEST_F(Experiments, TablesAreWrittenInAllTheirForms)
{
	request_.ablations = true;
	const ExperimentResult result = run();
	for (const char* table : {"table1", "table2", "table3", "ablations"})
		for (const char* form : {".json", ".md", ".csv"})
			EXPECT_TRUE(std::filesystem::exists(out_.file(std::string(table) + form))) << table << form;
	const Json table1 = loadJson(out_.file("table1.json"));
	EXPECT_EQ(table1.at("seeds").size(), 2u);
	EXPECT_NE(table1.at("configuration").get<std::string>().find("wheel_factor"), std::string::npos);
	double first_m = 0;
	for (const Json& row : table1.at("results"))
	{
		const bool published = row.at("run") == "viwo" && row.at("sequence") == "seq05";
		EXPECT_DOUBLE_EQ(published ? row.at("paper").at("ate_xyz_m").get<double>() : 0.03, 0.03);
		const double ate_m = row.at("median").at("ate_xyz_m").get<double>();
		if (first_m == 0) first_m = ate_m;
		EXPECT_EQ(ate_m, first_m) << "all estimates are alike here";
		EXPECT_EQ(row.at("seeds").size(), 2u);
	}
	EXPECT_GT(first_m, 0.01);
	EXPECT_LT(first_m, 0.02 * 30);
	const Json table2 = loadJson(out_.file("table2.json"));
	for (const Json& average : table2.at("results").at("averages"))
	{
		EXPECT_DOUBLE_EQ(average.at("aligned_s").get<double>(), 2.0);
		EXPECT_DOUBLE_EQ(average.at("first_pose_s").get<double>(), 0.5);
	}
}

/** The paper's way of judging, where the ground-truth program is there; without it, the exact truth alone. */
TEST_F(Experiments, GroundTruthFromLidarStandsBesideTheExactOne)
{
	request_.tables = {1};
	EXPECT_TRUE(run().problems.empty());
	EXPECT_FALSE(std::filesystem::exists(out_.file("table1_lidar.json")));
	EXPECT_NE(viwo::testing::readFile(out_.file("report.html")).find("viwo-groundtruth was not there"), std::string::npos);
	programs_.addGroundTruth();
	EXPECT_TRUE(run().problems.empty());
	EXPECT_EQ(programs_.count("groundtruth"), 4) << "two sequences, two seeds";
	const Json lidar = loadJson(out_.file("table1_lidar.json"));
	ASSERT_EQ(lidar.at("results").size(), 4u);
	for (const Json& row : lidar.at("results"))
	{
		EXPECT_NEAR(row.at("ground_truth").at("ate_xy_m").get<double>(), 0, 1e-6);
		EXPECT_GT(row.at("ate_xy_m").at("viwo").get<double>(), 0.01);
	}
	const std::string html = viwo::testing::readFile(out_.file("report.html"));
	EXPECT_NE(html.find("Figure 5"), std::string::npos);
	EXPECT_NE(html.find("src=\"data:image/png;base64,TSE=\""), std::string::npos) << "the map stands in the page";
}

TEST_F(Experiments, ErrorBudgetSwitchesEachSourceOffAndOn)
{
	request_.tables = {};
	request_.seeds = {1};
	request_.error_budget = {"seq05"};
	EXPECT_TRUE(run().problems.empty());
	const Json budget = loadJson(out_.file("error_budget.json")).at("results").at(0);
	const size_t sources = budget.at("sources").size();
	EXPECT_GE(sources, 10u);
	EXPECT_EQ(programs_.count("odometry"), 2 + 2 * static_cast<int>(sources)) << "all, none, and each source alone and left out";
	for (const Json& source : budget.at("sources")) EXPECT_GT(source.at("alone_ate_xyz_m").get<double>(), 0);
	EXPECT_EQ(programs_.count("sim --"), 2 + 2 * static_cast<int>(sources));
	EXPECT_GE(programs_.count("--images-from"), 16) << "what the camera does not notice is not rendered again";
	EXPECT_NE(viwo::testing::readFile(out_.file("report.html")).find("Error budget"), std::string::npos);
}

/** The words that switch the sources off are options of the rig, and leave nothing on. */
TEST(ErrorBudget, SourcesAreOptionsOfTheRig)
{
	std::vector<std::string> words;
	for (const ErrorSource& source : errorSources()) words.insert(words.end(), source.off.begin(), source.off.end());
	const SimulatedDrive drive = sequenceDrive("seq01");
	sim::Rig rig;
	sim::Route route;
	sim::loadRun(drive.rigPath(), drive.routePath(), words, rig, route);
	EXPECT_EQ(rig.imu.gyro_noise_rad_s_sqrtHz, 0);
	EXPECT_EQ(rig.wheels.track_error, 0);
	EXPECT_FALSE(rig.wheels.tick_quantisation);
	EXPECT_TRUE(rig.wheels.slips.empty());
	EXPECT_EQ(rig.floor.height_rms_mm, 0);
	EXPECT_EQ(rig.camera.pose_error, std::vector<double>(6, 0));
}

/** One page: nothing from elsewhere, no script, and all tags closed. */
TEST_F(Experiments, ReportStandsAlone)
{
	run();
	const std::string html = viwo::testing::readFile(out_.file("report.html"));
	for (const char* word : {"<script", "http:", "https:", "url(", "@import", "nan", "inf\""})
	{
		std::string rest = html;
		for (const std::string xmlns = "http://www.w3.org/2000/svg"; rest.find(xmlns) != std::string::npos;)
			rest.erase(rest.find(xmlns), xmlns.size());
		EXPECT_EQ(rest.find(word), std::string::npos)
		    << word << " in ..." << rest.substr(rest.find(word) < 80 ? 0 : rest.find(word) - 80, 160);
	}
	for (const char* tag : {"svg", "table", "figure", "div", "p", "h2", "h3", "tr", "td", "g", "details"})
	{
		const auto count = [&](const std::string& part)
		{
			size_t n = 0;
			for (size_t at = html.find(part); at != std::string::npos; at = html.find(part, at + 1)) ++n;
			return n;
		};
		const std::string name = tag;
		EXPECT_EQ(count("<" + name + ">") + count("<" + name + " "), count("</" + name + ">")) << tag;
	}
	for (const char* words : {"Table 1", "Table 2", "Table 3", "Figure 6", "Figure 7", "VINS-Mono", "prefers-color-scheme: dark"})
		EXPECT_NE(html.find(words), std::string::npos) << words;
}

TEST_F(Experiments, OtherBuildsAreMeasuredAnew)
{
	request_.sequences = {"seq05"};
	request_.seeds = {1};
	request_.tables = {1};
	run();
	EXPECT_EQ(programs_.count("odometry"), 3);
	std::ofstream(programs_.folder() + "/viwo-odometry", std::ios::app) << "# another build\n";
	run();
	EXPECT_EQ(programs_.count("odometry"), 6);
	EXPECT_EQ(programs_.count("sim --"), 1) << "the log does not depend on the estimator";
}
}  // namespace
}  // namespace viwo::experiments
