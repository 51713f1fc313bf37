#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace viwo
{
/** One line of an ASL data.csv. */
struct CsvRow
{
	int64_t t_ns = 0;
	std::vector<std::string> cells;  //!< behind the stamp, blanks trimmed
	std::string where;               //!< "file:line"

	/** @throws Error naming the place when the cell is not a finite number. */
	double number(size_t cell) const;
};

/** Lines of a comma-separated file whose first column is a time in ns; '#' lines and blank lines are skipped.
 *  @param min_cells columns needed behind the stamp.
 *  @throws Error: unreadable, no line, too few columns, no stamp, stamps that do not increase.
 */
std::vector<CsvRow> readStampedCsv(const std::string& path, size_t min_cells, const std::string& columns);

/** A finite number. @throws Error that begins with `where`. */
double parseNumber(const std::string& text, const std::string& where);

/** Words between blanks. */
std::vector<std::string> splitWords(const std::string& line);
}  // namespace viwo
