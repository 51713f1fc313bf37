#include <algorithm>
#include <limits>

#include "EditedLog.h"
#include "OdometryProgram.h"

using mrpt::obs::CObservation;
using mrpt::obs::CObservationImage;
using mrpt::obs::CObservationIMU;
using mrpt::obs::CObservationOdometry;

namespace viwo::testing
{
namespace
{
/** Each kind of bad input gives one clear line and status 1, and what was computed is kept. */
class BadInput : public OdometryProgram
{
   protected:
	std::string edited(const Edit& edit, double duration_s = 4) { return editedLog(log_.rawlog, folder_, duration_s, edit); }

	/** The program fails with one line that holds all of the parts. */
	void expectFailure(const std::string& rawlog, const std::vector<std::string>& parts, std::vector<std::string> options = {},
	                   int status = 1)
	{
		options.push_back("--quiet");
		const ProgramResult result = runOdometry(rawlog, "out", options);
		EXPECT_EQ(result.status, status);
		EXPECT_EQ(result.errorLines(), 1u) << result.err;
		EXPECT_EQ(result.err.rfind("viwo-odometry: error: ", 0), 0u) << result.err;
		for (const std::string& part : parts)
			EXPECT_NE(result.err.find(part), std::string::npos) << "'" << part << "' is not in: " << result.err;
	}

	/** What was computed before the failure is there and valid. */
	void expectKept(size_t poses)
	{
		ASSERT_TRUE(std::filesystem::exists(output("out", "trajectory.tum")));
		EXPECT_GE(trajectory("out").size(), poses);
		EXPECT_EQ(summary("out").at("poses"), trajectory("out").size());
		EXPECT_TRUE(std::filesystem::exists(output("out", "config.ini")));
	}

	void expectNothingKept() { EXPECT_FALSE(std::filesystem::exists(output("out", "trajectory.tum"))); }

