#include "CsvFile.h"

#include <viwo/core/Error.h>
#include <viwo/core/TextRows.h>

#include <charconv>
#include <cmath>
#include <sstream>

namespace viwo
{
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
	TextRows lines(path, TextRows::Split::cells);
	std::vector<CsvRow> rows;
	while (lines.next())
	{
		lines.expectWords(min_cells + 1, true, columns);
		const int64_t t_ns = lines.integer(0);
		if (!rows.empty() && t_ns <= rows.back().t_ns) lines.fail("stamp not later than in the line before; sort the file by time");
		rows.push_back({t_ns, {lines.words().begin() + 1, lines.words().end()}, lines.where()});
	}
	if (rows.empty()) throw Error(path + ": no data in this file");
	return rows;
}
}  // namespace viwo
