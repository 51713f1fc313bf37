#include <gtest/gtest.h>
#include <viwo/core/So3.h>
#include <viwo/core/TimeText.h>
#include <viwo/core/Trajectory.h>

#include "ExpectError.h"
#include "TempFolder.h"

using namespace viwo;
using viwo::testing::expectError;
using viwo::testing::readFile;
using viwo::testing::TempFolder;
using viwo::testing::writeFile;

namespace
{
constexpr int64_t kEpoch_ns = 1403715273262142976;

Trajectory arc()
{
	Trajectory trajectory;
	for (int i = 0; i < 20; i++)
		trajectory.push_back({kEpoch_ns + i * 50000001LL,
		                      Pose3(so3::expQuaternion({0.01 * i, -0.02 * i, 0.1 * i}), Eigen::Vector3d(0.1 * i, -i, 0.001 * i * i))});
	return trajectory;
}
}  // namespace

TEST(TimeText, ExactToTheNanosecond)
{
	EXPECT_EQ(parseSeconds("1403715273.262142976"), kEpoch_ns);
	EXPECT_EQ(parseSeconds("1.403715273262142976e+09"), kEpoch_ns);
	EXPECT_EQ(parseSeconds("1403715273262142976e-9"), kEpoch_ns);
	EXPECT_EQ(parseSeconds("0"), 0);
	EXPECT_EQ(parseSeconds("-1.5"), -1500000000);
	EXPECT_EQ(parseSeconds("+.25"), 250000000);
	EXPECT_EQ(parseSeconds("1.0000000004"), 1000000000);
	EXPECT_EQ(parseSeconds("1.0000000005"), 1000000001);
	EXPECT_EQ(parseSeconds("0.00000000000001"), 0);
	EXPECT_EQ(parseSeconds("1e-80"), 0);
	for (const char* bad :
	     {"", "-", ".", "abc", "1.2.3", "1,5", "nan", "inf", "1e", "1e2x", "1 ", "1e15", "99999999999", "9223372036.8547758075"})
		EXPECT_FALSE(parseSeconds(bad)) << bad;
	EXPECT_EQ(formatSeconds(kEpoch_ns), "1403715273.262142976");
	EXPECT_EQ(formatSeconds(-1), "-0.000000001");
	for (int64_t t : {int64_t{0}, int64_t{999999999}, kEpoch_ns, -kEpoch_ns, std::numeric_limits<int64_t>::max()})
		EXPECT_EQ(parseSeconds(formatSeconds(t)), t);
}

TEST(Trajectory, TumRoundTrip)
{
	TempFolder folder;
	const Trajectory a = arc();
	a.saveTum(folder.file("a.tum"));
	const Trajectory b = Trajectory::loadTum(folder.file("a.tum"));
	ASSERT_EQ(b.size(), a.size());
	for (size_t i = 0; i < a.size(); i++)
	{
		EXPECT_EQ(b.poses()[i].t_ns, a.poses()[i].t_ns);
		EXPECT_LT((b.poses()[i].T.p - a.poses()[i].T.p).norm(), 1e-8);
		EXPECT_LT(b.poses()[i].T.R.angularDistance(a.poses()[i].T.R), 1e-11);
	}
	b.saveTum(folder.file("b.tum"));
	EXPECT_EQ(readFile(folder.file("b.tum")), readFile(folder.file("a.tum")));
}

TEST(Trajectory, LoadSkipsCommentsAndNormalises)
{
	TempFolder folder;
	writeFile(folder.file("t.tum"), "# timestamp tx ty tz qx qy qz qw\r\n\n  # indented\n1.5 1 2 3 0 0 0 1.005\r\n2e0\t4 5 6 0 0 1 0\n");
	const Trajectory t = Trajectory::loadTum(folder.file("t.tum"));
	ASSERT_EQ(t.size(), 2u);
	EXPECT_EQ(t.poses()[0].t_ns, 1500000000);
	EXPECT_DOUBLE_EQ(t.poses()[0].T.R.norm(), 1);
	EXPECT_EQ(t.poses()[1].T.p, Eigen::Vector3d(4, 5, 6));
	EXPECT_NEAR(std::abs(yawOf(t.poses()[1].T.R)), M_PI, 1e-12);
}

