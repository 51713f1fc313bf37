#include <fcntl.h>
#include <mrpt/core/format.h>
#include <viwo/app/Documents.h>
#include <viwo/app/Program.h>
#include <viwo/core/AtomicFile.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <new>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace viwo::app
{
namespace
{
volatile std::sig_atomic_t g_interrupted = 0;
bool g_quiet = false;
std::string g_program = "viwo";

extern "C" void onSignal(int)
{
	g_interrupted = 1;
}

void installSignalHandlers()
{
	struct sigaction action = {};
	action.sa_handler = onSignal;
	// Back to the default after the first signal, so that a second one ends a program that does not get to look at the flag.
	action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
	sigemptyset(&action.sa_mask);
	sigaction(SIGINT, &action, nullptr);
	sigaction(SIGTERM, &action, nullptr);
	sigaction(SIGHUP, &action, nullptr);
	// A reader that has gone and a file that grows too large are errors of writing, told as such; they end no run that writes elsewhere,
	// too.
	std::signal(SIGPIPE, SIG_IGN);
	std::signal(SIGXFSZ, SIG_IGN);
}

/** Started without standard streams (2>&-), the first files that are opened would take their place, and messages would end up in them. */
void reserveStandardStreams()
{
	for (int fd = 0; fd <= 2; ++fd)
		if (fcntl(fd, F_GETFD) < 0 && open("/dev/null", O_RDWR) < 0) std::abort();
}

/** All of viwo, in the order of apps/CMakeLists.txt. */
std::vector<std::string> programs()
{
	std::istringstream names(VIWO_PROGRAMS);
	return {std::istream_iterator<std::string>(names), {}};
}

/** What man pages and completion are made with, by the build; --help does not show it. */
void addDocuments(CLI::App& cli)
{
	const auto print = [&cli](const char* name, const std::function<std::string()>& text)
	{ cli.add_flag_callback(name, [text] { throw CLI::CallForVersion(text(), 0); })->group(""); };
	print("--print-man", [&cli] { return manPage(cli, programs()); });
	print("--print-completion", [&cli] { return completionTable(cli); });
}

/** Messages of other libraries may have several lines; a user gets one. */
std::string oneLine(const std::string& text)
{
	std::string line;
	for (const char c : text)
	{
		const bool blank = c == '\n' || c == '\r' || c == '\t' || c == ' ';
		if (!blank)
			line += c;
		else if (!line.empty() && line.back() != ' ')
			line += ' ';
	}
	while (!line.empty() && line.back() == ' ') line.pop_back();
	return line;
}

int fail(const std::string& program, const std::string& what, int status)
{
	std::cout.flush();
	std::cerr << program << ": error: " << oneLine(what) << std::endl;
	return status;
}

int guarded(const std::string& program, const std::function<int()>& body)
{
	try
	{
		const int status = body();
		std::cout.flush();
		if (!std::cout) return fail(program, "standard output could not be written", 1);
		return status;
	}
	catch (const UsageError& e)
	{
		return fail(program, std::string(e.what()) + " (see " + program + " --help)", 2);
	}
	catch (const std::bad_alloc&)
	{
		return fail(program, "out of memory", 1);
	}
	catch (const std::exception& e)
	{
		return fail(program, e.what(), 1);
	}
	catch (...)
	{
		return fail(program, "unknown failure", 1);
	}
}

/** Options that name a file to write, in all programs. */
bool isOutput(const CLI::Option& option)
{
	static const std::set<std::string> names{"output", "json", "svg", "html", "csv", "to-ply", "to-grid", "scan-graph"};
	const auto& long_names = option.get_lnames();
	return std::any_of(long_names.begin(), long_names.end(), [](const std::string& name) { return names.count(name) != 0; });
}

void collectFiles(const CLI::App& cli, std::vector<std::string>& inputs, std::vector<std::string>& outputs)
{
	for (const CLI::Option* option : cli.get_options())
		for (const std::string& value : option->results())
		{
			std::error_code ignored;
			const bool exists = std::filesystem::is_regular_file(value, ignored), output = isOutput(*option);
			if (exists || (output && OptionSummary(*option).is_file)) (output ? outputs : inputs).push_back(value);
		}
	for (const CLI::App* command : cli.get_subcommands()) collectFiles(*command, inputs, outputs);
}

/** A recording that is overwritten by a typing error cannot be made again, and a long run is not to end in one. */
void checkOutputs(const CLI::App& cli)
{
	std::vector<std::string> inputs, outputs;
	collectFiles(cli, inputs, outputs);
	requireInputsAreKept(inputs, outputs);
	for (const std::string& path : outputs) requireWritable(path);
}

CLI::Validator finiteNumber(const std::string& what, const std::function<bool(double)>& holds)
{
	const auto check = [what, holds](std::string& text)
	{
		double value = 0;
		const bool is_number = CLI::detail::lexical_cast(text, value);
		return is_number && std::isfinite(value) && holds(value) ? std::string() : "'" + text + "' is not a finite number" + what;
	};
	return CLI::Validator(check, "");
}
}  // namespace

CLI::Validator nonNegative()
{
	return finiteNumber(" of at least 0", [](double value) { return value >= 0; });
}

CLI::Validator positive()
{
	return finiteNumber(" above 0", [](double value) { return value > 0; });
}

CLI::Validator finite()
{
	return finiteNumber("", [](double) { return true; });
}

CLI::Validator between(double least, double most)
{
	return finiteNumber(mrpt::format(" from %g to %g", least, most), [=](double value) { return value >= least && value <= most; });
}

CLI::Validator inside(double low, double high)
{
	return finiteNumber(mrpt::format(" above %g and below %g", low, high), [=](double value) { return value > low && value < high; });
}

CLI::Validator seed()
{
	const auto check = [](std::string& text)
	{
		const bool digits = !text.empty() && std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
		return digits && text.size() <= 18 ? std::string() : "'" + text + "' is not a whole number from 0 to 999999999999999999";
	};
	return CLI::Validator(check, "");
}

CLI::Validator notEmpty()
{
	return CLI::Validator([](std::string& text) { return text.empty() ? std::string("the name is empty") : std::string(); }, "");
}

int run(CLI::App& cli, int argc, char** argv, const std::function<int()>& body)
{
	reserveStandardStreams();
	std::string program = cli.get_name();
	if (program.empty()) program = std::filesystem::path(argc > 0 ? argv[0] : "viwo").filename().string();
	cli.name(program);
	g_program = program;
	g_quiet = false;
	cli.set_version_flag("--version", program + " (viwo) " + version());
	cli.add_flag("--quiet", g_quiet, "Print results and errors only: no progress, no remarks");
	addDocuments(cli);
	try
	{
		cli.parse(argc, argv);
	}
	catch (const CLI::Success& e)  // --help, --version, --print-man
	{
		return cli.exit(e);
	}
	catch (const CLI::ParseError& e)
	{
		return fail(program, std::string(e.what()) + " (see " + program + " --help)", 2);
	}
	installSignalHandlers();
	return guarded(program,
	               [&]
	               {
		               checkOutputs(cli);
		               return body();
	               });
}

void requireInputsAreKept(const std::vector<std::string>& inputs, const std::vector<std::string>& outputs)
{
	namespace fs = std::filesystem;
	std::error_code ignored;
	// Of a name that is not there yet, "x" and "./x" are the same only from the root on.
	const auto place = [&](const std::string& path) { return fs::weakly_canonical(fs::absolute(path, ignored), ignored); };
	for (size_t i = 0; i < outputs.size(); ++i)
	{
		if (fs::exists(outputs[i], ignored) && !fs::is_regular_file(outputs[i], ignored)) continue;  // /dev/null, a pipe
		for (const std::string& input : inputs)
			if (fs::equivalent(outputs[i], input, ignored))
				throw UsageError(outputs[i] + " would be overwritten, but is an input; give the output another name");
		for (size_t j = 0; j < i; ++j)
			if (place(outputs[i]) == place(outputs[j]))
				throw UsageError(outputs[i] + " would be written twice; give each output a name of its own");
	}
}

bool interrupted()
{
	return g_interrupted != 0;
}
bool quiet()
{
	return g_quiet;
}
void tellNotes(const std::vector<std::string>& notes)
{
	if (g_quiet) return;
	for (const std::string& note : notes) std::cerr << g_program + ": note: " + note << std::endl;
}
std::string version()
{
	return VIWO_VERSION;
}
}  // namespace viwo::app
