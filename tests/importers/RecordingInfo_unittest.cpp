#include "ExpectError.h"
#include "RunProgram.h"
#include "SmallRecordings.h"

#include <viwo/importers/EurocImporter.h>
#include <viwo/importers/RecordingInfo.h>
#include <viwo/rawlog/RawlogWriter.h>

#include <filesystem>

using namespace viwo;
using namespace viwo::testing;

namespace
{
RecordingInfo inspect(const std::string& path)
{
	return inspectRecording(path, [](double) { return true; });
}

const StreamInfo& stream(const RecordingInfo& info, const std::string& name, SensorRole role)
{
	for (const StreamInfo& s : info.streams)
		if (s.name == name && s.role == role) return s;
	throw std::runtime_error("no stream " + name);
}

void expectText(const RecordingInfo& info, std::initializer_list<const char*> parts)
{
	const std::string text = describeRecording(info);
	for (const char* part : parts) EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' is not in:\n" << text;
}
}  // namespace

TEST(RecordingInfo, EurocFolderAndItsRawlog)
{
	const TempFolder folder;
	writeEuroc(folder);
	const RecordingInfo source = inspect(folder.path());
	EXPECT_EQ(source.kind, "EuRoC sequence");
	const StreamInfo& imu = stream(source, "imu0", SensorRole::imu);
	EXPECT_EQ(imu.count, 201u);
	EXPECT_NEAR(imu.rate_hz, 100, 1e-9);
	EXPECT_NEAR(imu.largest_gap_s, 0.01, 1e-9);
	expectText(source, {"--mode viwo       yes\n", "viwo-groundtruth  no, without 2D scans\n"});

	importEuroc({folder.path(), folder.file("x.rawlog")});
	const RecordingInfo rawlog = inspect(folder.file("x.rawlog"));
	EXPECT_EQ(rawlog.kind, "rawlog");
	EXPECT_EQ(stream(rawlog, "CAM", SensorRole::camera).count, 21u);
	EXPECT_EQ(stream(rawlog, "ODOMETRY", SensorRole::wheels).count, 41u);
	EXPECT_EQ(stream(rawlog, "IMU", SensorRole::imu).first_t_ns, kStart_ns);
	expectText(rawlog, {"--mode viwo       yes\n", "CObservationImage"});
	std::filesystem::copy_file(folder.file("x.rawlog"), folder.file("x.dat"));
	EXPECT_EQ(inspect(folder.file("x.dat")).kind, "rawlog") << "whatever its name";
	std::filesystem::create_directory(folder.file("nothing"));
	expectError([&] { inspect(folder.file("nothing")); }, {"nothing", "EuRoC", "KITTI"});
}

TEST(RecordingInfo, LongNamesAreNotCut)
{
	RecordingInfo info;
	info.path = "x.bag";
	StreamInfo camera, imu;
	camera.name = "/" + std::string(3000, 'c') + "/image";
	camera.type = std::string(500, 't') + "/Image";
	camera.role = SensorRole::camera;
	camera.calibrated = false;
	imu.role = SensorRole::imu;
	imu.rate_hz = 100;
	info.streams = {camera, imu};
	const std::string remark = "; the calibration of " + camera.name + " is missing\n";
	expectText(info, {camera.name.c_str(), camera.type.c_str(), "to s\n", remark.c_str()});
}

TEST(RecordingInfo, KittiFolder)
{
	const TempFolder folder;
	writeKitti(folder);
	const RecordingInfo info = inspect(folder.path());
	EXPECT_EQ(info.kind, "KITTI drive");
	EXPECT_EQ(stream(info, "image_00", SensorRole::camera).count, 20u);
	EXPECT_NEAR(stream(info, "image_00", SensorRole::camera).largest_gap_s, 0.2, 1e-6);
	expectText(info, {"note: missing: 1 image of timestamps.txt\n"});
}

TEST(RecordingInfo, GapsJitterAndWhatIsMissing)
{
	const TempFolder folder;
	{
		RawlogWriter writer(folder.file("x.rawlog"));
		// 20 Hz with 2 ms of jitter, and a hole of half a second.
		for (int i = 0; i < 100; ++i)
			writer.write(makeOdometry(kStart_ns + (50 * i + (i % 2) * 2 + (i >= 50 ? 500 : 0)) * 1000000LL, {0.1, 0}));
		writer.write(makeImage(kStart_ns, CameraModel(64, 48, 0, 0, 0, 0), {}, "absent.png"));
		writer.close();
	}
	const RecordingInfo info = inspect(folder.file("x.rawlog"));
	const StreamInfo& odometry = stream(info, "ODOMETRY", SensorRole::wheels);
	EXPECT_NEAR(odometry.rate_hz, 99 / 5.452, 1e-6);
	EXPECT_NEAR(odometry.largest_gap_s, 0.548, 1e-6);
	EXPECT_NEAR(odometry.jitter_s, 0.004, 1e-6);
	expectText(info, {"--mode wheel      yes\n", "--mode wio        no, without an IMU\n", "CAM: missing: 1 image file\n"});
}

TEST(RecordingInfo, WhatIsOfNoKindIsSaidToBeOfNone)
{
	const TempFolder folder;
	const std::string trajectory = write(folder, "x.tum", "1600000000.0 0 0 0 0 0 0 1\n1600000000.1 0 0 0 0 0 0 1\n");
	for (const std::string& path :
	     {trajectory, write(folder, "x.html", "<html></html>\n"), write(folder, "x.png", std::string("\x89PNG\0", 5))})
		expectError([&] { inspect(path); }, {path, "none of these", "rawlog", "ROS bag", "CARMEN", "EuRoC", "KITTI"});
	for (const std::string& path : {std::string("/dev/null"), write(folder, "empty.txt", "")})
		expectError([&] { inspect(path); }, {path, "empty"});
	expectError([&] { inspect(write(folder, "x.log", "PARAM robot_frontlaser_offset 0.1\n")); }, {"no FLASER"});
	expectError([&] { inspect(write(folder, "y.log", "FLASER 2 1\n")); }, {"y.log:1", "ends too early"});
}

TEST(RecordingInfo, Program)
{
	const TempFolder folder;
	writeEuroc(folder);
	const std::string program = VIWO_BINARY_DIR "/bin/viwo-info";
	const ProgramResult result = runProgram(program, {folder.path()});
	EXPECT_EQ(result.status, 0) << result.err;
	EXPECT_NE(result.out.find("EuRoC sequence"), std::string::npos) << result.out;
	EXPECT_EQ(result.err, "");
	EXPECT_NE(runProgram(program, {"--help"}).out.find("Examples:"), std::string::npos);
	EXPECT_EQ(runProgram(program, {}).status, 2);
	for (const std::string& path : {std::string("/dev/zero"), folder.file("absent.rawlog"), write(folder, "empty/x", "") + "/..",
	                                write(folder, "x.log", "FLASE 1 2\n"), write(folder, "x.mcap", "\x89MCAP0\r\n")})
	{
		const ProgramResult bad = runProgram(program, {path});
		EXPECT_EQ(bad.status, 1) << path;
		EXPECT_EQ(bad.errorLines(), 1u) << bad.err;
	}
}
