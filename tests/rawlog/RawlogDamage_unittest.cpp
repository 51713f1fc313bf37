#include <mrpt/poses/CPose2D.h>

#include <cmath>
#include <filesystem>

#include "ExpectError.h"
#include "RawlogFixture.h"

using namespace viwo;
using namespace viwo::testing;
using namespace mrpt::obs;

namespace
{
class RawlogDamage : public RawlogTest
{
   protected:
	void expectBadFile(const std::string& content, std::initializer_list<std::string> parts)
	{
		writeFile(path, content);
		expectError(
		    [&]
		    {
			    RawlogReader reader(path);
			    readAll(reader);
		    },
		    parts);
	}
};

PlainRawlog threeReadings()
{
	PlainRawlog plain;
	for (int i = 0; i < 3; i++) plain << makeOdometry(kStart_ns + i * kMillisecond_ns, {});
	return plain;
}

std::string replaced(std::string text, const std::string& from, const std::string& to)
{
	text.replace(text.rfind(from), from.size(), to);
	return text;
}
}  // namespace

TEST_F(RawlogDamage, MissingEmptyOrSomethingElse)
{
	expectError([&] { RawlogReader(folder.file("none.rawlog")); }, {folder.file("none.rawlog"), "no such file"});
	expectError([&] { RawlogReader(folder.path()); }, {folder.path(), "folder"});
	for (const auto& [sensor, layout] : {std::pair("mav0", "euroc"), std::pair("oxts", "kitti")})
	{
		const std::string recording = folder.file(layout);
		std::filesystem::create_directories(std::filesystem::path(recording) / sensor);
		expectError([&] { RawlogReader reader(recording); }, {recording, std::string("viwo-import ") + layout + " " + recording});
	}
	expectBadFile("", {path, "empty"});
	expectBadFile("This is a text, and a long one it is, longer than any name of a class of MRPT could ever be, with blanks and all.\n",
	              {path, "not a rawlog"});
	expectBadFile("\x89PNG\r\n\x1a\n and so on", {path, "not a rawlog"});
	expectBadFile(std::string(1000, '\0'), {path, "not a rawlog"});
	expectBadFile(std::string("\x28\xB5\x2F\xFD\x04\x00more", 10), {path, "zstd"});
	expectBadFile("#ROSBAG V2.0\nE\0", {path, "a ROS bag", "viwo-import rosbag " + path, ".rawlog"});
	expectBadFile(std::string("PK\x03\x04\x14\x00more", 10), {path, "zip", "unzip"});
	PlainRawlog pose;
	pose << mrpt::poses::CPose2D(1, 2, 3);
	expectBadFile(pose.bytes(), {path, "not a rawlog", "CPose2D"});
}

TEST_F(RawlogDamage, GzipOfNothing)
{
	RawlogWriter(path).close();
	expectError([&] { RawlogReader reader(path); }, {path, "no entries"});
}

TEST_F(RawlogDamage, TruncatedPlainFileAtEveryByte)
{
	const std::string whole = threeReadings().bytes();
	ASSERT_EQ(whole.size() % 3, 0u);
	const size_t entry_bytes = whole.size() / 3;
	for (size_t cut = 1; cut < whole.size(); cut++)
	{
		writeFile(path, whole.substr(0, cut));
		RawlogReader reader(path);
		const auto read = readUntilError(reader);
		const size_t entries = cut / entry_bytes;
		EXPECT_EQ(read.observations.size(), entries) << cut;
		EXPECT_EQ(reader.counts().entries, entries);
		// A cut between two entries leaves a shorter, whole rawlog.
		const bool is_whole = cut % entry_bytes == 0;
		EXPECT_EQ(reader.truncated(), !is_whole) << cut;
		EXPECT_EQ(read.error.empty(), is_whole) << read.error;
		if (is_whole) continue;
		EXPECT_NE(read.error.find("truncated"), std::string::npos) << read.error;
		EXPECT_NE(read.error.find("after " + std::to_string(entries) + (entries == 1 ? " entry" : " entries")), std::string::npos)
		    << read.error;
		EXPECT_EQ(reader.next(), nullptr);
	}
}

