#include "AllTypesBag.h"
#include "ExpectError.h"
#include "RunProgram.h"
#include "TempFolder.h"

#include <viwo/importers/RosBagImporter.h>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <map>
#include <random>

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

/** Import in a process of its own. @return 0, or 1 where an Error says what is wrong; all else is none of what a user should see. */
int statusOfImport(const std::string& bag, const std::string& rawlog)
{
	const pid_t child = fork();
	if (child == 0)
	{
#ifndef __SANITIZE_ADDRESS__
		// Lengths of gigabytes are to be refused before room is made for them.
		const rlimit memory{rlim_t{1} << 30, rlim_t{1} << 30};
		setrlimit(RLIMIT_AS, &memory);
#endif
		try
		{
			importRosBags({"", rawlog}, {{bag}, {}, false});
		}
		catch (const Error&)
		{
			_exit(1);
		}
		catch (...)
		{
			_exit(2);
		}
		_exit(0);
	}
	int status = 0;
	waitpid(child, &status, 0);
	return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

// Bytes that were changed, in messages, records and index, of plain and compressed chunks: an import or one line, never a crash.
TEST_F(BadBags, DamagedBytes)
{
	// A child has none of its parent's threads, and would wait for OpenCV's.
	cv::setNumThreads(1);
	const char* const wanted = std::getenv("VIWO_DAMAGED_BAGS");
	const int cases = wanted != nullptr ? std::atoi(wanted) : 40;
	std::mt19937 generator(1);
	const auto upTo = [&generator](size_t n) { return std::uniform_int_distribution<size_t>(0, n - 1)(generator); };
	for (const auto compression : {rosbag::compression::Uncompressed, rosbag::compression::LZ4, rosbag::compression::BZ2})
	{
		writeBagOfAllTypes(path("whole.bag"), compression);
		const std::string bytes = readFile(path("whole.bag"));
		std::map<int, int> seen;
		for (int i = 0; i < cases; ++i)
		{
			std::string damaged = bytes;
			const size_t at = i % 3 == 0 ? upTo(bytes.size() - 8) : bytes.size() - 8 - upTo(i % 3 == 1 ? 6000 : bytes.size() - 8);
			const size_t count = 1 + upTo(4);
			for (size_t k = 0; k < count; ++k) damaged[at + k] = upTo(2) == 0 ? '\xFF' : static_cast<char>(upTo(256));
			writeFile(path("damaged.bag"), damaged);
			const int status = statusOfImport(path("damaged.bag"), path("x.rawlog"));
			++seen[status];
			EXPECT_LE(status, 1) << "case " << i << ": " << count << " bytes at " << at << " of " << bytes.size();
		}
		std::cout << "[measured] compression " << compression << ": " << seen[0] << " imported, " << seen[1] << " refused\n";
		EXPECT_GT(seen[1], cases / 20);
	}
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
