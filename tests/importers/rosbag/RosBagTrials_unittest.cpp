#include "AllTypesBag.h"
#include "BagFixture.h"
#include "ExpectError.h"

#include <viwo/importers/RecordingInfo.h>

#include <algorithm>

using namespace viwo;
using namespace viwo::testing;

namespace
{
/** Any bytes, as of another release's definition of the type. */
struct ForeignImu
{
	std::vector<uint8_t> bytes;
};
}  // namespace

namespace ros
{
namespace message_traits
{
template <>
struct MD5Sum<ForeignImu>
{
	static const char* value() { return "00000000000000000000000000000000"; }
	static const char* value(const ForeignImu&) { return value(); }
};
template <>
struct DataType<ForeignImu>
{
	static const char* value() { return "sensor_msgs/Imu"; }
	static const char* value(const ForeignImu&) { return value(); }
};
template <>
struct Definition<ForeignImu>
{
	static const char* value() { return "float64 x\n"; }
	static const char* value(const ForeignImu&) { return value(); }
};
}  // namespace message_traits
namespace serialization
{
template <>
struct Serializer<ForeignImu>
{
	static void write(OStream& stream, const ForeignImu& message)
	{
		std::copy(message.bytes.begin(), message.bytes.end(), stream.advance(serializedLength(message)));
	}
	static uint32_t serializedLength(const ForeignImu& message) { return static_cast<uint32_t>(message.bytes.size()); }
};
}  // namespace serialization
}  // namespace ros

namespace
{
/** What a proposed map makes of topics whose first messages are odd. */
class RosBagTrials : public RosBag
{
   protected:
	RecordingInfo inspect() const
	{
		return inspectRecording(path("x.bag"), [](double) { return true; });
	}
	static void writePictures(rosbag::Bag& bag, const std::string& topic, const sensor_msgs::Image& first)
	{
		bag.write(topic, bagTime(0), first);
		bag.write(topic, bagTime(100), imageMessage(100, "cam", "mono8", 1, 1));
	}
	static void writePictures(rosbag::Bag& bag, const std::string& topic)
	{
		writePictures(bag, topic, imageMessage(0, "cam", "mono8", 1, 1));
	}
};

const std::vector<double> kRationalLens{0.1, 0.1, 0, 0, 0.1, 0.1, 0.1, 0.1};

/** A PNG that says to be of another size; the sum of the chunk that says it is made anew. */
std::vector<uint8_t> pngOfSize(uint32_t width, uint32_t height)
{
	std::vector<uint8_t> data;
	cv::imencode(".png", cv::Mat(12, 16, CV_8U, cv::Scalar(7)), data);
	const auto putBigEndian = [&data](size_t at, uint32_t value)
	{
		for (size_t i = 0; i < 4; ++i) data[at + i] = static_cast<uint8_t>(value >> (24 - 8 * i));
	};
	putBigEndian(16, width), putBigEndian(20, height);
	uint32_t crc = ~0u;
	for (size_t at = 12; at < 29; ++at)
	{
		crc ^= data[at];
		for (int bit = 0; bit < 8; ++bit) crc = crc & 1 ? crc >> 1 ^ 0xEDB88320u : crc >> 1;
	}
	putBigEndian(29, ~crc);
	return data;
}

/** First pictures that are none. */
std::vector<sensor_msgs::Image> impossiblePictures()
{
	std::vector<sensor_msgs::Image> pictures(5, imageMessage(0, "cam", "mono8", 1, 1));
	pictures[0].width = pictures[0].height = pictures[0].step = 0, pictures[0].data.clear();
	pictures[1].width = 0xFFFFFFFFu;
	pictures[2].height = 0xFFFFFFFFu, pictures[2].step = 0xFFFFFFFFu;
	pictures[3].step = 15;
	pictures[4].data.pop_back();
	return pictures;
}
}  // namespace

TEST_F(RosBagTrials, TheLensDoesNotMatterToRectifiedPictures)
{
	writeBag(
	    [](rosbag::Bag& bag)
	    {
		    writePictures(bag, "/cam/image_rect");
		    bag.write("/cam/camera_info", bagTime(0), cameraInfoMessage("cam", "rational_polynomial", kRationalLens));
	    });
	import();
	const auto images = observationsOf<mrpt::obs::CObservationImage>(path("x.rawlog"), "CAM");
	ASSERT_EQ(images.size(), 2u);
	EXPECT_EQ(images[0]->cameraParams.fx(), 9) << "of P";
}