TEST_F(RawlogDamage, TruncatedGzipDeliversWhatWasRead)
{
	const std::string whole = secondBytes();
	std::vector<size_t> cuts{20, 100};
	for (int i = 1; i < 20; i++) cuts.push_back(whole.size() * static_cast<size_t>(i) / 20);
	for (size_t i = 9; i >= 1; i--) cuts.push_back(whole.size() - i);
	size_t last = 0;
	for (size_t cut : cuts)
	{
		writeFile(path, whole.substr(0, cut));
		RawlogReader reader(path);
		const auto read = readUntilError(reader);
		EXPECT_NE(read.error.find("truncated"), std::string::npos) << "cut at " << cut << " of " << whole.size() << ": " << read.error;
		EXPECT_NE(read.error.find(path), std::string::npos);
		EXPECT_EQ(read.observations.size(), reader.counts().entries);
		EXPECT_GE(read.observations.size(), last);
		last = read.observations.size();

		RawlogReaderOptions options;
		options.allow_truncated = true;
		RawlogReader tolerant(path, options);
		EXPECT_EQ(readAll(tolerant).size(), last);
		EXPECT_TRUE(tolerant.truncated());
	}
	EXPECT_EQ(last, kSecondEntries) << "only the gzip trailer is cut";
}

TEST_F(RawlogDamage, FlippedByteIsNeverPassedOver)
{
#ifdef __SANITIZE_ADDRESS__
	GTEST_SKIP() << "a damaged length makes MRPT ask for terabytes: std::bad_alloc in an ordinary build, the end in this one";
#endif
	const std::string whole = secondBytes();
	int damaged = 0;
	for (int i = 1; i < 10; i++)
	{
		std::string bytes = whole;
		char& byte = bytes[whole.size() * static_cast<size_t>(i) / 10];
		byte = static_cast<char>(byte ^ 0x55);
		writeFile(path, bytes);
		RawlogReaderOptions options;
		options.allow_truncated = true;
		RawlogReader reader(path, options);
		const auto read = readUntilError(reader);
		EXPECT_TRUE(!read.error.empty() || reader.truncated()) << i;
		if (read.error.find("damaged") != std::string::npos) damaged++;
	}
	EXPECT_GE(damaged, 5);
}

TEST_F(RawlogDamage, UnknownClassIsNamed)
{
	const std::string whole = threeReadings().bytes();
	writeFile(path, replaced(whole, "CObservationOdometry", "CObservationTelepath"));
	RawlogReader reader(path);
	const auto read = readUntilError(reader);
	EXPECT_EQ(read.observations.size(), 2u);
	for (const char* part : {"unknown class", "CObservationTelepath", "after 2 entries"})
		EXPECT_NE(read.error.find(part), std::string::npos) << read.error;
	EXPECT_EQ(read.error.find('\n'), std::string::npos) << read.error;
	EXPECT_FALSE(reader.truncated());
	EXPECT_EQ(reader.next(), nullptr);
}

TEST_F(RawlogDamage, UnknownClassInsideOfASensoryFrame)
{
	CSensoryFrame frame;
	frame.insert(std::make_shared<CObservationOdometry>(makeOdometry(kStart_ns, {})));
	PlainRawlog plain;
	plain << makeOdometry(kStart_ns, {}) << frame;
	writeFile(path, replaced(plain.bytes(), "CObservationOdometry", "CObservationTelepath"));
	RawlogReader reader(path);
	const auto read = readUntilError(reader);
	EXPECT_EQ(read.observations.size(), 1u);
	for (const char* part : {"unknown class", "CObservationTelepath", "after 1 entry"})
		EXPECT_NE(read.error.find(part), std::string::npos) << read.error;
}

TEST_F(RawlogDamage, GarbageBetweenEntries)
{
	std::string bytes = threeReadings().bytes() + "?? garbage, then more";
	writeFile(path, bytes);
	RawlogReader reader(path);
	const auto read = readUntilError(reader);
	EXPECT_EQ(read.observations.size(), 3u);
	EXPECT_NE(read.error.find("damaged after 3 entries"), std::string::npos) << read.error;
}
