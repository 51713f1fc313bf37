#include "CsvTable.h"

#include <viwo/core/Error.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace viwo
{
namespace
{
std::vector<std::string> splitAtCommas(const std::string& line)
{
	std::vector<std::string> words;
	for (size_t begin = 0; begin <= line.size();)
	{
		const size_t comma = std::min(line.find(',', begin), line.size());
		std::string word = line.substr(begin, comma - begin);
		while (!word.empty() && (word.back() == ' ' || word.back() == '\r')) word.pop_back();
		word.erase(0, word.find_first_not_of(' '));
		words.push_back(word);
		begin = comma + 1;
	}
	return words;
}
}  // namespace

CsvTable::CsvTable(const std::string& path, const std::vector<std::string>& columns) : path_(path), file_(path), cells_(columns.size())
{
	if (!file_) throw Error(path + ": cannot read this file; check its name");
	std::vector<std::string> names;
	if (!nextLine(names)) throw Error(path + ": empty; the first line must name the columns");
	for (const std::string& column : columns)
	{
		const auto at = std::find(names.begin(), names.end(), column);
		if (at == names.end()) fail("there is no column '" + column + "'");
		places_.push_back(static_cast<size_t>(at - names.begin()));
	}
}

bool CsvTable::nextLine(std::vector<std::string>& words)
{
	for (std::string line; std::getline(file_, line);)
	{
		++line_;
		if (line.find_first_not_of(" \t\r") == std::string::npos || line[0] == '#') continue;
		words = splitAtCommas(line);
		return true;
	}
	return false;
}

bool CsvTable::next()
{
	std::vector<std::string> words;
	if (!nextLine(words)) return false;
	for (size_t i = 0; i < places_.size(); ++i)
	{
		if (places_[i] >= words.size()) fail("only " + std::to_string(words.size()) + " cells in this row");
		cells_[i] = words[places_[i]];
	}
	return true;
}

double CsvTable::number(size_t column) const
{
	const std::string& text = cells_[column];
	double value = 0;
	const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
	if (result.ec != std::errc() || result.ptr != text.data() + text.size() || !std::isfinite(value))
		fail("'" + text + "' is not a finite number");
	return value;
}

int64_t CsvTable::integer(size_t column) const
{
	const std::string& text = cells_[column];
	int64_t value = 0;
	const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
	if (result.ec != std::errc() || result.ptr != text.data() + text.size()) fail("'" + text + "' is not a whole number");
	return value;
}

void CsvTable::fail(const std::string& what) const
{
	throw Error(path_ + ":" + std::to_string(line_) + ": " + what);
}
}  // namespace viwo
