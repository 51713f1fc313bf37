#include <viwo/core/Error.h>
#include <viwo/core/Joined.h>
#include <viwo/core/Options.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "TextDistance.h"

namespace viwo
{
namespace
{
/** The shortest text that reads back as the same number, in any locale. */
template <class Number>
std::string numberText(Number value)
{
	char buffer[64];
	const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
	return {buffer, result.ptr};
}

/** The whole of the text as a finite number. */
template <class Number>
bool parseNumber(const std::string& text, Number& value)
{
	const char* begin = text.data() + (text.size() > 1 && text[0] == '+' && text[1] != '-' ? 1 : 0);
	const char* end = text.data() + text.size();
	Number parsed{};
	const auto result = std::from_chars(begin, end, parsed);
	if (result.ec != std::errc() || result.ptr != end || !std::isfinite(static_cast<double>(parsed))) return false;
	value = parsed;
	return true;
}

template <class Number>
std::string rangeText(Number min, Number max)
{
	const bool has_min = min > std::numeric_limits<Number>::lowest();
	const bool has_max = max < std::numeric_limits<Number>::max();
	if (has_min && has_max) return " from " + numberText(min) + " to " + numberText(max);
	if (has_min) return " of at least " + numberText(min);
	if (has_max) return " of at most " + numberText(max);
	return {};
}
}  // namespace

OptionsReader::OptionsReader(const mrpt::config::CConfigFileBase& source, std::string section)
    : source_(source), section_(std::move(section))
{
}

bool OptionsReader::raw(const char* key, std::string& text)
{
	known_keys_.emplace_back(key);
	if (!source_.keyExists(section_, key)) return false;
	text = source_.read_string(section_, key, "");
	// MRPT takes the comment behind an empty value for the value.
	if (text.compare(0, 2, "//") == 0) text.clear();
	return true;
}

void OptionsReader::fail(const char* key, const std::string& text, const std::string& expected) const
{
	throw Error("[" + section_ + "] " + key + " = " + text + ": expected " + expected);
}

void OptionsReader::operator()(const char* key, double& value, const char*, double min, double max)
{
	std::string text;
	double parsed = 0;
	if (!raw(key, text)) return;
	if (!parseNumber(text, parsed) || parsed < min || parsed > max) fail(key, text, "a number" + rangeText(min, max));
	value = parsed;
}

void OptionsReader::operator()(const char* key, int& value, const char*, int min, int max)
{
	std::string text;
	int parsed = 0;
	if (!raw(key, text)) return;
	if (!parseNumber(text, parsed) || parsed < min || parsed > max) fail(key, text, "a whole number" + rangeText(min, max));
	value = parsed;
}

void OptionsReader::operator()(const char* key, bool& value, const char*)
{
	std::string text;
	if (!raw(key, text)) return;
	const std::string word = lowered(text);
	const bool is_true = word == "true" || word == "yes" || word == "on" || word == "1";
	const bool is_false = word == "false" || word == "no" || word == "off" || word == "0";
	if (!is_true && !is_false) fail(key, text, "true or false");
	value = is_true;
}

void OptionsReader::operator()(const char* key, std::string& value, const char*)
{
	raw(key, value);
}

void OptionsReader::operator()(const char* key, std::vector<double>& value, const char*)
{
	std::string text;
	if (!raw(key, text)) return;
	std::vector<double> parsed;
	std::istringstream words(text);
	for (std::string word; words >> word;)
	{
		parsed.push_back(0);
		if (!parseNumber(word, parsed.back())) fail(key, text, "numbers with spaces between, not '" + word + "'");
	}
	value = std::move(parsed);
}

void OptionsReader::readChoice(const char* key, int& index, const std::vector<std::string>& words)
{
	std::string text;
	if (!raw(key, text)) return;
	const auto it = std::find(words.begin(), words.end(), lowered(text));
	if (it == words.end()) fail(key, text, "one of: " + joined(words) + suggestion(text, words));
	index = static_cast<int>(it - words.begin());
}

void OptionsReader::rejectUnknownKeys() const
{
	std::vector<std::string> keys;
	source_.getAllKeys(section_, keys);
	for (const auto& key : keys)
	{
		// MRPT's configuration files do not tell upper from lower case.
		const bool known = std::any_of(known_keys_.begin(), known_keys_.end(), [&](const auto& k) { return lowered(k) == lowered(key); });
		if (!known) throw Error("[" + section_ + "] " + key + ": unknown key" + suggestion(key, known_keys_));
	}
}

void OptionsWriter::operator()(const char* key, const std::string& value, const char* comment)
{
	// A padded value would be stored with its spaces: no padding.
	target_.write(section_, key, value, 0, 0, comment);
}

void OptionsWriter::operator()(const char* key, double value, const char* comment, double, double)
{
	(*this)(key, numberText(value), comment);
}

void OptionsWriter::operator()(const char* key, int value, const char* comment, int, int)
{
	(*this)(key, numberText(value), comment);
}

void OptionsWriter::operator()(const char* key, bool value, const char* comment)
{
	(*this)(key, std::string(value ? "true" : "false"), comment);
}

void OptionsWriter::operator()(const char* key, const std::vector<double>& value, const char* comment)
{
	std::string text;
	for (double number : value) text += (text.empty() ? "" : " ") + numberText(number);
	(*this)(key, text, comment);
}

void OptionsWriter::writeChoice(const char* key, size_t index, const char* comment, const std::vector<std::string>& words)
{
	(*this)(key, words.at(index), (std::string(comment) + " (" + joined(words) + ")").c_str());
}
}  // namespace viwo
