#include <viwo/rawlog/ObservationAdapter.h>

#include "ExpectError.h"
#include "RawlogFixture.h"

using namespace viwo;
using namespace viwo::testing;
using namespace mrpt::obs;
namespace fs = std::filesystem;

namespace
{
class ExternalImages : public RawlogTest
{
   protected:
	void SetUp() override { writeSecond(path); }

	static std::vector<CObservationImage::Ptr> imagesOf(const std::string& rawlog)
	{
		RawlogReaderOptions options;
		options.labels = {"CAM"};
		std::vector<CObservationImage::Ptr> images;
		for (const auto& o : readAll(rawlog, options)) images.push_back(std::dynamic_pointer_cast<CObservationImage>(o));
		return images;
	}

	void expectImages(const std::string& rawlog, const std::string& images_folder)
	{
		const auto images = imagesOf(rawlog);
		ASSERT_EQ(images.size(), kSecondImages);
		for (const auto& image : images)
		{
			EXPECT_EQ(fs::path(image->image.getExternalStorageFileAbsolutePath()).parent_path().string(), images_folder);
			const auto grey = ImageRef(0, image).grey();
			EXPECT_EQ(grey.at<uint8_t>(10, 20), 40 + 2 * 10 + 20);
		}
	}

	std::string firstImage() const { return RawlogWriter::imageName("CAM", kStart_ns, "png"); }
};
}  // namespace

TEST_F(ExternalImages, FoundBesideTheRawlog)
{
	expectImages(path, folder.file("test_Images"));
}

TEST_F(ExternalImages, FoundFromARelativePath)
{
	const auto here = fs::current_path();
	fs::current_path(folder.path());
	expectImages("test.rawlog", folder.file("test_Images"));
	fs::current_path(here);
}

TEST_F(ExternalImages, ACutRawlogUsesTheFolderOfTheOriginal)
{
	fs::copy(path, folder.file("cut.rawlog"));
	fs::create_directory(folder.file("another_Images"));
	expectImages(folder.file("cut.rawlog"), folder.file("test_Images"));
}

TEST_F(ExternalImages, OfTwoFoldersTheOneThatNamesTheRawlog)
{
	fs::copy(folder.file("test_Images"), folder.file("aaa_Images"));
	fs::copy(path, folder.file("test_cut.rawlog"));
	expectImages(folder.file("test_cut.rawlog"), folder.file("test_Images"));
	fs::copy(path, folder.file("cut.rawlog"));
	expectError([&] { imagesOf(folder.file("cut.rawlog")); }, {"aaa_Images", "test_Images", folder.file("cut_Images")});
}

TEST_F(ExternalImages, NoFolderSaysWhatToCopy)
{
	fs::create_directory(folder.file("elsewhere"));
	const std::string cut = folder.file("elsewhere/cut.rawlog");
	fs::copy(path, cut);
	expectError([&] { imagesOf(cut); }, {cut, firstImage(), "copy", folder.file("elsewhere/cut_Images")});
}

TEST_F(ExternalImages, MissingFileIsAnErrorAtItsTurnAndReadingGoesOn)
{
	const std::string missing = RawlogWriter::imageName("CAM", kStart_ns + 300 * kMillisecond_ns, "png");
	fs::remove(folder.file("test_Images/" + missing));
	RawlogReader reader(path);
	const auto before = readUntilError(reader);
	EXPECT_NE(before.error.find(missing), std::string::npos) << before.error;
	EXPECT_NE(before.error.find(path), std::string::npos) << before.error;
	EXPECT_EQ(before.error.find('\n'), std::string::npos) << before.error;
	ASSERT_FALSE(before.observations.empty());
	EXPECT_EQ(nanosecondsOf(before.observations.back()->timestamp), kStart_ns + 300 * kMillisecond_ns)
	    << "all that comes before it was delivered";
	const auto after = readUntilError(reader);
	EXPECT_EQ(after.error, "");
	EXPECT_EQ(before.observations.size() + after.observations.size() + 1, kSecondEntries);

	RawlogReaderOptions options;
	options.skip_missing_images = true;
	RawlogReader tolerant(path, options);
	EXPECT_EQ(readAll(tolerant).size(), kSecondEntries - 1);
	EXPECT_EQ(tolerant.counts().sensors.at({"CAM", "CObservationImage"}).missing_images, 1u);
}

TEST_F(ExternalImages, OtherLabelsNeedNoImages)
{
	fs::remove_all(folder.file("test_Images"));
	RawlogReaderOptions options;
	options.labels = {"IMU"};
	EXPECT_EQ(readAll(path, options).size(), kSecondImu);
}

TEST_F(ExternalImages, AbsoluteNamesAndMovedOnes)
{
	const std::string absolute = folder.file("far.png"), moved = folder.file("gone/near.png");
	gradientImage().saveToFile(absolute);
	gradientImage().saveToFile(folder.file("test_Images/near.png"));
	RawlogWriter writer(path);
	writer.write(makeImage(kStart_ns, smallCamera(), Pose3(), absolute));
	writer.write(makeImage(kStart_ns + 1000, smallCamera(), Pose3(), moved));
	writer.close();
	const auto images = imagesOf(path);
	ASSERT_EQ(images.size(), 2u);
	EXPECT_EQ(images[0]->image.getExternalStorageFile(), absolute);
	EXPECT_EQ(images[1]->image.getExternalStorageFile(), folder.file("test_Images/near.png"));
}

TEST_F(ExternalImages, GreyChecksWhatItDecodes)
{
	const auto first = imagesOf(path).front();
	writeFile(folder.file("test_Images/" + firstImage()), "no image");
	expectError([&] { ImageRef(kStart_ns, first).grey(); }, {firstImage(), "cannot be decoded"});
	fs::remove(folder.file("test_Images/" + firstImage()));
	expectError([&] { ImageRef(kStart_ns, first).grey(); }, {firstImage(), "missing"});
	gradientImage(32, 48).saveToFile(folder.file("test_Images/" + firstImage()));
	expectError([&] { ImageRef(kStart_ns, first).grey(); }, {firstImage(), "32 x 48", "64 x 48"});
}

TEST_F(ExternalImages, EmbeddedAndColourImages)
{
	mrpt::img::CImage colour(64, 48, mrpt::img::CH_RGB);
	colour.filledRectangle(0, 0, 63, 47, mrpt::img::TColor(90, 90, 90));
	RawlogWriter writer(path);
	writer.write(makeEmbeddedImage(kStart_ns, smallCamera(), Pose3(), gradientImage()));
	writer.write(makeEmbeddedImage(kStart_ns + 1000, smallCamera(), Pose3(), colour));
	writer.write(makeEmbeddedImage(kStart_ns + 2000, smallCamera(), Pose3(), mrpt::img::CImage()));
	writer.close();
	const auto images = imagesOf(path);
	ASSERT_EQ(images.size(), 3u);
	EXPECT_NEAR(ImageRef(0, images[0]).grey().at<uint8_t>(10, 20), 80, 4);
	const auto grey = ImageRef(0, images[1]).grey();
	EXPECT_FALSE(grey.isColor());
	EXPECT_NEAR(grey.at<uint8_t>(10, 20), 90, 2);
	expectError([&] { ImageRef(kStart_ns, images[2]).grey(); }, {"embedded", "cannot be decoded"});
}
