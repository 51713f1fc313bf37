#pragma once

#include <viwo/core/TextRows.h>

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

	/** @name Of this row, by the place of its column in the constructor's list. */ /** @{ */
	const std::string& cell(size_t column) const { return rows_.words()[places_[column]]; }
	double number(size_t column) const { return rows_.number(places_[column]); }
	int64_t integer(size_t column) const { return rows_.integer(places_[column]); }
	int64_t seconds_ns(size_t column) const { return rows_.seconds_ns(places_[column]); }
	Eigen::Quaterniond rotation(size_t w, size_t x, size_t y, size_t z) const
	{
		return rows_.rotation(places_[w], places_[x], places_[y], places_[z]);
	}
	/** @} */

	/** @throws Error that names file and line. */
	[[noreturn]] void fail(const std::string& what) const { rows_.fail(what); }

   private:
	TextRows rows_;
	std::vector<size_t> places_;
};
}  // namespace viwo
