#include "RunProgram.h"

#include <viwo/app/Program.h>

#include <gtest/gtest.h>

#include <csignal>
#include <stdexcept>
#include <string>
#include <vector>

using namespace viwo;
using namespace viwo::testing;

namespace
{
struct Outcome
{
	int status;
	std::string out, err;
};

Outcome runWith(std::vector<std::string> arguments, const std::function<int()>& body)
{
	CLI::App cli{"A test", "viwo-test"};
	int number = 0;
	cli.add_option("--number", number, "A number");
	arguments.insert(arguments.begin(), "viwo-test");
	std::vector<char*> argv;
	for (auto& argument : arguments) argv.push_back(argument.data());
	::testing::internal::CaptureStdout();
	::testing::internal::CaptureStderr();
	const int status = app::run(cli, static_cast<int>(argv.size()), argv.data(), body);
	std::string out = ::testing::internal::GetCapturedStdout();
	return {status, std::move(out), ::testing::internal::GetCapturedStderr()};
}
}  // namespace

TEST(Program, StatusIsTheBodys)
{
	for (const int status : {0, 1})
	{
		const Outcome outcome = runWith({}, [status] { return status; });
		EXPECT_EQ(outcome.status, status);
		EXPECT_EQ(outcome.err, "");
	}
}

TEST(Program, ExceptionsBecomeOneLine)
{
	const Outcome known = runWith({}, []() -> int { throw Error("x.rawlog: missing; check its name"); });
	EXPECT_EQ(known.status, 1);
	EXPECT_EQ(known.err, "viwo-test: error: x.rawlog: missing; check its name\n");

	const Outcome foreign = runWith({}, []() -> int { throw std::runtime_error("first\n\tsecond   line\n"); });
	EXPECT_EQ(foreign.status, 1);
	EXPECT_EQ(foreign.err, "viwo-test: error: first second line\n");

	const Outcome odd = runWith({}, []() -> int { throw 7; });
	EXPECT_EQ(odd.status, 1);
	EXPECT_EQ(odd.err, "viwo-test: error: unknown failure\n");
}

TEST(Program, BadUsageIsStatusTwo)
{
	bool entered = false;
	const Outcome unknown = runWith({"--nonsense"}, [&] { return entered = true, 0; });
	EXPECT_EQ(unknown.status, 2);
	EXPECT_NE(unknown.err.find("--nonsense"), std::string::npos);
	EXPECT_EQ(std::count(unknown.err.begin(), unknown.err.end(), '\n'), 1);
	EXPECT_EQ(runWith({"--number", "abc"}, [&] { return entered = true, 0; }).status, 2);
	EXPECT_FALSE(entered);

	const Outcome contradictory = runWith({}, []() -> int { throw app::UsageError("--from lies behind --to"); });
	EXPECT_EQ(contradictory.status, 2);
	EXPECT_EQ(contradictory.err, "viwo-test: error: --from lies behind --to (see viwo-test --help)\n");
}

TEST(Program, ValuesThatAreNoNumbersOrNamesAreRefused)
{
	const auto refused = [](const CLI::Validator& check, std::string text) { return !check(text).empty(); };
	for (const char* text : {"nan", "inf", "-inf", "-1", "", "x"})
	{
		EXPECT_TRUE(refused(app::nonNegative(), text)) << text;
		EXPECT_TRUE(refused(app::positive(), text)) << text;
		std::string copy = text;
		EXPECT_LT(app::nonNegative()(copy).size(), 80u) << text;
	}
	for (const char* text : {"0.5", "1e3", "7"})
	{
		EXPECT_FALSE(refused(app::nonNegative(), text)) << text;
		EXPECT_FALSE(refused(app::positive(), text)) << text;
	}
	EXPECT_FALSE(refused(app::nonNegative(), "0"));
	EXPECT_TRUE(refused(app::positive(), "0"));
	for (const char* text : {"nan", "inf", "x", "", "1.5", "-0.5"})
	{
		EXPECT_TRUE(refused(app::between(0, 1), text)) << text;
		EXPECT_TRUE(refused(app::inside(0, 1), text)) << text;
	}
	for (const char* text : {"0", "1", "1e-9"}) EXPECT_FALSE(refused(app::between(0, 1), text)) << text;
	EXPECT_TRUE(refused(app::inside(0, 1), "0"));
	EXPECT_TRUE(refused(app::inside(0, 1), "1"));
	EXPECT_FALSE(refused(app::inside(0, 1), "0.5"));
	EXPECT_FALSE(refused(app::finite(), "-1e300"));
	EXPECT_TRUE(refused(app::finite(), "nan"));
	EXPECT_TRUE(refused(app::notEmpty(), ""));
	EXPECT_FALSE(refused(app::notEmpty(), "out"));
}

TEST(Program, HelpVersionQuiet)
{
	const Outcome help = runWith({"--help"}, [] { return 1; });
	EXPECT_EQ(help.status, 0);
	EXPECT_NE(help.out.find("--version"), std::string::npos);
	const Outcome version = runWith({"--version"}, [] { return 1; });
	EXPECT_EQ(version.status, 0);
	EXPECT_EQ(version.out, "viwo-test (viwo) " + app::version() + "\n");
	EXPECT_EQ(runWith({"--quiet"}, [] { return app::quiet() ? 0 : 1; }).status, 0);
	EXPECT_EQ(runWith({}, [] { return app::quiet() ? 1 : 0; }).status, 0) << "a flag of an earlier run stays";
}

