#include <viwo/app/Documents.h>
#include <viwo/app/Program.h>

#include <algorithm>
#include <cctype>
#include <regex>

namespace viwo::app
{
namespace
{
/** Text as roff shows it: hyphens that can be copied, no requests by accident. */
std::string roff(const std::string& text)
{
	std::string out;
	for (const char c : text)
	{
		if (out.empty() && (c == '.' || c == '\'')) out = "\\&";
		switch (c)
		{
			case '\\':
				out += "\\e";
				break;
			case '-':
				out += "\\-";
				break;
			case '\'':
				out += "\\(aq";
				break;
			case '~':
				out += "\\(ti";
				break;
			case '^':
				out += "\\(ha";
				break;
			case '`':
				out += "\\(ga";
				break;
			default:
				out += c;
		}
	}
	return out;
}

std::string bold(const std::string& text)
{
	return "\\fB" + roff(text) + "\\fR";
}

std::string italic(const std::string& text)
{
	return "\\fI" + roff(text) + "\\fR";
}

std::string sentence(std::string text)
{
	if (!text.empty() && text.back() != '.') text += '.';
	return text;
}

/** "-i, --input FILE ...", "--quiet", "recordings ..." */
std::string heading(const CLI::Option& option)
{
	const OptionSummary summary(option);
	std::string text;
	if (option.get_positional())
		text = italic(summary.names.front());
	else
	{
		for (const std::string& name : summary.names) text += (text.empty() ? "" : ", ") + bold(name);
		if (!summary.placeholder.empty()) text += " " + italic(summary.placeholder);
	}
	if (summary.many) text += " ...";
	if (!summary.many && summary.values > 1) text += " (" + std::to_string(summary.values) + " values)";
	return text;
}

std::string namesOf(const std::set<CLI::Option*>& options)
{
	std::vector<std::string> names;
	for (const CLI::Option* option : options) names.push_back(OptionSummary(*option).names.back());
	std::sort(names.begin(), names.end());  // the set's order is that of addresses
	std::string text;
	for (const std::string& name : names) text += (text.empty() ? "" : ", ") + bold(name);
	return text;
}

/** What CLI11 knows beyond the description: choices, range, default, and what goes together. */
std::string constraints(const CLI::Option& option)
{
	const OptionSummary summary(option);
	std::string text;
	const auto add = [&](const std::string& part) { text += (text.empty() ? "" : " ") + part; };
	if (!summary.choices.empty())
	{
		std::string list;
		for (const std::string& choice : summary.choices) list += (list.empty() ? "" : ", ") + bold(choice);
		add("One of " + list + ".");
	}
	const size_t dash = summary.range.find(" - ");
	if (dash != std::string::npos) add("From " + roff(summary.range.substr(0, dash)) + " to " + roff(summary.range.substr(dash + 3)) + ".");
	std::string standard = summary.placeholder.empty() ? std::string() : option.get_default_str();
	if (!standard.empty() && standard.front() == '[') standard = standard.substr(1, standard.size() - 2);  // a list
	if (!standard.empty()) add("Default: " + bold(standard) + ".");
	if (!option.get_needs().empty()) add("Only with " + namesOf(option.get_needs()) + ".");
	if (!option.get_excludes().empty()) add("Not with " + namesOf(option.get_excludes()) + ".");
	return text;
}

std::string optionEntry(const CLI::Option& option)
{
	std::string text = ".TP\n" + heading(option) + "\n" + roff(sentence(option.get_description())) + "\n";
	const std::string more = constraints(option);
	if (!more.empty()) text += ".br\n" + more + "\n";
	return text;
}

bool isHelp(const CLI::Option& option)
{
	const auto& names = option.get_lnames();
	return std::find(names.begin(), names.end(), "help") != names.end();
}

/** Name, required options, positional arguments. */
std::string usage(const CLI::App& cli, const std::string& name)
{
	std::string text = bold(name);
	bool optional = false;
	for (const CLI::Option* option : visibleOptions(cli))
		if (option->get_required() && !option->get_positional())
		{
			const OptionSummary summary(*option);
			text += " " + bold(summary.names.front()) + " " + italic(summary.placeholder) + (summary.many ? " ..." : "");
		}
		else
			optional = optional || !option->get_positional();
	if (optional) text += " [" + italic("option") + " ...]";
	for (const CLI::Option* option : visibleOptions(cli))
		if (option->get_positional())
		{
			const std::string argument = italic(OptionSummary(*option).names.front()) + (OptionSummary(*option).many ? " ..." : "");
			text += option->get_required() ? " " + argument : " [" + argument + "]";
		}
	return text;
}

std::vector<const CLI::App*> commandsOf(const CLI::App& cli)
{
	return cli.get_subcommands([](const CLI::App* command) { return !command->get_name().empty() && !command->get_group().empty(); });
}

std::string synopsis(const CLI::App& cli)
{
	std::string text = ".SH SYNOPSIS\n";
	const char* separator = "";
	const auto add = [&](const std::string& line)
	{
		text += separator + line + "\n";
		separator = ".br\n";
	};
	if (cli.get_require_subcommand_min() == 0) add(usage(cli, cli.get_name()));
	for (const CLI::App* command : commandsOf(cli)) add(usage(*command, cli.get_name() + " " + command->get_name()));
	return text;
}

std::string description(const CLI::App& cli, const FooterParts& footer)
{
	std::string text = ".SH DESCRIPTION\n" + roff(sentence(cli.get_description())) + "\n";
	std::string paragraphs = footer.text;
	for (size_t start = 0; start < paragraphs.size();)
	{
		const size_t end = std::min(paragraphs.find('\n', start), paragraphs.size());
		text += (start == 0 ? ".PP\n" : "") + roff(paragraphs.substr(start, end - start)) + "\n";
		start = end + 1;
	}
	return text;
}

std::string options(const CLI::App& cli)
{
	std::string text = ".SH OPTIONS\n";
	for (const CLI::Option* option : visibleOptions(cli)) text += optionEntry(*option);
	return text;
}

std::string commands(const CLI::App& cli)
{
	std::string text;
	for (const CLI::App* command : commandsOf(cli))
	{
		text += ".SS " + roff(cli.get_name() + " " + command->get_name()) + "\n" + roff(sentence(command->get_description())) + "\n";
		for (const CLI::Option* option : visibleOptions(*command))
			if (!isHelp(*option)) text += optionEntry(*option);
	}
	return text.empty() ? text : ".SH COMMANDS\n" + text;
}

std::string examples(const FooterParts& footer)
{
	if (footer.examples.empty()) return {};
	std::string text = ".SH EXAMPLES\n.EX\n";
	for (const std::string& example : footer.examples) text += roff(example) + "\n";
	return text + ".EE\n";
}

/** "0 done, 1 failed, 2 bad usage" as a list. */
std::string exitStatus(const FooterParts& footer)
{
	if (footer.exit_status.empty()) return {};
	std::string text = ".SH EXIT STATUS\n";
	const std::regex entry(R"((\d) (.*?)(?=, \d |$))");
	for (std::sregex_iterator it(footer.exit_status.begin(), footer.exit_status.end(), entry), end; it != end; ++it)
		text += ".TP\n" + bold((*it)[1]) + "\n" + roff((*it)[2]) + "\n";
	return text;
}

std::string seeAlso(const CLI::App& cli, const std::vector<std::string>& programs)
{
	std::string text = ".SH SEE ALSO\n";
	for (const std::string& program : programs)
		if (program != cli.get_name()) text += ".BR " + roff(program) + " (1),\n";
	return text + ".BR rawlog\\-edit (1)\n";
}

/** A line of NAME: no capital, no full stop. */
std::string whatIs(const CLI::App& cli)
{
	std::string text = cli.get_description();
	if (!text.empty() && text.back() == '.') text.pop_back();
	const auto isUpper = [](char c) { return std::isupper(static_cast<unsigned char>(c)) != 0; };
	const std::string word = text.substr(0, text.find(' '));
	const bool is_name = std::count_if(word.begin(), word.end(), isUpper) > 1;  // OctoMap, ROS
	if (!text.empty() && !is_name) text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
	return text;
}

std::string upperCase(std::string text)
{
	for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
	return text;
}
}  // namespace

std::string manPage(const CLI::App& cli, const std::vector<std::string>& programs)
{
	const FooterParts footer(cli.get_footer());
	const std::string& name = cli.get_name();
	return ".\\\" Made of what " + name + " --help says; do not edit.\n" +                              //
	       ".TH " + roff(upperCase(name)) + " 1 \"\" \"viwo " + version() + "\" \"User Commands\"\n" +  //
	       ".SH NAME\n" + roff(name) + " \\- " + roff(whatIs(cli)) + "\n" +                             //
	       synopsis(cli) + description(cli, footer) + commands(cli) + options(cli) + examples(footer) + exitStatus(footer) +
	       seeAlso(cli, programs);
}
}  // namespace viwo::app
