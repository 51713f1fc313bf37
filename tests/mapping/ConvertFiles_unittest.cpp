#include "Refused.h"
#include "ScanRoom.h"

#include <gtest/gtest.h>
#include <mrpt/obs/CObservationImage.h>
#include <viwo/core/MrptPose.h>
#include <viwo/mapping/Landmarks.h>
#include <viwo/rawlog/RawlogReader.h>

#include <filesystem>

namespace viwo
{
namespace
{
using namespace testing;
namespace fs = std::filesystem;

const std::string kProgram = VIWO_BINARY_DIR "/bin/viwo-convert";
const std::string kSample = VIWO_SOURCE_DIR "/rawlogs/sample.rawlog", kSampleTruth = VIWO_SOURCE_DIR "/rawlogs/sample_ground_truth.tum";

ProgramResult trajectory(std::vector<std::string> arguments)
{
	arguments.insert(arguments.begin(), "trajectory");
	return runProgram(kProgram, arguments);
}
}  // namespace

TEST(ConvertFiles, StampsGoWhereNothingElseIs)
{
	const TempFolder folder;
	ScanRoom().trajectory().saveTum(folder.file("x.tum"));
	const std::string of_import = "rawlog_ns,original_s\n1,2\n";
	for (const char* name : {"x_stamps.csv", "x_times.txt"}) writeFile(folder.file(name), of_import);
	const ProgramResult g2o = trajectory({"-i", folder.file("x.tum"), "-o", folder.file("x.g2o")}),
	                    kitti = trajectory({"-i", folder.file("x.tum"), "-o", folder.file("x.kitti")});
	EXPECT_NE(g2o.out.find("x_g2o_stamps.csv"), std::string::npos) << g2o.out << g2o.err;
	EXPECT_NE(kitti.out.find("x_kitti_times.txt"), std::string::npos) << kitti.out << kitti.err;
	for (const char* name : {"x_stamps.csv", "x_times.txt"}) EXPECT_EQ(readFile(folder.file(name)), of_import) << name;
	for (const char* name : {"x.g2o", "x.kitti"})
	{
		expectDone(trajectory({"-i", folder.file(name), "-o", folder.file("back.tum")}));
		EXPECT_EQ(Trajectory::loadTum(folder.file("back.tum")).size(), ScanRoom().trajectory().size()) << name;
	}
	// Without its own stamps, those of the import beside it are not taken for them.
	fs::remove(folder.file("x_g2o_stamps.csv"));
	expectRefused(trajectory({"-i", folder.file("x.g2o"), "-o", folder.file("back.tum")}), {"x_stamps.csv:1", "no column 'id'"});
}

TEST(ConvertFiles, StampsAsOthersNameThem)
{
	const TempFolder folder;
	writeFile(folder.file("graph.g2o"), "VERTEX_SE2 3 0 0 0\nVERTEX_SE2 7 1 2 1.5\n");
	expectRefused(trajectory({"-i", folder.file("graph.g2o"), "-o", folder.file("g.tum")}),
	              {"graph.g2o", "graph_g2o_stamps.csv", "graph_stamps.csv", "--stamps"});
	writeFile(folder.file("graph_stamps.csv"), "id,t_ns\n3,100\n7,200\n");
	writeFile(folder.file("poses.kitti"), "1 0 0 5 0 1 0 0 0 0 1 0\n");
	writeFile(folder.file("poses_times.txt"), "0.5\n");
	for (const char* name : {"graph.g2o", "poses.kitti"})
		expectDone(trajectory({"-i", folder.file(name), "-o", folder.file(std::string(name) + ".tum")}));
	EXPECT_EQ(Trajectory::loadTum(folder.file("graph.g2o.tum")).poses()[1].t_ns, 200);
	EXPECT_EQ(Trajectory::loadTum(folder.file("poses.kitti.tum")).poses()[0].t_ns, 500'000'000);
	fs::rename(folder.file("poses_times.txt"), folder.file("elsewhere"));
	expectDone(trajectory({"-i", folder.file("poses.kitti"), "-o", folder.file("p.tum"), "--stamps", folder.file("elsewhere")}));
}

TEST(ConvertFiles, InputsAreKept)
{
	const TempFolder folder;
	ScanRoom().trajectory().saveTum(folder.file("x.tum"));
	expectDone(trajectory({"-i", folder.file("x.tum"), "-o", folder.file("x.kitti")}));
	const std::string times = readFile(folder.file("x_kitti_times.txt"));
	for (const char* name : {"x_kitti_times.txt", "x.kitti"})
		expectRefused(trajectory({"-i", folder.file("x.kitti"), "-o", folder.file(name), "--to", "tum"}), {name, "is an input"});
	fs::rename(folder.file("x.tum"), folder.file("y_g2o_stamps.csv"));
	expectRefused(trajectory({"-i", folder.file("y_g2o_stamps.csv"), "--from", "tum", "-o", folder.file("y.g2o")}),
	              {"y_g2o_stamps.csv", "is an input"});
	EXPECT_EQ(readFile(folder.file("x_kitti_times.txt")), times);
	EXPECT_EQ(Trajectory::loadTum(folder.file("y_g2o_stamps.csv")).size(), ScanRoom().trajectory().size());
}

TEST(ConvertFiles, FramesNeedNoImages)
{
	const TempFolder folder;
	fs::copy_file(kSample, folder.file("alone.rawlog"));
	const std::string camera = folder.file("c.tum"), back = folder.file("o.tum"), rawlog = folder.file("alone.rawlog");
	expectDone(trajectory({"-i", kSampleTruth, "-o", camera, "--to-frame", "C", "--rawlog", rawlog}));
	expectDone(trajectory({"-i", camera, "-o", back, "--from-frame", "C", "--to-frame", "O", "--rawlog", rawlog}));
	expectDone(trajectory({"-i", camera, "-o", folder.file("b.tum"), "--from-frame", "C", "--to-frame", "B", "--rawlog", kSample}));
	const Trajectory vehicle = Trajectory::loadTum(kSampleTruth), returned = Trajectory::loadTum(back),
	                 of_camera = Trajectory::loadTum(camera), of_imu = Trajectory::loadTum(folder.file("b.tum"));
	ASSERT_EQ(returned.size(), vehicle.size());
	const auto relative = [](const Trajectory& a, const Trajectory& b, size_t i) { return a.poses()[i].T.inverse() * b.poses()[i].T; };
	EXPECT_GT(relative(vehicle, of_camera, 0).p.norm(), 0.05) << "the camera is not at the vehicle's origin";
	for (size_t i = 0; i < vehicle.size(); ++i)
	{
		EXPECT_LT(relative(vehicle, returned, i).p.norm(), 1e-8);
		EXPECT_LT(vehicle.poses()[i].T.R.angularDistance(returned.poses()[i].T.R), 1e-7);
		EXPECT_LT((relative(of_camera, of_imu, i).p - relative(of_camera, of_imu, 0).p).norm(), 1e-8);
	}
	expectRefused(trajectory({"-i", camera, "-o", back, "--from-frame", "C", "--to-frame", "O"}), {"--rawlog"});
	expectRefused(trajectory({"-i", camera, "-o", back, "--to-frame", "C", "--rawlog", rawlog, "--cam-label", "EYE"}),
	              {"alone.rawlog", "no image", "EYE", "CAM ("});
}

TEST(ConvertFiles, AtTheStampsOfAnotherTrajectory)
{
	const TempFolder folder;
	const Trajectory whole = ScanRoom().trajectory();
	whole.saveTum(folder.file("x.tum"));
	Trajectory asked;
	for (const int64_t ms : {-10, 0, 13, 1005, 3999, 90000}) asked.push_back({ScanRoom::kStart_ns + ms * 1'000'000, Pose3()});
	asked.saveTum(folder.file("asked.tum"));
	expectDone(trajectory({"-i", folder.file("x.tum"), "-o", folder.file("y.tum"), "--like", folder.file("asked.tum")}));
	const Trajectory got = Trajectory::loadTum(folder.file("y.tum"));
	ASSERT_EQ(got.size(), 4u) << "none before the first pose and behind the last";
	for (const StampedPose& pose : got.poses()) EXPECT_LT((pose.T.p - whole.at(pose.t_ns, 1)->p).norm(), 1e-8);
	expectRefused(trajectory({"-i", folder.file("x.tum"), "-o", folder.file("y.tum"), "--like", folder.file("asked.tum"), "--rate", "5"}),
	              {"--like"});
	asked = Trajectory();
	asked.push_back({5, Pose3()});
	asked.saveTum(folder.file("asked.tum"));
	expectRefused(trajectory({"-i", folder.file("x.tum"), "-o", folder.file("y.tum"), "--like", folder.file("asked.tum")}),
	              {"x.tum", "asked.tum", "no pose"});
}

TEST(ConvertFiles, PosesGoInOnce)
{
	const ScanRoomFiles files;
	const std::string once = files.folder.file("once.rawlog"), twice = files.folder.file("twice.rawlog");
	const auto putIn = [&](const std::string& from, const std::string& to, const std::string& label) {
		return runProgram(kProgram, {"rawlog", "-i", from, "-t", files.tum, "-o", to, "--label", label});
	};
	expectDone(putIn(files.rawlog, once, "POSE"));
	expectRefused(putIn(once, twice, "POSE"), {"once.rawlog", "label POSE is taken", "--label"});
	expectRefused(putIn(files.rawlog, twice, "LIDAR"), {"x.rawlog", "label LIDAR is taken"});
	expectRefused(putIn(files.rawlog, files.folder.file("twice.xyz"), "POSE"), {"twice.xyz", ".rawlog"});
	EXPECT_FALSE(fs::exists(twice));
	expectDone(putIn(once, twice, "ESTIMATE"));
	expectRefused(runProgram(kProgram, {"simplemap", "-i", files.rawlog, "-t", files.tum, "-o", files.folder.file("s2.xyz")}),
	              {"s2.xyz", ".simplemap"});
	EXPECT_FALSE(fs::exists(files.folder.file("s2.xyz")));
}

/** run.rawlog and run.gz share the folder run_Images: its files are neither copied nor lost. */
TEST(ConvertFiles, ACopyThatSharesItsImages)
{
	const TempFolder folder;
	fs::copy_file(kSample, folder.file("run.rawlog"));
	std::string name;
	RawlogReader reader(kSample);
	while (const auto observation = reader.next())
		if (const auto image = std::dynamic_pointer_cast<mrpt::obs::CObservationImage>(observation))
		{
			name = fs::path(image->image.getExternalStorageFile()).filename().string();
			break;
		}
	fs::copy(reader.imagesFolder(), folder.file("run_Images"));
	const size_t bytes = fs::file_size(folder.file("run_Images/" + name));
	ASSERT_GT(bytes, 100u);
	fs::create_symlink("run_Images", folder.file("copy_Images"));
	expectDone(runProgram(kProgram, {"rawlog", "-i", folder.file("run.rawlog"), "-t", kSampleTruth, "-o", folder.file("copy.rawlog")}));
	EXPECT_EQ(fs::file_size(folder.file("run_Images/" + name)), bytes);
}

TEST(ConvertFiles, SameBytesTwice)
{
	const ScanRoomFiles files;
	saveLandmarks(files.folder.file("l.ply"), {{4, {3, 1, 2}, 0.01}, {7, {-3.5, -1, 1.5}, 0.02}});
	const auto bytes = [&]
	{
		const TempFolder out;
		std::string all;
		const auto make = [&](const std::string& name, std::vector<std::string> arguments)
		{
			arguments.insert(arguments.end(), {"-o", out.file(name)});
			expectDone(runProgram(kProgram, arguments));
			EXPECT_FALSE(readFile(out.file(name)).empty()) << name;
		};
		for (const char* name : {"t.kitti", "t.g2o"}) make(name, {"trajectory", "-i", files.tum});
		make("l.pcd", {"landmarks", "-i", files.folder.file("l.ply")});
		make("m.simplemap", {"simplemap", "-i", files.rawlog, "-t", files.tum});
		make("r.rawlog", {"rawlog", "-i", files.rawlog, "-t", files.tum});
		for (const char* name : {"t.kitti", "t_kitti_times.txt", "t.g2o", "t_g2o_stamps.csv", "l.pcd", "m.simplemap", "r.rawlog"})
			all += readFile(out.file(name));
		return all;
	};
	const std::string first = bytes();
	EXPECT_GT(first.size(), 50000u);
	EXPECT_EQ(bytes(), first);
}

TEST(ConvertFiles, FullDisk)
{
	const ScanRoomFiles files;
	saveLandmarks(files.folder.file("l.ply"), {{4, {3, 1, 2}, 0.01}});
	const auto toFull = [&](const std::string& name, std::vector<std::string> arguments, const std::string& full = {})
	{
		const std::string link = files.folder.file(full.empty() ? name : full);
		fs::create_symlink("/dev/full", link);
		arguments.insert(arguments.end(), {"-o", files.folder.file(name)});
		expectRefused(runProgram(kProgram, arguments), {"/dev/full", "cannot write", "is the disk full?"});
		fs::remove(link);
		for (const char* either : {"t.kitti", "t_kitti_times.txt", "t.g2o", "t_g2o_stamps.csv"})
			EXPECT_FALSE(fs::exists(files.folder.file(either))) << either << " without the other file";
	};
	for (const char* name : {"t.tum", "t.kitti"}) toFull(name, {"trajectory", "-i", files.tum});
	toFull("t.kitti", {"trajectory", "-i", files.tum}, "t_kitti_times.txt");
	toFull("t.g2o", {"trajectory", "-i", files.tum}, "t_g2o_stamps.csv");
	toFull("m.pcd", {"landmarks", "-i", files.folder.file("l.ply")});
	toFull("m.simplemap", {"simplemap", "-i", files.rawlog, "-t", files.tum});
	toFull("r.rawlog", {"rawlog", "-i", files.rawlog, "-t", files.tum});
}

TEST(ConvertFiles, ValuesThatAreNoNumbers)
{
	const TempFolder folder;
	ScanRoom().trajectory().saveTum(folder.file("a.tum"));
	for (const char* option : {"--rate", "--max-gap"})
		for (const char* value : {"nan", "0"})
			expectRefused(trajectory({"-i", folder.file("a.tum"), "-o", folder.file("b.tum"), option, value}), {option});
	expectRefused(trajectory({"-i", folder.file("a.tum"), "-o", folder.file("b.tum"), "--rate", "1e12"}), {"--rate", "10000"});
	for (const char* option : {"--distance", "--angle", "--max-offset"})
		expectRefused(runProgram(kProgram, {"simplemap", "-i", "x", "-t", "x", "-o", "x", option, "nan"}), {option});
}
}  // namespace viwo