TEST_F(RosBagTrials, ACameraInfoIsLeftOutOnlyForThePicturesThatItDoesNotFit)
{
	writeBag(
	    [](rosbag::Bag& bag)
	    {
		    writePictures(bag, "/cam/image_rect");
		    writePictures(bag, "/cam/image_color");
		    bag.write("/cam/camera_info", bagTime(0), cameraInfoMessage("cam", "rational_polynomial", kRationalLens));
	    });
	const ImportResult result = import();
	EXPECT_TRUE(isNote(result, "/cam/camera_info is left out for /cam/image_color: lens model 'rational_polynomial'"));
	EXPECT_FALSE(isNote(result, "/cam/camera_info is left out for /cam/image_rect"));
	EXPECT_EQ(observationsOf<mrpt::obs::CObservationImage>(path("x.rawlog"), "CAM").at(0)->cameraParams.fx(), 0);
	EXPECT_EQ(observationsOf<mrpt::obs::CObservationImage>(path("x.rawlog"), "CAM2").at(0)->cameraParams.fx(), 9);
}

// Of another definition not even the header needs to be at the front.
TEST_F(RosBagTrials, MessagesOfAnotherDefinitionAreCountedByTheRecordersClock)
{
	for (const size_t size : {size_t{0}, size_t{3}, size_t{64}})
	{
		writeBag(
		    [&](rosbag::Bag& bag)
		    {
			    const ForeignImu foreign{std::vector<uint8_t>(size, 0xFF)};
			    for (int i = 0; i < 3; ++i) bag.write("/x", bagTime(100 * i), foreign);
		    });
		const RecordingInfo info = inspect();
		ASSERT_EQ(info.streams.size(), 2u);
		EXPECT_EQ(info.streams[1].name, "/x");
		EXPECT_EQ(info.streams[1].count, 3u);
		EXPECT_EQ(info.streams[1].first_t_ns, at_ns(0));
		EXPECT_EQ(info.streams[1].last_t_ns, at_ns(200));
		EXPECT_TRUE(isNote(import(), "/x (sensor_msgs/Imu) is left out"));
	}
}

TEST_F(RosBagTrials, APictureBeyondOpenCvsLimitsCannotBeDecoded)
{
	const auto write = [this](bool other)
	{
		writeBag(
		    [&](rosbag::Bag& bag)
		    {
			    auto picture = stamped<sensor_msgs::CompressedImage>(0, "cam");
			    picture.data = pngOfSize(100000, 100000);
			    bag.write("/big/image_raw/compressed", bagTime(0), picture);
			    if (other) writePictures(bag, "/cam/image_raw");
		    });
	};
	write(false);
	EXPECT_EQ(inspect().streams.size(), 2u);
	expectError([&] { import(); }, {"/big/image_raw/compressed", "cannot be decoded: damaged", "--map"});
	write(true);
	const ImportResult result = import();
	EXPECT_TRUE(isNote(result, "/big/image_raw/compressed (sensor_msgs/CompressedImage) is left out: its first picture is damaged"));
	EXPECT_EQ(result.images, 2u);
}

TEST_F(RosBagTrials, ADamagedFirstPictureIsLeftOutWhereThereAreOthers)
{
	for (const sensor_msgs::Image& first : impossiblePictures())
	{
		writeBag(
		    [&](rosbag::Bag& bag)
		    {
			    writePictures(bag, "/cam/image_raw");
			    writePictures(bag, "/left/image_raw", first);
		    });
		const ImportResult result = import();
		EXPECT_TRUE(isNote(result, "/left/image_raw (sensor_msgs/Image) is left out: its first picture is damaged or of size 0"));
		EXPECT_EQ(result.images, 2u);
		EXPECT_EQ(observationsOf<mrpt::obs::CObservationImage>(path("x.rawlog"), "CAM").size(), 2u);
	}
}

TEST_F(RosBagTrials, DamagedFirstPicturesAreAnErrorWhereThereAreNoOthers)
{
	for (const sensor_msgs::Image& first : impossiblePictures())
	{
		writeBag(
		    [&](rosbag::Bag& bag)
		    {
			    writePictures(bag, "/left/image_raw", first);
			    writePictures(bag, "/right/image_raw", first);
			    bag.write("/right/camera_info", bagTime(0), cameraInfoMessage("cam", "plumb_bob", {0, 0, 0, 0, 0}));
		    });
		EXPECT_EQ(inspect().streams.size(), 3u);
		expectError([&] { import(); }, {"/image_raw: a picture of", "damaged", "--map"});
	}
}
