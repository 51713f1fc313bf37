#include "RandomTrajectory.h"
#include "RunProgram.h"

#include <viwo/core/Error.h>
#include <viwo/evaluation/Consistency.h>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include <iostream>
#include <limits>

using namespace viwo;
using namespace viwo::testing;

namespace
{
struct Drawn
{
	Trajectory reference, estimate;
	std::vector<StampedCovariance> covariances;
};

/** Errors of x y z yaw drawn from a covariance with correlations; the file claims `claimed` times it. */
Drawn draw(size_t count, double claimed)
{
	Eigen::Matrix4d root;
	root << 0.03, 0, 0, 0, 0.01, 0.02, 0, 0, -0.005, 0.002, 0.01, 0, 0.004, -0.003, 0.001, 0.005;
	const Eigen::Matrix4d P = claimed * root * root.transpose();
	std::mt19937_64 random(11);
	std::normal_distribution<double> normal;
	Drawn drawn;
	drawn.reference = windingDrive(10, 0.1 * static_cast<double>(count));
	const int rows[] = {0, 1, 2, 5};
	for (const StampedPose& pose : drawn.reference.poses())
	{
		Eigen::Vector4d u = Eigen::Vector4d::Zero();
		if (!drawn.estimate.empty())
			for (int i = 0; i < 4; ++i) u[i] = normal(random);
		const Eigen::Vector4d e = root * u;
		const Pose3 first = drawn.reference.poses()[0].T;
		const Eigen::AngleAxisd level(yawOf(first.R), Eigen::Vector3d::UnitZ());
		Pose3 T = pose.T;
		T.p += level * Eigen::Vector3d(e.head<3>());
		T.R = Eigen::AngleAxisd(e[3], Eigen::Vector3d::UnitZ()) * T.R;
		drawn.estimate.push_back({pose.t_ns, T});
		StampedCovariance entry;
		entry.t_ns = pose.t_ns;
		entry.covariance.setIdentity();
		for (int i = 0; i < 4; ++i)
			for (int j = 0; j < 4; ++j) entry.covariance(rows[i], rows[j]) = P(i, j);
		drawn.covariances.push_back(entry);
	}
	return drawn;
}

std::string csv(const std::string& body)
{
	std::string header = "t_s";
	for (int i = 0; i < 21; ++i) header += ",c" + std::to_string(i);
	return "# frame: O relative to the first pose\n" + header + ",flag\n" + body;
}

std::string row(const std::string& t, const std::string& cell)
{
	std::string text = t;
	for (int i = 0; i < 21; ++i) text += "," + cell;
	return text + ",tracking\n";
}

std::string errorOf(const std::string& path)
{
	try
	{
		loadCovariances(path);
	}
	catch (const Error& e)
	{
		return e.what();
	}
	return "";
}
}  // namespace

TEST(Consistency, HonestCovarianceGivesOne)
{
	const Drawn d = draw(4000, 1);
	const Consistency c = consistency(d.reference, d.estimate, d.covariances, 0.5);
	std::cout << "[measured] ANEES position " << c.position.average() << ", yaw " << c.yaw.average() << ", pose " << c.pose.average()
	          << "\n";
	EXPECT_NEAR(c.position.average(), 1, 0.06);
	EXPECT_NEAR(c.yaw.average(), 1, 0.09);
	EXPECT_NEAR(c.pose.average(), 1, 0.06);
	EXPECT_EQ(c.pose.poses, 4000u);
	EXPECT_EQ(c.pose.degrees_of_freedom, 16000u);
	EXPECT_EQ(c.invalid, 0u);
	EXPECT_EQ(c.without_covariance, 0u);
}

TEST(Consistency, ScalesWithTheClaim)
{
	const Drawn honest = draw(500, 1), optimistic = draw(500, 0.25);
	const double one = consistency(honest.reference, honest.estimate, honest.covariances, 0.5).pose.average();
	const double four = consistency(optimistic.reference, optimistic.estimate, optimistic.covariances, 0.5).pose.average();
	EXPECT_NEAR(four, 4 * one, 1e-9);
}

