#include "ExpectError.h"
#include "TempFolder.h"

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <viwo/mapping/OctoMapRun.h>
#include <viwo/rawlog/MrptTime.h>
#include <viwo/rawlog/RawlogWriter.h>

#include <gtest/gtest.h>

#include <filesystem>

namespace viwo
{
namespace
{
using namespace testing;

/** A wall 2 m ahead, its range image in a file of its own in `x_Images/`. */
OctoMapRunOptions wallInAFile(const TempFolder& folder)
{
	constexpr int64_t kStamp_ns = 1'700'000'000'000'000'000;
	RawlogWriter writer(folder.file("x.rawlog"));
	mrpt::obs::CObservation3DRangeScan image;
	image.sensorLabel = "DEPTH";
	image.timestamp = mrptTime(kStamp_ns);
	image.hasRangeImage = true;
	image.rangeImage_setSize(30, 40);
	image.rangeImage.fill(2000);
	image.cameraParams.nrows = 30;
	image.cameraParams.ncols = 40;
	image.cameraParams.setIntrinsicParamsFromValues(40, 40, 20, 15);
	image.rangeImage_convertToExternalStorage("depth_1.bin", writer.imagesFolder());
	writer.write(image);
	writer.close();
	writeFile(folder.file("pose.tum"), "1700000000 0 0 0 0 0 0 1\n");
	OctoMapRunOptions options;
	options.rawlog = folder.file("x.rawlog");
	options.trajectory = folder.file("pose.tum");
	options.output = folder.file("m.bt");
	return options;
}
}  // namespace

TEST(ExternalDepth, IsFoundBesideTheRawlog)
{
	const TempFolder folder;
	const OctoMapRunResult result = runOctoMap(wallInAFile(folder));
	EXPECT_EQ(result.rays, 1200u);
	EXPECT_GT(result.occupied, 400u);
}

TEST(ExternalDepth, MissingIsOneLine)
{
	const TempFolder folder;
	const OctoMapRunOptions options = wallInAFile(folder);
	std::filesystem::remove_all(folder.file("x_Images"));
	expectError([&] { runOctoMap(options); }, {"DEPTH", "1700000000.000000000", "depth_1.bin", "_Images"});
	EXPECT_FALSE(std::filesystem::exists(options.output));
}
}  // namespace viwo
