#include "RunProgram.h"
#include "StandingLog.h"

#include <gtest/gtest.h>
#include <viwo/rawlog/RigFile.h>

#include <filesystem>

namespace viwo::testing
{
namespace
{
ProgramResult allan(std::vector<std::string> arguments)
{
	arguments.insert(arguments.begin(), "allan");
	return runProgram(VIWO_BINARY_DIR "/bin/viwo-calibrate", arguments);
}

TEST(AllanProgram, FromALogAtRestToARigAndPictures)
{
	const TempFolder folder;
	StandingImu imu;
	imu.acc.K = 1e-3;
	writeStandingLog(folder.file("x.rawlog"), imu.record());
	const std::vector<std::string> pictures{"--svg",  folder.file("a.svg"),  "--html", folder.file("a.html"),
	                                        "--json", folder.file("a.json"), "--csv",  folder.file("a.csv")};
	std::vector<std::string> arguments{"-i", folder.file("x.rawlog"), "-o", folder.file("imu.ini")};
	arguments.insert(arguments.end(), pictures.begin(), pictures.end());
	const ProgramResult result = allan(arguments);
	ASSERT_EQ(result.status, 0) << result.err;
	EXPECT_NE(result.out.find("gyro_walk_rad_s2_sqrtHz: not observed: log of 120 s, "), std::string::npos) << result.out;
	const RigFile rig = RigFile::load(folder.file("imu.ini"));
	ASSERT_TRUE(rig.imu);
	EXPECT_FALSE(rig.camera || rig.wheels);
	EXPECT_NEAR(rig.imu->acc_noise_m_s2_sqrtHz, 2e-3, 1e-4);
	EXPECT_NEAR(rig.imu->gyro_noise_rad_s_sqrtHz, 2e-4, 1e-5);
	EXPECT_NEAR(rig.imu->acc_walk_m_s3_sqrtHz, 1e-3, 4e-4);
	EXPECT_EQ(rig.imu->gyro_walk_rad_s2_sqrtHz, 0);
	EXPECT_EQ(rig.imu->mounting.y_m, -0.2);
	for (const char* name : {"a.svg", "a.html"}) EXPECT_NE(readFile(folder.file(name)).find("</svg>"), std::string::npos) << name;
	const auto panels = [&](const char* name)
	{
		const std::string text = readFile(folder.file(name));
		size_t count = 0;
		for (size_t at = text.find("<svg "); at != std::string::npos; at = text.find("<svg ", at + 1)) ++count;
		return count;
	};
	EXPECT_EQ(panels("a.svg"), 1u);
	EXPECT_EQ(panels("a.html"), 2u) << "each as wide as a phone";
	for (const char* name : {"imu.ini", "a.svg", "a.html", "a.json", "a.csv"})
		EXPECT_NE(result.out.find(folder.file(name) + "\n"), std::string::npos) << name;
	EXPECT_NE(readFile(folder.file("a.csv")).find("gyro z,0.01,"), std::string::npos);
	EXPECT_NE(readFile(folder.file("a.json")).find("\"acc_walk_m_s3_sqrtHz\""), std::string::npos);
}

TEST(AllanProgram, ARigKeepsWhatIsNotNoise)
{
	const TempFolder folder;
	writeStandingLog(folder.file("x.rawlog"), StandingImu().record());
	RigFile rig;
	rig.imu = RigImu();
	rig.imu->mounting.yaw_deg = 90;
	rig.imu->acc_walk_m_s3_sqrtHz = 7e-4;
	rig.wheels = RigWheels();
	rig.wheels->left_scale = 1.01;
	rig.save(folder.file("rig.ini"), "before");
	const ProgramResult result =
	    allan({"-i", folder.file("x.rawlog"), "--rig", folder.file("rig.ini"), "-o", folder.file("new.ini"), "--quiet"});
	ASSERT_EQ(result.status, 0) << result.err;
	EXPECT_EQ(result.err, "");
	const RigFile now = RigFile::load(folder.file("new.ini"));
	EXPECT_EQ(now.imu->mounting.yaw_deg, 90);
	EXPECT_EQ(now.imu->acc_walk_m_s3_sqrtHz, 7e-4) << "not observed: stays";
	EXPECT_NEAR(now.imu->gyro_noise_rad_s_sqrtHz, 2e-4, 1e-5);
	EXPECT_EQ(now.wheels->left_scale, 1.01);

	rig.imu->mounting.label = "OTHER";
	rig.save(folder.file("rig.ini"), "another IMU");
	const ProgramResult other = allan({"-i", folder.file("x.rawlog"), "--rig", folder.file("rig.ini"), "-o", folder.file("new.ini")});
	EXPECT_EQ(other.status, 1);
	EXPECT_NE(other.err.find("is OTHER"), std::string::npos) << other.err;
}

TEST(AllanProgram, BadInputIsOneLine)
{
	const TempFolder folder;
	StandingImu imu;
	imu.length_s = 5;
	writeStandingLog(folder.file("x.rawlog"), imu.record());
	const ProgramResult too_short = allan({"-i", folder.file("x.rawlog"), "-o", folder.file("imu.ini")});
	EXPECT_EQ(too_short.status, 1);
	EXPECT_EQ(too_short.errorLines(), 1u) << too_short.err;
	EXPECT_FALSE(std::filesystem::exists(folder.file("imu.ini")));
	EXPECT_EQ(allan({"-i", folder.file("x.rawlog"), "-o", folder.file("x.rawlog")}).status, 2);
	EXPECT_EQ(allan({"-i", folder.file("x.rawlog"), "-o", folder.file("i.ini"), "--csv", folder.file("x.rawlog")}).status, 2);
	EXPECT_EQ(allan({"-i", folder.file("x.rawlog"), "-o", folder.file("i.ini"), "--from", "3", "--to", "2"}).status, 2);
	EXPECT_EQ(allan({"-o", folder.file("i.ini")}).status, 2);
}
}  // namespace
}  // namespace viwo::testing
