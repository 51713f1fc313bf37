#include "ExpectError.h"
#include "RunProgram.h"
#include "TempFolder.h"
#include "TestBag.h"

#include <viwo/importers/RosBagImporter.h>

#include <filesystem>

using namespace viwo;
using namespace viwo::testing;

namespace
{
class BadBags : public ::testing::Test
{
   protected:
	std::string path(const std::string& name) const { return folder_.file(name); }
	size_t import(const std::string& bag) { return importRosBags({"", path("x.rawlog")}, {{path(bag)}, {}, false}).odometry_samples; }
	void expectRefused(const std::string& bag, std::initializer_list<std::string> parts)
	{
		expectError([&] { import(bag); }, parts);
		EXPECT_FALSE(std::filesystem::exists(path("x.rawlog")));
	}

	TempFolder folder_;
};

std::string littleEndian(uint64_t value, int bytes)
{
	std::string text;
	for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> (8 * i) & 0xFF);
	return text;
}

/** A bag's header record as rosbag writes it: fields, then blanks up to 4096 bytes. */
std::string headerRecord(uint64_t index_at, const std::string& encryptor)
{
	std::string fields;
	for (const std::string& field : {"encryptor=" + encryptor, "index_pos=" + littleEndian(index_at, 8), std::string("op=\x03")})
		fields += littleEndian(field.size(), 4) + field;
	return "#ROSBAG V2.0\n" + littleEndian(fields.size(), 4) + fields + littleEndian(100, 4) + std::string(100, ' ');
}
}  // namespace

TEST_F(BadBags, CompressedOnesAreRead)
{
	for (const auto compression : {rosbag::compression::Uncompressed, rosbag::compression::BZ2, rosbag::compression::LZ4})
	{
		writeOdometryBag(path("x.bag"), 200, compression);
		EXPECT_EQ(import("x.bag"), 200u);
	}
}

TEST_F(BadBags, OthersAreRefusedInOneLine)
{
	expectRefused("absent.bag", {"absent.bag", "cannot be read"});
	expectRefused("", {"a folder"});
	writeFile(path("empty.bag"), "");
	expectRefused("empty.bag", {"empty.bag", "empty file"});
	writeFile(path("text.bag"), "hello, this is not a bag at all");
	expectRefused("text.bag", {"not a ROS bag"});
	writeFile(path("old.bag"), "#ROSBAG V1.2\nxyz");
	expectRefused("old.bag", {"old format", "rosbag fix"});
	writeFile(path("ros2.db3"), std::string("SQLite format 3\0xxxxxxxxxxxxx", 28));
	expectRefused("ros2.db3", {"ROS 2", "sqlite3", "rosbags-convert"});
	writeFile(path("ros2.mcap"), "\x89MCAP0\r\n and so on");
	expectRefused("ros2.mcap", {"ROS 2", "MCAP", "rosbags-convert"});
	write(folder_, "ros2/metadata.yaml", "rosbag2_bagfile_information:\n");
	expectRefused("ros2", {"ROS 2", "metadata.yaml", "rosbags-convert"});
	writeFile(path("secret.bag"), headerRecord(20, "rosbag/AesCbcEncryptor"));
	expectRefused("secret.bag", {"encrypted", "AesCbcEncryptor", "rosbag decrypt"});
	writeFile(path("active.bag"), headerRecord(0, ""));
	expectRefused("active.bag", {"unindexed", "rosbag reindex"});
}

// Cut anywhere, a bag is refused, and never crashes.
TEST_F(BadBags, TruncatedAnywhere)
{
	writeOdometryBag(path("whole.bag"), 100);
	const std::string bytes = readFile(path("whole.bag"));
	for (size_t size = 1; size < bytes.size(); size += 397)
	{
		writeFile(path("cut.bag"), bytes.substr(0, size));
		expectRefused("cut.bag", {"cut.bag: "});
	}
	writeFile(path("cut.bag"), bytes.substr(0, bytes.size() / 2));
	expectRefused("cut.bag", {"truncated", "rosbag reindex"});
}

TEST_F(BadBags, NothingToImport)
{
	{
		rosbag::Bag bag(path("x.bag"), rosbag::bagmode::Write);
		tf2_msgs::TFMessage frames;
		frames.transforms = {transform("a", "b", {})};
		bag.write("/tf", bagTime(0), frames);
		bag.close();
	}
	expectRefused("x.bag", {"no topic can become an observation", "/tf (tf2_msgs/TFMessage)"});
	{
		rosbag::Bag bag(path("x.bag"), rosbag::bagmode::Write);
		bag.write("/cam/image_raw", bagTime(0), imageMessage(0, "cam", "32FC1", 1, 4));
		bag.close();
	}
	expectRefused("x.bag", {"/cam/image_raw", "32FC1", "--map"});
}
