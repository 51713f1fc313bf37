#include "RandomTrajectory.h"
#include "RunProgram.h"

#include <viwo/core/Error.h>
#include <viwo/evaluation/Report.h>
#include <viwo/evaluation/Table.h>

#include <gtest/gtest.h>

#include <limits>

using namespace viwo;
using namespace viwo::testing;

TEST(Table, AlignsTextAndMarkdown)
{
	Table table({{"mode", "", true}, {"ATE", "m"}});
	table.addRow({"wheel", "0.5"});
	table.addRow({"a|\xC3\xA9", "12.25"});
	EXPECT_EQ(table.toText(),
	          "mode     ATE\n"
	          "           m\n"
	          "------------\n"
	          "wheel    0.5\n"
	          "a|\xC3\xA9    12.25\n");
	EXPECT_EQ(table.toMarkdown(),
	          "| mode | ATE (m) |\n"
	          "|---|---:|\n"
	          "| wheel | 0.5 |\n"
	          "| a\\|\xC3\xA9 | 12.25 |\n");
	EXPECT_THROW(table.addRow({"too few"}), std::invalid_argument);
	EXPECT_EQ(fixed(1.005, 1), "1.0");
	EXPECT_EQ(fixed(std::numeric_limits<double>::quiet_NaN(), 1), "-");
}

TEST(Json, IsStable)
{
	const Json json = {{"b", 0.1 + 0.2}, {"a", {1.0 / 3, std::numeric_limits<double>::quiet_NaN(), 7}}};
	EXPECT_EQ(toText(json), "{\n  \"b\": 0.3,\n  \"a\": [\n    0.333333333,\n    null,\n    7\n  ]\n}\n");
	const TempFolder folder;
	saveJson(folder.file("x.json"), json);
	EXPECT_EQ(readFile(folder.file("x.json")), toText(json));
	EXPECT_EQ(toText(loadJson(folder.file("x.json"))), toText(json));
	write(folder, "bad.json", "{\"a\": ");
	EXPECT_THROW(loadJson(folder.file("bad.json")), Error);
	EXPECT_THROW(loadJson(folder.file("absent.json")), Error);
}

TEST(Report, SingleEstimateHasItsKeysAtTheTop)
{
	const Trajectory drive = windingDrive(10, 20);
	EstimateReport report{"est.tum", evaluate(drive, drive, {}), {}};
	const Json one = toJson("ref.tum", {}, {report});
	for (const char* key : {"ate_xy_m", "ate_z_m", "ate_xyz_m", "rpe_trans_percent", "yaw_rmse_deg", "length_m", "matched", "coverage",
	                        "rpe_interval_trans_m"})
	{
		ASSERT_TRUE(one.contains(key)) << key;
		EXPECT_EQ(one[key], one["estimates"][0][key]);
	}
	EXPECT_EQ(one["matched"], 201);
	const Json two = toJson("ref.tum", {}, {report, report});
	EXPECT_FALSE(two.contains("ate_xy_m"));
	EXPECT_EQ(two["estimates"].size(), 2u);
}

TEST(Report, TableHasOneLineAnEstimate)
{
	const Trajectory drive = windingDrive(10, 20);
	EstimateReport report{"est.tum", evaluate(drive, drive, {}), {}};
	const std::string text = toTable({report, report}, {});
	EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 5);
	EXPECT_EQ(text.find("ANEES"), std::string::npos);
	report.consistency = Consistency();
	EXPECT_NE(toTable({report}, {}).find("ANEES"), std::string::npos);
}
