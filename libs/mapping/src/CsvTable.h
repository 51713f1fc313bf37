#pragma once

#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

namespace viwo
{
/** Chosen columns of a comma-separated file: '#' lines are skipped, the first other line names the columns. */
class CsvTable
{
   public:
	/** @throws Error: unreadable, a column is missing. */
	CsvTable(const std::string& path, const std::vector<std::string>& columns);

	/** Goes to the next row. @throws Error when it has too few cells. @return false at the end. */
	bool next();

	/** Of this row, by the place of its column in the constructor's list. */
	const std::string& cell(size_t column) const { return cells_[column]; }
	double number(size_t column) const;
	int64_t integer(size_t column) const;

	/** @throws Error that names file and line. */
	[[noreturn]] void fail(const std::string& what) const;

   private:
	bool nextLine(std::vector<std::string>& words);

	std::string path_;
	std::ifstream file_;
	int line_ = 0;
	std::vector<size_t> places_;
	std::vector<std::string> cells_;
};
}  // namespace viwo
