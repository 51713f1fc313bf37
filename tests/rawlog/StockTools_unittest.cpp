#include <viwo/rawlog/ObservationAdapter.h>

#include <sstream>

#include "RawlogFixture.h"
#include "RunProgram.h"

using namespace viwo;
using namespace viwo::testing;

namespace
{
/** MRPT's own rawlog-edit on a rawlog of our writer. */
class StockTools : public RawlogTest
{
   protected:
	void SetUp() override
	{
		if (runProgram("sh", {"-c", "command -v rawlog-edit"}).status != 0)
			GTEST_SKIP() << "no rawlog-edit here (Debian package mrpt-apps)";
		writeSecond(path);
	}

	std::string edit(const std::string& arguments)
	{
		// In the rawlog's folder: from elsewhere rawlog-edit 2.5.8 loses the slash between folder and name.
		const auto result = runProgram("sh", {"-c", "cd " + folder.path() + " && rawlog-edit -i test.rawlog " + arguments});
		EXPECT_EQ(result.status, 0) << result.err;
		return result.out;
	}

	static std::vector<std::string> linesOf(const std::string& text)
	{
		std::vector<std::string> lines;
		std::istringstream stream(text);
		for (std::string line; std::getline(stream, line);) lines.push_back(line);
		return lines;
	}

	static std::vector<double> numbersOf(const std::string& line)
	{
		std::istringstream stream(line);
		std::vector<double> numbers;
		for (double x; stream >> x;) numbers.push_back(x);
		return numbers;
	}
};

void expectContains(const std::string& text, const std::string& part)
{
	EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' is not in:\n" << text;
}
}  // namespace

TEST_F(StockTools, Info)
{
	const std::string info = edit("--info");
	expectContains(info, "Overall number of objects         : " + std::to_string(kSecondEntries));
	expectContains(info, "Observations format               : Yes");
	expectContains(info, "All sensor labels                 : CAM, IMU, LMS100, ODOMETRY");
	expectContains(info, "Found external storage directory");
	expectContains(info, "CAM /     10 /10.000");
	expectContains(info, "IMU /    200 /200.000");
}

TEST_F(StockTools, ListImages)
{
	edit("--list-images --text-file-output " + folder.file("images.txt"));
	const auto lines = linesOf(readFile(folder.file("images.txt")));
	ASSERT_EQ(lines.size(), kSecondImages);
	EXPECT_EQ(lines[0], RawlogWriter::imageName("CAM", kStart_ns, "png"));
	for (const auto& line : lines) EXPECT_TRUE(std::filesystem::exists(folder.file("test_Images/" + line))) << line;
}

TEST_F(StockTools, CutIsReadBackWithTheImagesOfTheOriginal)
{
	edit("--cut --from-time 1700000000.3 --to-time 1700000000.6 -o " + folder.file("cut.rawlog"));
	size_t images = 0, imu = 0;
	for (const auto& o : readAll(folder.file("cut.rawlog")))
	{
		const int64_t t_ns = nanosecondsOf(o->timestamp);
		EXPECT_GE(t_ns, 1700000000300000000);
		EXPECT_LE(t_ns, 1700000000600000000);
		if (o->sensorLabel == "IMU") imu++;
		const auto image = std::dynamic_pointer_cast<mrpt::obs::CObservationImage>(o);
		if (!image) continue;
		images++;
		EXPECT_EQ(ImageRef(t_ns, image).grey().getWidth(), 64u);
	}
	EXPECT_EQ(images, 3u);
	EXPECT_EQ(imu, 60u);
}

TEST_F(StockTools, KeepLabel)
{
	edit("--keep-label CAM,ODOMETRY -o " + folder.file("keep.rawlog"));
	RawlogReader reader(folder.file("keep.rawlog"));
	EXPECT_EQ(readAll(reader).size(), kSecondImages + kSecondOdometry);
	EXPECT_EQ(reader.counts().describe(), "CAM (10 CObservationImage), ODOMETRY (20 CObservationOdometry)");
}

TEST_F(StockTools, ExportImu)
{
	edit("--export-imu-txt");
	const auto lines = linesOf(readFile(folder.file("test_IMU.txt")));
	ASSERT_EQ(lines.size(), 1 + kSecondImu);
	expectContains(lines[0], "IMU_WZ");
	const auto row = numbersOf(lines[1]);
	ASSERT_GE(row.size(), 7u);
	const auto sample = imuSample(kStart_ns);
	EXPECT_NEAR(row[0], 1700000000.123457, 1e-6);
	for (int i = 0; i < 3; i++) EXPECT_NEAR(row[static_cast<size_t>(1 + i)], sample.acc_m_s2[i], 1e-8);
	for (int i = 0; i < 3; i++) EXPECT_NEAR(row[static_cast<size_t>(6 - i)], sample.gyro_rad_s[i], 1e-8);
}

TEST_F(StockTools, ExportOdometry)
{
	edit("--export-odometry-txt");
	const auto lines = linesOf(readFile(folder.file("test_ODOMETRY.txt")));
	ASSERT_EQ(lines.size(), 1 + kSecondOdometry);
	const auto row = numbersOf(lines[2]);
	const std::vector<double> expected{1700000000.173457, 0.0075, 0, 0, 1, 50, 100, 1, 0.15, 0, 0.1};
	ASSERT_EQ(row.size(), expected.size());
	for (size_t i = 0; i < row.size(); i++) EXPECT_NEAR(row[i], expected[i], 1e-6) << lines[0];
}
