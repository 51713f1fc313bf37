#include <gtest/gtest.h>

#include "Shell.h"

namespace viwo::testing
{
namespace
{
const std::string kAgain = "; make it anew with: cmake --build build --target documents";

std::string pagePath(const std::string& program)
{
	return VIWO_SOURCE_DIR "/doc/man/" + program + ".1";
}

std::string told(const std::string& program, const std::string& option)
{
	const ProgramResult result = runProgram(VIWO_BINARY_DIR "/bin/" + program, {option});
	EXPECT_EQ(result.status, 0) << program << " " << option << ": " << result.err;
	return result.out;
}

/** A slim system has a man that only says so. */
bool manShowsPages()
{
	return bash("man -w man-nothing-like-this 2>&1 | grep -q 'No manual entry' && command -v groff").status == 0;
}
}  // namespace

TEST(ManPages, AreWhatTheProgramsSay)
{
	ASSERT_GE(allPrograms().size(), 11u);
	for (const std::string& program : allPrograms())
		EXPECT_TRUE(readFile(pagePath(program)) == told(program, "--print-man")) << "doc/man/" << program << ".1 is out of date" << kAgain;
	for (const auto& entry : std::filesystem::directory_iterator(VIWO_SOURCE_DIR "/doc/man"))
		EXPECT_TRUE(std::filesystem::exists(VIWO_SOURCE_DIR "/apps/" + entry.path().stem().string())) << entry.path() << " has no program";
}

TEST(ManPages, CompletionIsWhatTheProgramsSay)
{
	const std::string kept = readFile(VIWO_SOURCE_DIR "/share/bash-completion/viwo");
	const std::string engine = readFile(VIWO_SOURCE_DIR "/apps/support/completion.bash");
	EXPECT_EQ(kept.compare(0, engine.size(), engine), 0) << "share/bash-completion/viwo is out of date" << kAgain;
	size_t tables = 0;
	for (const std::string& program : allPrograms())
	{
		const std::string table = told(program, "--print-completion");
		tables += table.size();
		EXPECT_NE(kept.find(table), std::string::npos) << "share/bash-completion/viwo is out of date for " << program << kAgain;
	}
	EXPECT_EQ(kept.size(), engine.size() + tables) << "share/bash-completion/viwo is out of date" << kAgain;
}

TEST(ManPages, RenderWithoutWarnings)
{
	if (!manShowsPages()) GTEST_SKIP() << "man or groff is not here (package man-db)";
	for (const std::string& program : allPrograms())
	{
		const ProgramResult result = bash(
		    "MANWIDTH=80 MANROFFSEQ='' man --warnings=w -E UTF-8 -l -Tutf8 -Z \"$1\" >/dev/null && groff -man -ww -K utf8 -Tutf8 -z \"$1\"",
		    {pagePath(program)});
		EXPECT_EQ(result.status, 0) << program;
		EXPECT_EQ(result.err, "") << program;
	}
}

/** "man ./doc/man/X.1" shows each option that --help shows. */
TEST(ManPages, ShowEachOption)
{
	if (!manShowsPages()) GTEST_SKIP() << "man is not here (package man-db)";
	for (const std::string& program : allPrograms())
	{
		const ProgramResult page = bash("cd \"$1\" && MANWIDTH=200 man \"./doc/man/$2.1\" | col -bx", {VIWO_SOURCE_DIR, program});
		ASSERT_EQ(page.status, 0) << page.err;
		for (const char* part : {"NAME", "SYNOPSIS", "DESCRIPTION", "OPTIONS", "EXAMPLES", "EXIT STATUS", "SEE ALSO"})
			EXPECT_NE(page.out.find("\n" + std::string(part) + "\n"), std::string::npos) << program << " lacks " << part;
		for (const std::string& option :
		     lines(bash("\"$1\" --help | grep -oE '^  (-.,)?--[a-z-]+' | tr -d ' ' | sed 's/,/, /'", {VIWO_BINARY_DIR "/bin/" + program})
		               .out))
			EXPECT_NE(page.out.find(" " + option), std::string::npos) << program << " lacks " << option;
		EXPECT_EQ(bash("lexgrog \"$1\"", {pagePath(program)}).status, 0) << program << ": whatis finds no name";
	}
}
}  // namespace viwo::testing