TEST(Trajectory, BadTumNamesFileAndLine)
{
	TempFolder folder;
	const std::string path = folder.file("bad.tum");
	const std::string good = "1 0 0 0 0 0 0 1\n";
	const auto load = [&] { Trajectory::loadTum(path); };
	expectError(load, {path, "cannot read"});
	const auto expectBad = [&](const std::string& content, const std::string& where, const std::string& what)
	{
		writeFile(path, content);
		expectError(load, {path + where, what});
	};
	expectBad("", "", "empty");
	expectBad("# only\n", "", "no pose");
	expectBad(good + "2 0 0 0 0 0 0\n", ":2", "7 columns");
	expectBad(good + "2 0 0 0 0 0 0 1 9\n", ":2", "9 columns");
	expectBad(good + "2,0,0,0,0,0,0,1\n", ":2", "1 column;");
	expectBad(good + "# c\n2 0 x 0 0 0 0 1\n", ":3", "'x'");
	expectBad(good + "2 0 nan 0 0 0 0 1\n", ":2", "nan");
	expectBad(good + "2 0 0 0 0 0 0 inf\n", ":2", "inf");
	expectBad(good + "2 0 0 0 0 0 0 0\n", ":2", "quaternion");
	expectBad(good + "2 0 0 0 0 0 0 1.1\n", ":2", "quaternion");
	expectBad(good + "t 0 0 0 0 0 0 1\n", ":2", "time");
	expectBad(good + good, ":2", "not later");
	expectBad(good + "0.5 0 0 0 0 0 0 1\n", ":2", "not later");
	expectError([&] { Trajectory::loadTum(folder.path()); }, {folder.path()});
}

TEST(Trajectory, PushBackWantsIncreasingStamps)
{
	Trajectory t;
	t.push_back({10, {}});
	expectError([&] { t.push_back({10, {}}); }, {"not later"});
	expectError([&] { t.push_back({9, {}}); }, {"not later"});
	EXPECT_EQ(t.size(), 1u);
}

TEST(Trajectory, Interpolates)
{
	Trajectory t;
	t.push_back({0, Pose3(so3::expQuaternion({0, 0, 3.0}), Eigen::Vector3d(1, 0, 0))});
	t.push_back({1000000000, Pose3(so3::expQuaternion({0, 0, 3.4}), Eigen::Vector3d(2, 4, 0))});
	t.push_back({4000000000, Pose3()});
	const auto middle = t.at(250000000, 1.5);
	ASSERT_TRUE(middle);
	EXPECT_LT((middle->p - Eigen::Vector3d(1.25, 1, 0)).norm(), 1e-15);
	EXPECT_LT(middle->R.angularDistance(so3::expQuaternion({0, 0, 3.1})), 1e-14);
	EXPECT_TRUE(t.at(0, 1.5) && t.at(1000000000, 1.5) && t.at(4000000000, 1.5));
	EXPECT_FALSE(t.at(-1, 1.5) || t.at(4000000001, 1.5) || t.at(2000000000, 1.5));
	EXPECT_TRUE(t.at(2000000000, 3.5));
	EXPECT_FALSE(Trajectory().at(0, 1));
}

TEST(Trajectory, Length)
{
	Trajectory t;
	EXPECT_EQ(t.length_m(), 0);
	t.push_back({0, Pose3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0, 0, 0))});
	t.push_back({1, Pose3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(3, 4, 0))});
	t.push_back({2, Pose3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(3, 4, 2))});
	EXPECT_DOUBLE_EQ(t.length_m(), 7);
}

TEST(Trajectory, CoveredDurationLeavesHolesOut)
{
	EXPECT_EQ(coveredDuration_s({}, 0.5), 0);
	EXPECT_EQ(coveredDuration_s({7}, 0.5), 0);
	const int64_t tenth_ns = 100000000;
	std::vector<int64_t> stamps_ns;
	for (int i = 0; i <= 100; ++i)
		if (i <= 40 || i >= 60) stamps_ns.push_back(kEpoch_ns + i * tenth_ns);
	EXPECT_NEAR(coveredDuration_s(stamps_ns, 0.5), 8, 1e-9);
	EXPECT_NEAR(coveredDuration_s(stamps_ns, 2.5), 10, 1e-9);
	EXPECT_NEAR(coveredDuration_s({0, 10 * tenth_ns, 20 * tenth_ns}, 0.5), 2, 1e-9) << "a slow stream is no hole";
}
