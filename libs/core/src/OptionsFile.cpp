#include <mrpt/config/CConfigFileMemory.h>
#include <viwo/core/AtomicFile.h>
#include <viwo/core/Error.h>
#include <viwo/core/Joined.h>
#include <viwo/core/Options.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>

#include "TextDistance.h"

namespace viwo
{
namespace
{
std::string trimmed(const std::string& text)
{
	const char* blanks = " \t\r\n";
	const size_t begin = text.find_first_not_of(blanks);
	if (begin == std::string::npos) return {};
	return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

bool isComment(const std::string& line)
{
	return line[0] == '#' || line[0] == ';' || line.compare(0, 2, "//") == 0;
}

std::string readText(const std::string& path)
{
	std::ifstream file(path, std::ios::binary);
	std::ostringstream text;
	// An empty file sets nothing, but the insertion of no characters counts as a failure of the stream that takes them.
	const bool empty = file.good() && file.peek() == std::ifstream::traits_type::eof() && !file.bad();
	if (empty) return {};
	if (file) text << file.rdbuf();
	if (!file || file.bad() || text.fail()) throw Error(path + ": cannot read this configuration file; check its name and permissions");
	std::string content = text.str();
	if (content.find('\0') != std::string::npos)
		throw Error(path + ": this is no text; a configuration file has [sections] and key = value");
	// Some editors begin UTF-8 files with a mark that is no character.
	if (content.compare(0, 3, "\xEF\xBB\xBF") == 0) content.erase(0, 3);
	return content;
}

/** What MRPT's parser passes over in silence: lines that are no assignment, a key given twice (the last would win), keys outside of a
 * section. */
class LineChecker
{
   public:
	explicit LineChecker(const std::string& path) : path_(path) {}

	void check(const std::string& text)
	{
		std::istringstream lines(text);
		for (std::string line; std::getline(lines, line);)
		{
			number_++;
			const bool continues_last = continues_;
			const std::string content = trimmed(line);
			continues_ = !content.empty() && content.back() == '\\';
			if (!continues_last && !content.empty() && !isComment(content)) checkLine(content);
		}
	}

   private:
	void checkLine(const std::string& line)
	{
		if (line[0] == '[')
		{
			const size_t close = line.find(']');
			if (close == std::string::npos) fail("'" + line + "' lacks its ]");
			section_ = trimmed(line.substr(1, close - 1));
			return;
		}
		if (line.compare(0, 7, "@define") == 0) return;
		const size_t equals = line.find('=');
		if (equals == std::string::npos || equals == 0) fail("'" + line + "' is neither 'key = value' nor a [section]");
		const std::string key = trimmed(line.substr(0, equals));
		if (section_.empty()) fail("key " + key + " stands before the first [section]");
		if (!seen_.insert(lowered(section_) + "\n" + lowered(key)).second) fail("[" + section_ + "] " + key + " is given twice; keep one");
	}

	[[noreturn]] void fail(const std::string& what) const { throw Error(path_ + ":" + std::to_string(number_) + ": " + what); }

	std::string path_, section_;
	int number_ = 0;
	bool continues_ = false;
	std::set<std::string> seen_;
};
}  // namespace

void loadOptions(const std::string& ini_path, const std::vector<OptionsSection>& sections)
{
	const std::string text = readText(ini_path);
	LineChecker(ini_path).check(text);
	const mrpt::config::CConfigFileMemory source(text);

	std::vector<std::string> known;
	for (const auto& section : sections) known.push_back(section.name);
	std::vector<std::string> present;
	source.getAllSections(present);
	for (const auto& name : present)
	{
		const bool is_known = std::any_of(known.begin(), known.end(), [&](const auto& k) { return lowered(k) == lowered(name); });
		if (!is_known)
			throw Error(ini_path + ": [" + name + "]: unknown section" + suggestion(name, known) + "; sections: " + joined(known));
	}
	for (const auto& section : sections)
	{
		try
		{
			section.options->loadFromConfigFile(source, section.name);
		}
		catch (const Error& e)
		{
			throw Error(ini_path + ": " + e.what());
		}
	}
}

void saveOptions(const std::string& ini_path, const std::vector<OptionsSection>& sections, const std::string& header_comment)
{
	AtomicFile file(ini_path);
	std::istringstream comment(header_comment);
	for (std::string line; std::getline(comment, line);) file.stream() << "# " << line << "\n";
	// One memory file a section keeps their order: MRPT's would sort them by its own rules.
	for (const auto& section : sections)
	{
		mrpt::config::CConfigFileMemory target;
		section.options->saveToConfigFile(target, section.name);
		file.stream() << (file.stream().tellp() > 0 ? "\n" : "") << trimmed(target.getContent()) << "\n";
	}
	file.commit();
}
}  // namespace viwo
