#include <viwo/app/Documents.h>

#include <algorithm>
#include <sstream>

namespace viwo::app
{
namespace
{
std::vector<std::string> split(const std::string& text, char separator)
{
	std::vector<std::string> parts;
	std::istringstream stream(text);
	for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
	return parts;
}

bool startsWith(const std::string& text, const std::string& start)
{
	return text.compare(0, start.size(), start) == 0;
}

/** "FILE.bt|.ot" -> bt, ot */
std::vector<std::string> extensionsOf(const std::string& placeholder)
{
	std::vector<std::string> extensions = split(placeholder.substr(4), '|');
	for (std::string& extension : extensions) extension.erase(0, extension.find_first_not_of('.'));
	return extensions;
}
}  // namespace

OptionSummary::OptionSummary(const CLI::Option& option)
{
	if (option.get_positional())
		names.push_back(option.get_name(true, false));
	else
	{
		for (const std::string& name : option.get_snames()) names.push_back("-" + name);
		for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
	}
	if (option.get_type_size() == 0 || option.get_items_expected_max() == 0) return;  // a flag

	// CLI11 writes "TYPE:check": INT:INT in [1 - 256], TEXT:{a,b}, TEXT:DIR.
	const std::string type = option.get_type_name();
	const size_t colon = type.find(':');
	placeholder = type.substr(0, colon);
	const std::string check = colon == std::string::npos ? std::string() : type.substr(colon + 1);
	const size_t bracket = check.find('[');
	if (startsWith(check, "{"))
		choices = split(check.substr(1, check.find('}') - 1), ',');
	else if (bracket != std::string::npos)
		range = check.substr(bracket + 1, check.find(']') - bracket - 1);
	if (check == "DIR") placeholder = "DIR";
	is_folder = placeholder == "DIR";
	is_file = startsWith(placeholder, "FILE");
	if (is_file) extensions = extensionsOf(placeholder);
	many = option.get_expected_max() >= CLI::detail::expected_max_vector_size;
	values = std::max(1, option.get_items_expected_min());
}

std::vector<const CLI::Option*> visibleOptions(const CLI::App& cli)
{
	auto options = cli.get_options([](const CLI::Option* option) { return !option->get_group().empty(); });
	const auto isCommon = [&](const CLI::Option* option)
	{
		const auto& names = option->get_lnames();
		return !names.empty() && (names[0] == "help" || names[0] == "version" || names[0] == "quiet");
	};
	std::stable_partition(options.begin(), options.end(), [&](const CLI::Option* option) { return !isCommon(option); });
	return options;
}

FooterParts::FooterParts(const std::string& footer)
{
	const std::string kExit = "Exit status: ";
	std::string paragraph;
	for (const std::string& line : split(footer, '\n'))
	{
		if (line == "Examples:") continue;
		if (startsWith(line, "  "))
			examples.push_back(line.substr(2));
		else if (startsWith(line, kExit))
			exit_status = line.substr(kExit.size());
		else
			text += (text.empty() ? "" : "\n") + line;
	}
	if (!exit_status.empty() && exit_status.back() == '.') exit_status.pop_back();
}
}  // namespace viwo::app
