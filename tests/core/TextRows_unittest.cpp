#include <gtest/gtest.h>
#include <viwo/core/CsvTable.h>
#include <viwo/core/Trajectory.h>

#include "ExpectError.h"
#include "TempFolder.h"

using namespace viwo;
using namespace viwo::testing;

namespace
{
using Rows = std::vector<std::vector<std::string>>;

Rows rowsOf(const std::string& content, TextRows::Split split)
{
	const TempFolder folder;
	writeFile(folder.file("t"), content);
	TextRows rows(folder.file("t"), split);
	Rows all;
	while (rows.next()) all.push_back(rows.words());
	return all;
}
}  // namespace

TEST(TextRows, ThreeWaysToSplit)
{
	EXPECT_EQ(rowsOf("a  b\tc\n# x\n\n d\n", TextRows::Split::blanks), (Rows{{"a", "b", "c"}, {"d"}}));
	EXPECT_EQ(rowsOf("a, b,,c\n", TextRows::Split::commas_and_blanks), (Rows{{"a", "b", "c"}}));
	EXPECT_EQ(rowsOf("a, b c,,d,\n", TextRows::Split::cells), (Rows{{"a", "b c", "", "d", ""}}));
}

TEST(TextRows, FilesOfWindowsEditors)
{
	for (const auto split : {TextRows::Split::blanks, TextRows::Split::cells})
		EXPECT_EQ(rowsOf("\xEF\xBB\xBF#c\r\na\r\n\r\nb\r\n", split), (Rows{{"a"}, {"b"}}));
	EXPECT_EQ(rowsOf("\xEF\xBB\xBF"
	                 "a\n",
	                 TextRows::Split::blanks),
	          (Rows{{"a"}}));
	const TempFolder folder;
	writeFile(folder.file("t.tum"),
	          "\xEF\xBB\xBF"
	          "1 2 3 4 0 0 0 1\r\n2 2 3 5 0 0 0 1\r\n");
	EXPECT_EQ(Trajectory::loadTum(folder.file("t.tum")).poses()[1].T.p.z(), 5);
	writeFile(folder.file("t.csv"), "\xEF\xBB\xBFt_s,flag\r\n1.5,good\r\n");
	CsvTable table(folder.file("t.csv"), {"flag", "t_s"});
	ASSERT_TRUE(table.next());
	EXPECT_EQ(table.cell(0), "good");
	EXPECT_EQ(table.seconds_ns(1), 1'500'000'000);
}

TEST(TextRows, SaysWhichLineIsWrong)
{
	const TempFolder folder;
	const auto atThirdLine = [&](const std::string& line)
	{
		writeFile(folder.file("t"), "# first\n1 0 0 0\n" + line + "\n");
		TextRows rows(folder.file("t"), TextRows::Split::blanks);
		while (rows.next())
		{
			rows.expectWords(4, false, "w x y z");
			rows.rotation(0, 1, 2, 3);
			rows.integer(1);
			rows.seconds_ns(0);
		}
	};
	EXPECT_NO_THROW(atThirdLine("+1 0 0 0"));
	expectError([&] { atThirdLine("1 0 0"); }, {"t:3", "3 columns", "4", "w x y z"});
	expectError([&] { atThirdLine("1 0 0 nan"); }, {"t:3", "'nan'", "finite"});
	expectError([&] { atThirdLine("1 0 0 0x1"); }, {"t:3", "'0x1'"});
	expectError([&] { atThirdLine("2 0 0 0"); }, {"t:3", "columns 1 to 4", "unit length"});
	expectError([&] { atThirdLine("1 0.0 0 0"); }, {"t:3", "'0.0'", "whole number"});
	writeFile(folder.file("t"), "");
	expectError([&] { TextRows(folder.file("t"), TextRows::Split::blanks); }, {"t: ", "empty"});
	expectError([&] { TextRows(folder.file("absent"), TextRows::Split::blanks); }, {"absent: cannot read"});
	writeFile(folder.file("t"), "# only\n");
	expectError([&] { CsvTable(folder.file("t"), {"a"}); }, {"names the columns"});
	writeFile(folder.file("t"), "a,b\n1\n");
	CsvTable table(folder.file("t"), {"b"});
	expectError([&] { table.next(); }, {"t:2", "1 cell in"});
}
