#include <gtest/gtest.h>
#include <viwo/experiments/Starts.h>

#include <cmath>

namespace viwo::experiments
{
namespace
{
Start start(double start_s, double vins_rmse_m, double own_rmse_m, bool driving = true)
{
	Start s{"seq05", 1, start_s, driving, false, {}, {}};
	s.vins.aligned_s = 5;
	s.vins.rmse_m = vins_rmse_m;
	s.ours.aligned_s = driving ? 1 : 9;
	s.ours.first_pose_s = 0.5;
	s.ours.rmse_m = own_rmse_m;
	return s;
}

TEST(StartTables, AMethodThatFailsSomewhereIsNotTheBetterOne)
{
	const std::string markdown = table3({start(30, 0.001, 0.01), start(60, std::nan(""), 0.02)}).toMarkdown();
	EXPECT_NE(markdown.find("**0.015**"), std::string::npos) << markdown;
	EXPECT_EQ(markdown.find("**0.001**"), std::string::npos) << markdown;
}

TEST(StartTables, TheSmallerAverageIsBoldWhereBothStart)
{
	const std::string markdown = table3({start(30, 0.001, 0.01), start(60, 0.003, 0.02)}).toMarkdown();
	EXPECT_NE(markdown.find("**0.002**"), std::string::npos) << markdown;
	EXPECT_EQ(markdown.find("**0.015**"), std::string::npos) << markdown;
}

TEST(StartTables, WhatPrintsTheSameIsNoBetter)
{
	const std::string markdown = table3({start(30, 0.0101, 0.0102)}).toMarkdown();
	const size_t first = markdown.find("**0.010**");
	EXPECT_NE(markdown.find("**0.010**", first + 1), std::string::npos) << markdown;
}

TEST(StartTables, AnOpenStartLeavesItsAverageOpen)
{
	std::vector<Start> starts{start(30, 0.1, 0.1), start(60, 0.1, 0.1)};
	starts[1].open = true;
	const std::string csv = table3(starts).toCsv();
	EXPECT_NE(csv.find("seq05,VINS-Mono's method,0.100,...,,,,,,...\n"), std::string::npos) << csv;
	EXPECT_EQ(startRuns(starts).toCsv().find(",60,"), std::string::npos);
	EXPECT_FALSE(startsJson(starts).at("starts").at(1).contains("ours"));
}

TEST(StartTables, AStartThatDoesNotDriveCountsForTheFirstPoseOnly)
{
	const std::vector<Start> starts{start(30, 0.1, 0.1), start(60, 0.1, 0.1, false)};
	const std::string markdown = table2(starts).toMarkdown();
	EXPECT_NE(markdown.find("(9.00)"), std::string::npos) << markdown;
	ASSERT_EQ(startAverages(starts).size(), 1u);
	EXPECT_DOUBLE_EQ(startAverages(starts)[0].aligned_s, 1);
	EXPECT_DOUBLE_EQ(startAverages(starts)[0].first_pose_s, 0.5);
}
}  // namespace
}  // namespace viwo::experiments