TEST(Program, NotesAreLinesOnStderr)
{
	const auto tells = [] { return app::tellNotes({"one", "two, 100 %s"}), 0; };
	const Outcome outcome = runWith({}, tells);
	EXPECT_EQ(outcome.err, "viwo-test: note: one\nviwo-test: note: two, 100 %s\n");
	EXPECT_EQ(outcome.out, "");
	EXPECT_EQ(runWith({"--quiet"}, tells).err, "");
}

/** A recording that is overwritten by a typing error cannot be made again. */
TEST(Program, AnInputIsNeverOverwritten)
{
	const TempFolder folder;
	const std::string precious = write(folder, "run.rawlog", "precious"), link = folder.file("link");
	std::filesystem::create_symlink(precious, link);
	for (const auto& [output, status] : std::vector<std::pair<std::string, int>>{{precious, 2}, {link, 2}, {folder.file("new"), 0}})
	{
		CLI::App cli("", "viwo-test");
		std::string input, to_ply;
		CLI::App* command = cli.add_subcommand("make");
		command->add_option("-i,--input", input);
		command->add_option("--to-ply", to_ply);
		std::vector<std::string> arguments{"viwo-test", "make", "-i", precious, "--to-ply", output};
		std::vector<char*> argv;
		for (auto& argument : arguments) argv.push_back(argument.data());
		::testing::internal::CaptureStderr();
		EXPECT_EQ(app::run(cli, static_cast<int>(argv.size()), argv.data(), [] { return 0; }), status) << output;
		EXPECT_EQ(::testing::internal::GetCapturedStderr().empty(), status == 0);
	}
}

/** Before the long part of a run. */
TEST(Program, OutputsAreTriedFirst)
{
	const TempFolder folder;
	const std::string fine = folder.file("rig.ini"), absent = folder.file("none/x.html");
	const std::string same = std::filesystem::relative(fine).string();
	struct
	{
		std::string html, error;
		int status;
	} const cases[] = {{absent, "create it first", 1}, {folder.path(), "is a folder", 1}, {same, "written twice", 2}, {"/dev/null", "", 0}};
	for (const auto& c : cases)
	{
		CLI::App cli("", "viwo-test");
		std::string output, html;
		cli.add_option("-o,--output", output)->type_name("FILE.ini");
		cli.add_option("--html", html)->type_name("FILE.html");
		std::vector<std::string> arguments{"viwo-test", "-o", fine, "--html", c.html};
		std::vector<char*> argv;
		for (auto& argument : arguments) argv.push_back(argument.data());
		bool entered = false;
		::testing::internal::CaptureStderr();
		EXPECT_EQ(app::run(cli, static_cast<int>(argv.size()), argv.data(), [&] { return entered = true, 0; }), c.status) << c.html;
		const std::string error = ::testing::internal::GetCapturedStderr();
		EXPECT_NE(error.find(c.error), std::string::npos) << error;
		EXPECT_EQ(entered, c.status == 0) << c.html;
		EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << c.html;
	}
}

TEST(Program, NamesMadeOfArgumentsAreCheckedToo)
{
	const TempFolder folder;
	const std::string input = write(folder, "in", "x"), other = folder.file("other");
	EXPECT_NO_THROW(app::requireInputsAreKept({input, folder.file("absent")}, {other, folder.file("third"), "/dev/null", "/dev/null"}));
	EXPECT_THROW(app::requireInputsAreKept({input}, {other, folder.path() + "/./in"}), app::UsageError);
	EXPECT_THROW(app::requireInputsAreKept({}, {other, folder.path() + "/./other"}), app::UsageError);
}

TEST(Program, SignalsSetAFlag)
{
	EXPECT_EQ(runWith({},
	                  []
	                  {
		                  const bool before = app::interrupted();
		                  std::raise(SIGINT);
		                  return !before && app::interrupted() ? 0 : 1;
	                  })
	              .status,
	          0);
}

TEST(Program, FindsSharedFiles)
{
	const TempFolder folder;
	write(folder, "a/b.ini", "x");
	setenv("VIWO_SHARE", folder.path().c_str(), 1);
	EXPECT_EQ(app::findShare("a/b.ini"), folder.file("a/b.ini"));
	const auto complaint = [](const std::string& name)
	{
		try
		{
			return "found " + app::findShare(name);
		}
		catch (const Error& e)
		{
			return std::string(e.what());
		}
	};
	EXPECT_NE(complaint("a/absent.ini").find("there are: b.ini"), std::string::npos) << complaint("a/absent.ini");
	EXPECT_NE(complaint("none/absent.ini").find(folder.path()), std::string::npos) << complaint("none/absent.ini");
	EXPECT_NE(complaint("none/absent.ini").find("VIWO_SHARE"), std::string::npos);
	unsetenv("VIWO_SHARE");
}

TEST(ProgressBar, Text)
{
	EXPECT_EQ(app::ProgressBar::render(0, -1, ""), "[....................]   0%  --:-- left");
	EXPECT_EQ(app::ProgressBar::render(0.42, 12, "frame 7"), "[########............]  42%  00:12 left  frame 7");
	EXPECT_EQ(app::ProgressBar::render(1.5, 3725, ""), "[####################] 100%  1:02:05 left");
	EXPECT_EQ(app::ProgressBar::render(std::nan(""), 0, ""), "[....................]   0%  00:00 left");
}

TEST(ProgressBar, SilentInAPipe)
{
	::testing::internal::CaptureStderr();
	{
		app::ProgressBar bar;
		bar.update(0.5, "note");
	}
	EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}