	const TestLog log_ = testLog(lobbyTestDrive());
};

void copy(CObservation& observation, double, RawlogWriter& writer)
{
	writer.write(observation);
}

TEST_F(BadInput, FilesThatAreNoRawlog)
{
	expectFailure(folder_.file("none.rawlog"), {"none.rawlog", "no such file"});
	writeFile(folder_.file("empty.rawlog"), "");
	expectFailure(folder_.file("empty.rawlog"), {"empty.rawlog", "empty"});
	writeFile(folder_.file("text.rawlog"), "t x y z\n1 2 3 4\n");
	expectFailure(folder_.file("text.rawlog"), {"text.rawlog", "not a rawlog"});
	writeFile(folder_.file("zstd.rawlog"), std::string("\x28\xB5\x2F\xFD\x04\x00more", 10));
	expectFailure(folder_.file("zstd.rawlog"), {"zstd.rawlog", "zstd", "unpack"});
	writeFile(folder_.file("run.bag"), "#ROSBAG V2.0\nand so on");
	expectFailure(folder_.file("run.bag"), {"run.bag", "a ROS bag", "viwo-import rosbag"});
	expectFailure(folder_.path(), {"folder"});
	expectNothingKept();
}

TEST_F(BadInput, TruncatedRawlog)
{
	const std::string path = edited(copy), whole = readFile(path);
	writeFile(path, whole.substr(0, whole.size() * 3 / 4));
	expectFailure(path, {path, "truncated", "entries", "--allow-truncated"});
	expectKept(10);
	const size_t poses = trajectory("out").size();
	odometry(path, "allowed", {"--allow-truncated", "--quiet"});
	EXPECT_GE(trajectory("allowed").size(), poses);
	EXPECT_LE(trajectory("allowed").size(), poses + 3) << "the images that waited for samples when the file ended";
}

TEST_F(BadInput, UnknownClassInside)
{
	// Embedded in an archive that is not compressed, so that the name can be changed.
	const std::string packed = edited(copy);
	ASSERT_EQ(
	    runProgram("sh", {"-c", "gzip -dc " + packed + " > " + folder_.file("plain") + "; mv " + folder_.file("plain") + " " + packed})
	        .status,
	    0);
	std::string bytes = readFile(packed);
	const size_t last = bytes.rfind("CObservationOdometry");
	ASSERT_NE(last, std::string::npos);
	writeFile(packed, bytes.replace(last, 20, "CObservationTelepath"));
	expectFailure(packed, {packed, "unknown class", "CObservationTelepath", "entries"});
	expectKept(20);
}

TEST_F(BadInput, NoImageImuOrOdometryUnderTheLabel)
{
	const std::string all = "labels here: ";
	expectFailure(edited(
	                  [](CObservation& o, double, RawlogWriter& w)
	                  {
		                  if (!isImage(o)) w.write(o);
	                  }),
	              {"no image", "CAM", all, "IMU (", "cam_label"});
	expectNothingKept();
	std::filesystem::remove(folder_.file("bad_Images"));
	expectFailure(edited(
	                  [](CObservation& o, double, RawlogWriter& w)
	                  {
		                  if (!isImu(o)) w.write(o);
	                  }),
	              {"no IMU", all, "CAM (", "imu_label"});
	std::filesystem::remove(folder_.file("bad_Images"));
	const std::string no_odometry = edited(
	    [](CObservation& o, double, RawlogWriter& w)
	    {
		    if (!isOdometry(o)) w.write(o);
	    });
	for (const char* mode : {"viwo", "wio", "wheel"})
		expectFailure(no_odometry, {"no odometry", "ODOMETRY", all, "CAM (", "odometry_label"}, {"--mode", mode});
	writeFile(folder_.file("labels.ini"), "[rawlog]\nimu_label = CAM\n");
	expectFailure(log_.rawlog, {"no IMU", "under label CAM", "ODOMETRY ("}, {"-c", folder_.file("labels.ini")});
}

TEST_F(BadInput, MissingImageFile)
{
	const std::string path = edited(copy);
	const std::string images = std::filesystem::read_symlink(folder_.file("bad_Images")).string();
	std::filesystem::remove(folder_.file("bad_Images"));
	std::filesystem::create_directory(folder_.file("bad_Images"));
	size_t number = 0;
	std::string missing;
	std::vector<std::filesystem::path> files;
	for (const auto& entry : std::filesystem::directory_iterator(images)) files.push_back(entry.path());
	std::sort(files.begin(), files.end());
	for (const auto& file : files)
		if (number++ != 30)
			std::filesystem::create_symlink(file, folder_.file("bad_Images/" + file.filename().string()));
		else
			missing = file.filename().string();
	expectFailure(path, {path, missing, "missing"});
	expectKept(15);
	std::filesystem::remove_all(folder_.file("bad_Images"));
	expectFailure(path, {path, "image", "missing"});
}

TEST_F(BadInput, ImageOfAnotherSizeThanItsCalibration)
{
	const auto shrink = [](CObservation& o, double, RawlogWriter& w)
	{
		if (auto* image = dynamic_cast<CObservationImage*>(&o)) image->cameraParams.scaleToResolution(320, 240);
		w.write(o);
	};
	expectFailure(edited(shrink), {"640 x 480", "320 x 240", "calibrat"});
}

TEST_F(BadInput, CalibrationThatWasMadeAtAnotherResolution)
{
	const auto enlarge = [](CObservation& o, double, RawlogWriter& w)
	{
		auto* image = dynamic_cast<CObservationImage*>(&o);
		if (image != nullptr)
		{
			image->cameraParams.scaleToResolution(1280, 960);
			image->cameraParams.ncols = 640;
			image->cameraParams.nrows = 480;
		}
		w.write(o);
	};
	expectFailure(edited(enlarge), {"CAM", "642.", "640 x 480", "principal point"});
}

/** Gravity fits and the camera too: the contradiction with the wheels is all that tells. */
TEST_F(BadInput, ImuMountedTheOtherWayRound)
{
	const auto turn = [](CObservation& o, double, RawlogWriter& w)
	{
		if (auto* imu = dynamic_cast<CObservationIMU*>(&o)) imu->sensorPose = mrpt::poses::CPose3D(0.1, 0.02, 0.3, M_PI / 2, 0, -M_PI / 2);
		w.write(o);
	};
	const std::string sample = VIWO_SOURCE_DIR "/rawlogs/sample.rawlog";
	expectFailure(editedLog(sample, folder_, 60, turn), {"the path is", "the wheels rolled", "cannot be trusted", "sensorPose"});
	expectKept(100);
	EXPECT_FALSE(summary("out").at("doubt").get<std::string>().empty());
	EXPECT_NEAR(summary("out").at("wheel_travel_m").get<double>(), 4.55, 0.2);
}

TEST_F(BadInput, NoCalibration)
{
	const auto strip = [](CObservation& o, double, RawlogWriter& w)
	{
		if (auto* image = dynamic_cast<CObservationImage*>(&o)) image->cameraParams = mrpt::img::TCamera();
		w.write(o);
	};
	expectFailure(edited(strip), {"CAM", "calibrat"});
	std::filesystem::remove(folder_.file("bad_Images"));
	const auto focal = [](CObservation& o, double, RawlogWriter& w)
	{
		if (auto* image = dynamic_cast<CObservationImage*>(&o)) image->cameraParams.intrinsicParams(0, 0) = 0;
		w.write(o);
	};
	expectFailure(edited(focal), {"CAM", "focal length"});
}

TEST_F(BadInput, ValuesThatAreNotFinite)
{
	const auto spoil = [](CObservation& o, double t_s, RawlogWriter& w)
	{
		if (auto* imu = dynamic_cast<CObservationIMU*>(&o); imu && t_s > 2 && t_s < 2.0101)
			imu->set(mrpt::obs::IMU_WX, std::numeric_limits<double>::quiet_NaN());
		if (auto* odometry = dynamic_cast<CObservationOdometry*>(&o); odometry && t_s > 3 && t_s < 3.0501)
			odometry->velocityLocal.vx = std::numeric_limits<double>::infinity();
		w.write(o);
	};
	expectFailure(edited(spoil), {"IMU: 2 not_finite", "ODOMETRY: 1 not_finite", "the rest"});
	expectKept(30);
	EXPECT_TRUE(trajectory("out").poses().back().T.p.allFinite());
	EXPECT_EQ(summary("out").at("observations").at("IMU").at("rejected").at("not_finite"), 2);
}

TEST_F(BadInput, ImuWithoutRates)
{
	const auto strip = [](CObservation& o, double, RawlogWriter& w)
	{
		if (auto* imu = dynamic_cast<CObservationIMU*>(&o))
			for (const auto slot : {mrpt::obs::IMU_WX, mrpt::obs::IMU_WY, mrpt::obs::IMU_WZ}) imu->dataIsPresent[slot] = false;
		w.write(o);
	};
	expectFailure(edited(strip), {"IMU", "no angular rates", "imu_label"});
}

TEST_F(BadInput, StampsThatGoBack)
{
	const auto jump = [](CObservation& o, double t_s, RawlogWriter& w)
	{
		if (isImu(o) && t_s > 2 && t_s < 2.0101) shiftStamp(o, -1);
		w.write(o);
	};
	expectFailure(edited(jump), {"IMU: 2 late", "the rest"});
	expectKept(30);
}

TEST_F(BadInput, DuplicateStamps)
{
	const auto twice = [](CObservation& o, double t_s, RawlogWriter& w)
	{
		w.write(o);
		if (isImu(o) && t_s > 2 && t_s < 2.0101) w.write(o);
	};
	expectFailure(edited(twice), {"IMU: 2 duplicate_stamp", "the rest"});
	expectKept(30);
}

TEST_F(BadInput, OneStampFarOff)
{
	for (const double by_s : {1e6, 1e9, -1.7e9})
		for (const char* label : {"CAM", "IMU", "ODOMETRY"})
		{
			bool done = false;
			const auto spoil = [&](CObservation& o, double t_s, RawlogWriter& w)
			{
				// The first of all, where the clock was not set yet; or one in mid-log.
				if (!done && o.sensorLabel == label && (by_s < 0 || t_s > 1.5)) shiftStamp(o, by_s), done = true;
				w.write(o);
			};
			const std::string path = edited(spoil, 3);
			expectFailure(path, {std::string(label) + ": 1 stamp_jump", "the rest"}, {"--mode", "wio"});
			expectKept(20);
			EXPECT_LT(trajectory("out").size(), 35u);
			EXPECT_EQ(summary("out").at("observations").at(label).at("rejected").at("stamp_jump"), 1);
			std::filesystem::remove(folder_.file("bad_Images"));
		}
}

TEST_F(BadInput, ImuOnItsOwnClock)
{
	const auto spoil = [](CObservation& o, double, RawlogWriter& w)
	{
		if (isImu(o)) shiftStamp(o, -1.6e9);
		w.write(o);
	};
	expectFailure(edited(spoil), {"bad.rawlog", "IMU and ", "different clocks"});
	expectNothingKept();
}

/** Gaps are no failure: they are told, and the run goes on. */
TEST_F(BadInput, GapsAreReported)
{
	const auto gaps = [](CObservation& o, double t_s, RawlogWriter& w)
	{
		if (isImu(o) && t_s > 4 && t_s < 4.3) return;
		if (isOdometry(o) && t_s > 6 && t_s < 8) return;
		if (isImage(o) && t_s > 9 && t_s < 10) return;
		w.write(o);
	};
	const std::string path = edited(gaps, 12);
	const ProgramResult result = runOdometry(path, "out");
	EXPECT_EQ(result.status, 0) << result.err;
	for (const char* part : {"gap of 0.3", "in IMU", "gap of 2.0", "in ODOMETRY", "gap of 1.", "in CAM"})
		EXPECT_NE(result.err.find(part), std::string::npos) << part << " is not in:\n" << result.err;
	EXPECT_EQ(summary("out").at("gaps").size(), 3u);
	const TrajectoryErrors e = errors("out", log_.ground_truth);
	std::cout << "[measured] with gaps: ATE " << 100 * e.ate_xyz_m << " cm of " << e.length_m << " m\n";
	EXPECT_LT(e.ate_xyz_m, 0.05);
}

TEST_F(BadInput, LongGapOfTheImuStartsAnewInTheSameWorld)
{
	const auto gap = [](CObservation& o, double t_s, RawlogWriter& w)
	{
		if (!isImu(o) || t_s < 6 || t_s > 8.5) w.write(o);
	};
	odometry(edited(gap, 14), "out", {"--quiet"});
	EXPECT_GE(summary("out").at("reinitializations").get<int>(), 1);
	const TrajectoryErrors e = errors("out", log_.ground_truth);
	std::cout << "[measured] with 2.5 s without IMU: ATE " << 100 * e.ate_xyz_m << " cm of " << e.length_m << " m\n";
	EXPECT_LT(e.ate_xyz_m, 0.20) << "wheels carry on meanwhile";
}

TEST_F(BadInput, ImuSlowerThanTheCamera)
{
	int sample = 0;
	const auto thin = [&](CObservation& o, double, RawlogWriter& w)
	{
		if (!isImu(o) || sample++ % 40 == 0) w.write(o);
	};
	expectFailure(edited(thin), {"IMU has 5.0 Hz", "camera 10.0 Hz", "faster"});
	expectNothingKept();
}

TEST_F(BadInput, ConfigurationWithMistakes)
{
	const std::string config = folder_.file("c.ini");
	const auto mistake = [&](const std::string& text, const std::vector<std::string>& parts)
	{
		writeFile(config, text);
		expectFailure(log_.rawlog, parts, {"-c", config});
	};
	mistake("[window]\nkeyframs = 10\n", {config, "window", "keyframs", "keyframes"});
	mistake("[window]\nkeyframes = ten\n", {config, "window", "keyframes", "ten"});
	mistake("[window]\nkeyframes = 100000\n", {config, "window", "keyframes", "100000"});
	mistake("[windows]\nkeyframes = 10\n", {config, "windows"});
	mistake("keyframes = 10\n", {config, "keyframes"});
	mistake("[factors]\nslip_gate = perhaps\n", {config, "factors", "slip_gate", "perhaps"});
	expectFailure(log_.rawlog, {"none.ini"}, {"-c", folder_.file("none.ini")});
	expectNothingKept();
}

TEST_F(BadInput, FolderThatCannotBeMade)
{
	writeFile(folder_.file("out"), "a file");
	expectFailure(log_.rawlog, {folder_.file("out"), "-o"}, {"--to", "1"});
}
}  // namespace
}  // namespace viwo::testing
