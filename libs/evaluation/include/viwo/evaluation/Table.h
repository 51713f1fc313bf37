#pragma once

#include <viwo/core/NumberText.h>

#include <set>
#include <string>
#include <vector>

namespace viwo
{
/** A table of results: the first column to the left, numbers to the right, units in the header. */
class Table
{
   public:
	struct Column
	{
		std::string name;
		std::string unit;   //!< empty for none
		bool left = false;  //!< text to the left
	};

	explicit Table(std::vector<Column> columns);

	/** @pre as many cells as columns. @param bold indices of the cells that stand out (in Markdown and HTML). */
	void addRow(std::vector<std::string> cells, std::set<size_t> bold = {});

	/** Aligned columns, two spaces apart, units in a second header line, one newline at the end of each line. */
	std::string toText() const;
	/** GitHub's Markdown, units in the header in parentheses. */
	std::string toMarkdown() const;
	/** RFC 4180: a header line with the units in the names ("ATE (m)"), one line a row. */
	std::string toCsv() const;
	/** A `table` element with a head, units in small print below the names. */
	std::string toHtml() const;

   private:
	std::vector<Column> columns_;
	std::vector<std::vector<std::string>> rows_;
	std::vector<std::set<size_t>> bold_;  //!< of each row
};
}  // namespace viwo
