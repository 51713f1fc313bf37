#include "Refused.h"
#include "ScanRoom.h"

#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>
#include <viwo/core/MrptPose.h>
#include <viwo/rawlog/RawlogReader.h>

#include <gtest/gtest.h>

namespace viwo
{
namespace
{
using namespace testing;

const std::string kProgram = VIWO_BINARY_DIR "/bin/viwo-convert";
const std::string kSample = VIWO_SOURCE_DIR "/rawlogs/sample.rawlog", kSampleTruth = VIWO_SOURCE_DIR "/rawlogs/sample_ground_truth.tum";
}  // namespace

TEST(ConvertProgram, ThroughAllFormatsAndBack)
{
	const TempFolder folder;
	ScanRoom().trajectory().saveTum(folder.file("a.tum"));
	std::string last = folder.file("a.tum");
	for (const char* name : {"b.kitti", "c.csv", "d.g2o", "e.tum"})
	{
		const ProgramResult result = runProgram(kProgram, {"trajectory", "-i", last, "-o", folder.file(name)});
		ASSERT_EQ(result.status, 0) << result.err;
		last = folder.file(name);
	}
	const Trajectory before = Trajectory::loadTum(folder.file("a.tum")), after = Trajectory::loadTum(last);
	ASSERT_EQ(before.size(), after.size());
	for (size_t i = 0; i < before.size(); ++i)
	{
		EXPECT_EQ(before.poses()[i].t_ns, after.poses()[i].t_ns);
		EXPECT_LT((before.poses()[i].T.p - after.poses()[i].T.p).norm(), 2e-9);
		EXPECT_LT(before.poses()[i].T.R.angularDistance(after.poses()[i].T.R), 1e-7);
	}
}

TEST(ConvertProgram, CameraPosesByTheRawlogsMounting)
{
	const TempFolder folder;
	const ProgramResult result = runProgram(
	    kProgram, {"trajectory", "-i", kSampleTruth, "-o", folder.file("c.tum"), "--to-frame", "C", "--rawlog", kSample, "--rate", "10"});
	ASSERT_EQ(result.status, 0) << result.err;
	Pose3 T_OC;
	RawlogReader reader(kSample);
	while (const auto observation = reader.next())
		if (const auto image = std::dynamic_pointer_cast<mrpt::obs::CObservationImage>(observation))
		{
			T_OC = fromMrpt(image->cameraPose);
			break;
		}
	const Trajectory vehicle = Trajectory::loadTum(kSampleTruth), camera = Trajectory::loadTum(folder.file("c.tum"));
	ASSERT_GT(camera.size(), 100u);
	for (const StampedPose& pose : camera.poses())
	{
		const Pose3 expected = *vehicle.at(pose.t_ns, 1) * T_OC;
		EXPECT_LT((pose.T.p - expected.p).norm(), 1e-8);
		EXPECT_LT(pose.T.R.angularDistance(expected.R), 1e-7);
	}
	expectRefused(runProgram(kProgram, {"trajectory", "-i", kSampleTruth, "-o", folder.file("b.tum"), "--to-frame", "B"}), {"--rawlog"});
}

TEST(ConvertProgram, RawlogWithPosesForMrptsPrograms)
{
	const ScanRoomFiles files;
	const std::string out = files.folder.file("with.rawlog");
	const ProgramResult result = runProgram(kProgram, {"rawlog", "-i", files.rawlog, "-t", files.tum, "-o", out, "--label", "TRUTH"});
	ASSERT_EQ(result.status, 0) << result.err;
	mrpt::obs::CRawlog log;
	ASSERT_TRUE(log.loadFromRawLogFile(out));
	size_t scans = 0, poses = 0;
	mrpt::Clock::time_point last{};
	for (size_t i = 0; i < log.size(); ++i)
	{
		const auto observation = log.getAsObservation(i);
		EXPECT_GE(observation->timestamp, last) << "in the order of time";
		last = observation->timestamp;
		const auto pose = std::dynamic_pointer_cast<mrpt::obs::CObservationRobotPose>(observation);
		scans += !pose;
		if (!pose) continue;
		++poses;
		EXPECT_EQ(pose->sensorLabel, "TRUTH");
		EXPECT_GT(pose->pose.mean.x(), -1e-9);
	}
	EXPECT_EQ(scans, 40u);
	EXPECT_EQ(poses, 39u * 5 + 1);
	const ProgramResult info = runProgram("/usr/bin/rawlog-edit", {"--info", "-i", out});
	EXPECT_NE(info.out.find("TRUTH"), std::string::npos) << info.out;
	expectRefused(runProgram(kProgram, {"rawlog", "-i", files.rawlog, "-t", files.tum, "-o", files.rawlog}), {"is an input"});
	writeFile(files.folder.file("other.tum"), "1 0 0 0 0 0 0 1\n");
	expectRefused(
	    runProgram(kProgram, {"rawlog", "-i", files.rawlog, "-t", files.folder.file("other.tum"), "-o", files.folder.file("z.rawlog")}),
	    {"no pose"});
	EXPECT_FALSE(std::filesystem::exists(files.folder.file("z.rawlog")));
}

TEST(ConvertProgram, ImagesComeAlong)
{
	const TempFolder folder;
	const std::string out = folder.file("with.rawlog");
	const ProgramResult result = runProgram(kProgram, {"rawlog", "-i", kSample, "-t", kSampleTruth, "-o", out});
	ASSERT_EQ(result.status, 0) << result.err;
	RawlogReader reader(out);
	size_t images = 0;
	while (const auto observation = reader.next())
	{
		const auto image = std::dynamic_pointer_cast<mrpt::obs::CObservationImage>(observation);
		if (!image) continue;
		++images;
		EXPECT_EQ(image->image.getExternalStorageFile().rfind(folder.file("with_Images"), 0), 0u) << image->image.getExternalStorageFile();
	}
	EXPECT_GT(images, 100u);
}

TEST(ConvertProgram, SimpleMapOfKeyFrames)
{
	const ScanRoomFiles files;
	const std::string out = files.folder.file("x.simplemap");
	const ProgramResult result =
	    runProgram(kProgram, {"simplemap", "-i", files.rawlog, "-t", files.tum, "-o", out, "--distance", "0.3", "--angle", "90"});
	ASSERT_EQ(result.status, 0) << result.err;
	mrpt::maps::CSimpleMap map;
	mrpt::io::CFileGZInputStream file(out);
	mrpt::serialization::archiveFrom(file) >> map;
	ASSERT_GE(map.size(), 3u);
	for (size_t i = 0; i < map.size(); ++i)
	{
		const auto& [pose, frame] = map.getAsPair(i);
		EXPECT_EQ(frame->size(), 1u);
		EXPECT_EQ(frame->getObservationByIndex(0)->sensorLabel, "LIDAR");
		if (i == 0) continue;
		const double step_m = pose->getMeanVal().distanceTo(map.getAsPair(i - 1).pose->getMeanVal());
		EXPECT_NEAR(step_m, 0.3, 0.02);
	}
	writeFile(files.folder.file("k.csv"), "t_ns,x,y,z,qx,qy,qz,qw\n1700000000500000000,0,0,0,0,0,0,1\n1700000001000000000,0,0,0,0,0,0,1\n");
	ASSERT_EQ(runProgram(kProgram, {"simplemap", "-i", files.rawlog, "-t", files.tum, "-o", out, "--keyframes", files.folder.file("k.csv")})
	              .status,
	          0);
	mrpt::io::CFileGZInputStream again(out);
	mrpt::serialization::archiveFrom(again) >> map;
	EXPECT_EQ(map.size(), 2u);
}

TEST(ConvertProgram, BadUsage)
{
	const TempFolder folder;
	ScanRoom().trajectory().saveTum(folder.file("a.tum"));
	expectRefused(runProgram(kProgram, {"trajectory", "-i", folder.file("a.tum"), "-o", folder.file("b.xyz")}), {"--to"});
	expectRefused(runProgram(kProgram, {"trajectory", "-i", folder.file("a.tum"), "-o", folder.file("no/b.tum")}), {"no folder"});
	expectRefused(runProgram(kProgram, {"trajectory", "-i", folder.file("a.tum"), "-o", folder.file("b.tum"), "--rate", "0"}), {"--rate"});
	expectRefused(runProgram(kProgram, {"landmarks", "-i", folder.file("a.tum"), "-o", folder.file("b.pcd")}), {"not a PLY"});
	expectRefused(runProgram(kProgram, {"nonsense"}), {""});
	EXPECT_EQ(runProgram(kProgram, {"trajectory"}).status, 2);
	const std::string command = "ulimit -f 1; trap '' XFSZ; exec " + quoted(kProgram) + " trajectory -i " + quoted(folder.file("a.tum")) +
	                            " -o " + quoted(folder.file("b.csv"));
	expectRefused(runProgram("/bin/bash", {"-c", command}), {"cannot write"});
	EXPECT_FALSE(std::filesystem::exists(folder.file("b.csv")));
}
}  // namespace viwo
