#include <viwo/app/Documents.h>

namespace viwo::app
{
namespace
{
/** What may follow an option, as completion.bash reads it: how many values (* for any number), their kind, words or extensions. */
std::string valuesOf(const CLI::Option& option)
{
	const OptionSummary summary(option);
	std::string text = summary.many ? "*" : std::to_string(summary.values);
	const auto append = [&](const std::vector<std::string>& words)
	{
		for (const std::string& word : words) text += " " + word;
	};
	if (!summary.choices.empty())
	{
		text += option.get_delimiter() == ',' ? " LIST" : " WORDS";
		append(summary.choices);
	}
	else if (summary.is_file)
	{
		text += " FILE";
		append(summary.extensions);
	}
	else
		text += summary.is_folder ? " DIR" : " TEXT";
	return text;
}

std::string entry(const std::string& table, const std::string& key, const std::string& value)
{
	return table + "[\"" + key + "\"]=\"" + value + "\"\n";
}

/** One program or subcommand: the words that may stand there, then the values of each option. */
std::string tableOf(const CLI::App& cli, const std::string& key)
{
	std::string words, values;
	const auto add = [&](const CLI::App& level)
	{
		for (const CLI::Option* option : visibleOptions(level))
		{
			const OptionSummary summary(*option);
			if (option->get_positional())
			{
				values += entry("_viwo_values", key + " @", valuesOf(*option));
				continue;
			}
			for (const std::string& name : summary.names)
			{
				if ((" " + words + " ").find(" " + name + " ") != std::string::npos) continue;
				words += (words.empty() ? "" : " ") + name;
				if (!summary.placeholder.empty()) values += entry("_viwo_values", key + " " + name, valuesOf(*option));
			}
		}
	};
	for (const CLI::App* command : cli.get_subcommands({})) words += (words.empty() ? "" : " ") + command->get_name();
	add(cli);
	if (cli.get_parent() != nullptr && cli.get_fallthrough()) add(*cli.get_parent());
	return entry("_viwo_words", key, words) + values;
}
}  // namespace

std::string completionTable(const CLI::App& cli)
{
	std::string text = tableOf(cli, cli.get_name());
	for (const CLI::App* command : cli.get_subcommands({})) text += tableOf(*command, cli.get_name() + " " + command->get_name());
	return text + "complete -F _viwo_complete " + cli.get_name() + "\n";
}
}  // namespace viwo::app