TEST(Consistency, IgnoresWhereTheFirstPosesAre)
{
	Drawn d = draw(300, 1);
	const double before = consistency(d.reference, d.estimate, d.covariances, 0.5).pose.average();
	const Pose3 T(Eigen::Quaterniond(Eigen::AngleAxisd(2, Eigen::Vector3d::UnitZ())), Eigen::Vector3d(5, 6, 7));
	d.estimate = transformed(d.estimate, [&](const Pose3& pose) { return T * pose; });
	EXPECT_NEAR(consistency(d.reference, d.estimate, d.covariances, 0.5).pose.average(), before, 1e-6);
}

TEST(Consistency, PlanarSourceHasThreeDegreesOfFreedom)
{
	Drawn d = draw(300, 1);
	const double nan = std::numeric_limits<double>::quiet_NaN();
	for (auto& entry : d.covariances)
		for (const int i : {2, 3, 4}) entry.covariance.row(i).setConstant(nan), entry.covariance.col(i).setConstant(nan);
	const Consistency c = consistency(d.reference, d.estimate, d.covariances, 0.5);
	EXPECT_EQ(c.pose.degrees_of_freedom, 900u);
	EXPECT_EQ(c.position.degrees_of_freedom, 600u);
	EXPECT_NEAR(c.pose.average(), 1, 0.25);
}

TEST(Consistency, CountsWhatItCannotUse)
{
	Drawn d = draw(100, 1);
	d.covariances[10].covariance.setZero();
	d.covariances.erase(d.covariances.begin() + 50, d.covariances.begin() + 60);
	const Consistency c = consistency(d.reference, d.estimate, d.covariances, 0.5);
	EXPECT_EQ(c.invalid, 1u);
	EXPECT_EQ(c.without_covariance, 10u);
	EXPECT_EQ(c.pose.poses, 89u);
}

TEST(CovarianceFile, ReadsTheUpperTriangle)
{
	const TempFolder folder;
	std::string line = "1700000000.123456789";
	for (int i = 1; i <= 21; ++i) line += "," + (i == 21 ? std::string() : std::to_string(i));
	const auto entries = loadCovariances(write(folder, "c.csv", csv(line + ",tracking\n" + row("1700000001.0", "2"))));
	ASSERT_EQ(entries.size(), 2u);
	EXPECT_EQ(entries[0].t_ns, 1700000000123456789);
	EXPECT_EQ(entries[0].covariance(0, 0), 1);
	EXPECT_EQ(entries[0].covariance(0, 5), 6);
	EXPECT_EQ(entries[0].covariance(5, 0), 6);
	EXPECT_EQ(entries[0].covariance(1, 1), 7);
	EXPECT_EQ(entries[0].covariance(4, 5), 20);
	EXPECT_TRUE(std::isnan(entries[0].covariance(5, 5)));
	EXPECT_EQ(entries[0].flag, "tracking");
}

TEST(CovarianceFile, NamesFileAndLine)
{
	const TempFolder folder;
	EXPECT_NE(errorOf(folder.file("absent.csv")).find("absent.csv"), std::string::npos);
	EXPECT_NE(errorOf(write(folder, "a.csv", csv(""))).find("no covariance"), std::string::npos);
	EXPECT_NE(errorOf(write(folder, "b.csv", csv(row("1", "x")))).find("b.csv:3: 'x' is not a finite number"), std::string::npos);
	EXPECT_NE(errorOf(write(folder, "c.csv", csv(row("2", "1") + row("2", "1")))).find("c.csv:4: time stamps do not increase"),
	          std::string::npos);
	EXPECT_NE(errorOf(write(folder, "d.csv", row("1", "1"))).find("d.csv:1: the header line"), std::string::npos);
	EXPECT_NE(errorOf(write(folder, "e.csv", csv("1,2,3\n"))).find("e.csv:3: 3 columns"), std::string::npos);
}
