#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

/** Man pages and completion, made of the same CLI::App as --help. The type names of options count: "FILE.rawlog" and "FILE.bt|.ot" are
 * files with such names, "DIR" is a folder; the words of CLI::IsMember are offered as they are.
 */
namespace viwo::app
{
/** What a man page and a completion say about one option or positional argument. */
struct OptionSummary
{
	std::vector<std::string> names;  //!< "-i", "--input"; of a positional argument its one name
	std::string placeholder;         //!< "FILE.rawlog", "INT"; empty for a flag
	std::vector<std::string> choices;
	std::vector<std::string> extensions;  //!< "rawlog"; of a file
	std::string range;                    //!< "1 - 256"
	bool is_file = false, is_folder = false;
	bool many = false;  //!< takes any number of values
	int values = 0;     //!< that it takes at least

	explicit OptionSummary(const CLI::Option& option);
};

/** Options and positional arguments as they are shown: hidden ones are left out, those that all programs have come last. */
std::vector<const CLI::Option*> visibleOptions(const CLI::App& cli);

/** The text that follows the options in --help, in its parts. */
struct FooterParts
{
	std::string text;  //!< paragraphs, one a line
	std::vector<std::string> examples;
	std::string exit_status;  //!< "0 done, 1 failed, 2 bad usage"

	explicit FooterParts(const std::string& footer);
};

/** The man page (roff) of a program with its subcommands. @param programs all of viwo, for SEE ALSO. */
std::string manPage(const CLI::App& cli, const std::vector<std::string>& programs);

/** The program's entries in the tables of apps/support/completion.bash. */
std::string completionTable(const CLI::App& cli);
}  // namespace viwo::app
