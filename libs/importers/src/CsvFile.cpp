#include "CsvFile.h"

#include <viwo/core/Error.h>

#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>

namespace viwo
{
namespace
{
std::string trimmed(const std::string& text)
{
	const size_t begin = text.find_first_not_of(" \t\r");
	if (begin == std::string::npos) return {};
	return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

std::vector<std::string> splitCommas(const std::string& line)
{
	std::vector<std::string> cells;
	std::istringstream stream(line);
	for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(trimmed(cell));
	return cells;
}

int64_t parseStamp(const std::string& text, const std::string& where)
{
	int64_t t_ns = 0;
	const auto result = std::from_chars(text.data(), text.data() + text.size(), t_ns);
	if (result.ec != std::errc() || result.ptr != text.data() + text.size())
		throw Error(where + ": '" + text + "' is not a time in nanoseconds");
	return t_ns;
}
}  // namespace

double parseNumber(const std::string& text, const std::string& where)
{
	double value = 0;
	const char* begin = text.data() + (!text.empty() && text[0] == '+' ? 1 : 0);
	const char* end = text.data() + text.size();
	const auto result = std::from_chars(begin, end, value);
	if (result.ec != std::errc() || result.ptr != end || !std::isfinite(value))
		throw Error(where + ": '" + text + "' is not a finite number");
	return value;
}

std::vector<std::string> splitWords(const std::string& line)
{
	std::istringstream stream(line);
	std::vector<std::string> words;
	for (std::string word; stream >> word;) words.push_back(word);
	return words;
}

double CsvRow::number(size_t cell) const
{
	return parseNumber(cells[cell], where);
}

std::vector<CsvRow> readStampedCsv(const std::string& path, size_t min_cells, const std::string& columns)
{
	std::ifstream file(path);
	if (!file) throw Error(path + ": cannot be read; check that the folder is a complete recording");
	std::vector<CsvRow> rows;
	size_t line_number = 0;
	for (std::string line; std::getline(file, line);)
	{
		++line_number;
		const std::string text = trimmed(line);
		if (text.empty() || text[0] == '#') continue;
		CsvRow row;
		row.where = path + ":" + std::to_string(line_number);
		row.cells = splitCommas(text);
		if (row.cells.size() < min_cells + 1)
			throw Error(row.where + ": " + std::to_string(row.cells.size()) + " columns instead of at least " +
			            std::to_string(min_cells + 1) + " (" + columns + ")");
		row.t_ns = parseStamp(row.cells.front(), row.where);
		row.cells.erase(row.cells.begin());
		if (!rows.empty() && row.t_ns <= rows.back().t_ns)
			throw Error(row.where + ": stamp not later than in the line before; sort the file by time");
		rows.push_back(std::move(row));
	}
	if (rows.empty()) throw Error(path + ": no data in this file");
	return rows;
}
}  // namespace viwo
