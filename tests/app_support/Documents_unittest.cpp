#include <gtest/gtest.h>
#include <viwo/app/Documents.h>

#include <string>

using namespace viwo;

namespace
{
/** A program with something of everything. */
struct Toy
{
	CLI::App cli{"Shows what a page may hold.", "viwo-toy"};
	std::vector<std::string> inputs, sources;
	std::string output, mode = "fast";
	int jobs = 1;
	bool loud = false;
	std::vector<double> pose;

	Toy()
	{
		cli.fallthrough();
		cli.add_option("-i,--input", inputs, "What isn't told -- elsewhere")->type_name("FILE.bt|.ot")->required();
		CLI::Option* const mode_option =
		    cli.add_option("--mode", mode, "How")->check(CLI::IsMember(std::vector<std::string>{"fast", "slow"}))->capture_default_str();
		cli.add_option("--sources", sources, "Which")->delimiter(',')->check(CLI::IsMember(std::vector<std::string>{"scans", "depth"}));
		cli.add_option("-j,--jobs", jobs, "Threads")->check(CLI::Range(1, 256));
		cli.add_flag("--loud", loud, "More")->needs(mode_option);
		cli.add_flag("--hidden", "Not shown")->group("");
		CLI::App* const command = cli.add_subcommand("make", "One thing");
		command->add_option("-o,--output", output, "Where")->type_name("DIR")->required();
		command->add_option("--pose", pose, "Of it")->expected(6);
		cli.footer(".Begins with a dot.\nExamples:\n  viwo-toy make -o 'a\\b'\nExit status: 0 done, 1 failed, or not, 2 bad usage.");
	}
};

/** The lines that follow the first one that is `line`, up to the next request of that kind. */
std::string after(const std::string& text, const std::string& line, const std::string& until)
{
	const size_t start = text.find(line + "\n");
	if (start == std::string::npos) return {};
	const size_t begin = start + line.size() + 1;
	return text.substr(begin, text.find("\n" + until, begin) - begin);
}
}  // namespace

TEST(ManPage, HasTheOptionsAsHelpHasThem)
{
	const Toy toy;
	const std::string page = app::manPage(toy.cli, {"viwo-toy", "viwo-other"});
	EXPECT_NE(page.find("viwo\\-toy \\- shows what a page may hold\n"), std::string::npos) << page;
	EXPECT_EQ(after(page, "\\fB\\-i\\fR, \\fB\\-\\-input\\fR \\fIFILE.bt|.ot\\fR ...", ".TP"), "What isn\\(aqt told \\-\\- elsewhere.");
	EXPECT_EQ(after(page, "\\fB\\-\\-mode\\fR \\fITEXT\\fR", ".TP"),
	          "How.\n.br\nOne of \\fBfast\\fR, \\fBslow\\fR. Default: \\fBfast\\fR.");
	EXPECT_NE(after(page, "\\fB\\-j\\fR, \\fB\\-\\-jobs\\fR \\fIINT\\fR", ".TP").find("From 1 to 256."), std::string::npos) << page;
	EXPECT_EQ(after(page, "\\fB\\-\\-loud\\fR", ".SH"),
	          "More.\n.br\nOnly with \\fB\\-\\-mode\\fR.\n.TP\n\\fB\\-h\\fR, \\fB\\-\\-help\\fR\nPrint this help message and exit.");
	EXPECT_EQ(page.find("hidden"), std::string::npos);
}

TEST(ManPage, HasCommandsExamplesAndStatus)
{
	const Toy toy;
	const std::string page = app::manPage(toy.cli, {"viwo-toy", "viwo-other"});
	EXPECT_NE(page.find("\\fBviwo\\-toy\\fR \\fB\\-i\\fR \\fIFILE.bt|.ot\\fR ... [\\fIoption\\fR ...]\n.br\n"
	                    "\\fBviwo\\-toy make\\fR \\fB\\-o\\fR \\fIDIR\\fR [\\fIoption\\fR ...]\n"),
	          std::string::npos)
	    << page;
	EXPECT_EQ(after(page, ".SS viwo\\-toy make", ".SH").substr(0, 10), "One thing.");
	EXPECT_NE(page.find("\\fB\\-\\-pose\\fR \\fIFLOAT\\fR (6 values)"), std::string::npos) << page;
	EXPECT_NE(page.find("\n\\&.Begins with a dot.\n"), std::string::npos) << page;
	EXPECT_EQ(after(page, ".SH EXAMPLES", ".SH"), ".EX\nviwo\\-toy make \\-o \\(aqa\\eb\\(aq\n.EE");
	EXPECT_EQ(after(page, ".SH EXIT STATUS", ".SH"), ".TP\n\\fB0\\fR\ndone\n.TP\n\\fB1\\fR\nfailed, or not\n.TP\n\\fB2\\fR\nbad usage");
	EXPECT_EQ(after(page, ".SH SEE ALSO", ".SH"), ".BR viwo\\-other (1),\n.BR rawlog\\-edit (1)\n");
}

TEST(CompletionTable, SaysWhatFollowsAnOption)
{
	const Toy toy;
	const std::string table = app::completionTable(toy.cli);
	for (const char* line : {"_viwo_words[\"viwo-toy\"]=\"make -i --input --mode --sources -j --jobs --loud -h --help\"",
	                         "_viwo_values[\"viwo-toy -i\"]=\"* FILE bt ot\"", "_viwo_values[\"viwo-toy --mode\"]=\"1 WORDS fast slow\"",
	                         "_viwo_values[\"viwo-toy --sources\"]=\"* LIST scans depth\"", "_viwo_values[\"viwo-toy --jobs\"]=\"1 TEXT\"",
	                         "_viwo_values[\"viwo-toy make --output\"]=\"1 DIR\"", "_viwo_values[\"viwo-toy make --pose\"]=\"6 TEXT\"",
	                         "_viwo_values[\"viwo-toy make --mode\"]=\"1 WORDS fast slow\"", "complete -F _viwo_complete viwo-toy"})
		EXPECT_NE(("\n" + table).find("\n" + std::string(line) + "\n"), std::string::npos) << line << " in\n" << table;
	EXPECT_EQ(table.find("--loud\"]"), std::string::npos) << "a flag takes no value";
	EXPECT_EQ(table.find("hidden"), std::string::npos);
}
