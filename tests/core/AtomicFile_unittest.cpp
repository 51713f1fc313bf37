#include <gtest/gtest.h>
#include <unistd.h>
#include <viwo/core/AtomicFile.h>

#include "ExpectError.h"
#include "TempFolder.h"

using namespace viwo;
using viwo::testing::expectError;
using viwo::testing::readFile;
using viwo::testing::TempFolder;
using viwo::testing::writeFile;
namespace fs = std::filesystem;

namespace
{
size_t countFiles(const TempFolder& folder)
{
	return static_cast<size_t>(std::distance(fs::directory_iterator(folder.path()), {}));
}
}  // namespace

TEST(AtomicFile, AppearsOnlyWithCommit)
{
	TempFolder folder;
	AtomicFile file(folder.file("a.txt"));
	file.stream() << "content";
	EXPECT_FALSE(fs::exists(folder.file("a.txt")));
	file.commit();
	EXPECT_EQ(readFile(folder.file("a.txt")), "content");
	EXPECT_EQ(countFiles(folder), 1u);
}

TEST(AtomicFile, WithoutCommitTheOldOneStays)
{
	TempFolder folder;
	writeFile(folder.file("a.txt"), "old");
	{
		AtomicFile file(folder.file("a.txt"));
		file.stream() << "new";
	}
	EXPECT_EQ(readFile(folder.file("a.txt")), "old");
	EXPECT_EQ(countFiles(folder), 1u);
}

TEST(AtomicFile, TwoWritersDoNotMix)
{
	TempFolder folder;
	writeFile(folder.file("a.txt.part"), "left behind by a program that was killed");
	AtomicFile file(folder.file("a.txt"));
	file.stream() << "first";
	expectError([&] { AtomicFile(folder.file("a.txt")); }, {folder.file("a.txt"), "another program is writing"});
	file.commit();
	EXPECT_EQ(readFile(folder.file("a.txt")), "first");
	AtomicFile next(folder.file("a.txt"));
	next.commit();
	EXPECT_EQ(countFiles(folder), 1u);
}

TEST(AtomicFile, ATrialLeavesNothingAndKeepsWhatIsThere)
{
	const TempFolder folder;
	requireWritable(folder.file("a.txt"));
	EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
	writeAtomically(folder.file("a.txt"), "old");
	requireWritable(folder.file("a.txt"));
	EXPECT_EQ(readFile(folder.file("a.txt")), "old");
	requireWritable("/dev/full");
	expectError([&] { requireWritable(folder.file("none/a.txt")); }, {"none/a.txt", "there is no folder"});
	expectError([&] { requireWritable(folder.path()); }, {"is a folder"});
}

TEST(AtomicFile, MissingFolderOrFolderAsName)
{
	TempFolder folder;
	expectError([&] { AtomicFile(folder.file("no/a.txt")); }, {folder.file("no/a.txt"), "no folder"});
	expectError([&] { AtomicFile(folder.path()); }, {folder.path(), "is a folder"});
	writeFile(folder.file("plain"), "");
	expectError([&] { AtomicFile(folder.file("plain/a.txt")); }, {folder.file("plain/a.txt"), "no folder"});
}

TEST(AtomicFile, UnwritableFolder)
{
	TempFolder folder;
	// The name of the temporary file is taken by a folder: cannot be opened even by root, whom permissions do not bind.
	fs::create_directory(folder.file("a.txt.part"));
	expectError([&] { AtomicFile(folder.file("a.txt")); }, {folder.file("a.txt"), "cannot write"});
	if (geteuid() == 0) return;
	fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
	expectError([&] { AtomicFile(folder.file("b.txt")); }, {folder.file("b.txt"), "permission"});
	fs::permissions(folder.path(), fs::perms::owner_all);
}

TEST(AtomicFile, FullDisk)
{
	if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
	AtomicFile file("/dev/full");
	file.stream() << "content";
	expectError([&] { file.commit(); }, {"/dev/full", "cannot write"});
	EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST(AtomicFile, DevicesAndLinksStayWhatTheyAre)
{
	AtomicFile null("/dev/null");
	null.stream() << "x";
	null.commit();
	EXPECT_TRUE(fs::is_character_file("/dev/null"));

	TempFolder folder;
	writeFile(folder.file("target"), "old");
	fs::create_symlink(folder.file("target"), folder.file("link"));
	AtomicFile file(folder.file("link"));
	file.stream() << "new";
	file.commit();
	EXPECT_TRUE(fs::is_symlink(folder.file("link")));
	EXPECT_EQ(readFile(folder.file("target")), "new");
}
