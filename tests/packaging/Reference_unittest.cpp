#include <gtest/gtest.h>

#include <regex>

#include "Shell.h"

namespace viwo::testing
{
namespace
{
/** Runs doxygen with the project's settings and some of the test's, its output in a temporary folder. */
ProgramResult doxygen(const std::string& settings)
{
	const TempFolder folder;
	return bash("{ cat \"$1\"; printf '%s\\n' \"OUTPUT_DIRECTORY = $2\" \"$3\"; } | doxygen -",
	            {VIWO_BINARY_DIR "/doc/Doxyfile", folder.path(), settings});
}

bool isHere()
{
	return bash("command -v doxygen").status == 0;
}
}  // namespace

/** A link to nowhere, a parameter that does not exist, markup that is none: each is an error. */
TEST(Reference, HasNoWarning)
{
	if (!isHere()) GTEST_SKIP() << "doxygen is not here (package doxygen)";
	const ProgramResult result = doxygen("");
	EXPECT_EQ(result.status, 0);
	EXPECT_EQ(result.err, "");
}

/** Members are told by names with frames and units where these suffice; a type needs a sentence. */
TEST(Reference, EachTypeIsDocumented)
{
	if (!isHere()) GTEST_SKIP() << "doxygen is not here (package doxygen)";
	const ProgramResult result = doxygen("EXTRACT_ALL = NO\nWARN_AS_ERROR = NO\nGENERATE_HTML = NO\nGENERATE_XML = YES");
	size_t undocumented = 0;
	for (const std::string& line : lines(result.err))
	{
		undocumented += line.find("is not documented") != std::string::npos ? 1 : 0;
		const bool is_type = line.find("Compound ") != std::string::npos;
		const bool within_a_type = std::regex_search(line, std::regex("::[A-Z]\\w*::"));
		EXPECT_FALSE(is_type && !within_a_type) << line;
	}
	EXPECT_GT(undocumented, 100u) << "doxygen says no longer what is undocumented";
}
}  // namespace viwo::testing
