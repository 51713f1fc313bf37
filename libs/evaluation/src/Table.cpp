#include <viwo/core/Svg.h>
#include <viwo/evaluation/Table.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace viwo
{
namespace
{
/** Characters as a terminal counts them: continuation bytes of UTF-8 have no width. */
size_t widthOf(const std::string& text)
{
	return static_cast<size_t>(
	    std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string padded(const std::string& text, size_t width, bool left)
{
	const std::string blanks(width - std::min(width, widthOf(text)), ' ');
	return left ? text + blanks : blanks + text;
}

std::string line(const std::vector<std::string>& cells, const std::vector<size_t>& widths, const std::vector<Table::Column>& columns)
{
	std::string text;
	for (size_t i = 0; i < cells.size(); ++i) text += (i == 0 ? "" : "  ") + padded(cells[i], widths[i], columns[i].left);
	text.erase(text.find_last_not_of(' ') + 1);
	return text + "\n";
}

std::string escaped(const std::string& text)
{
	std::string out;
	for (const char c : text) out += c == '|' ? std::string("\\|") : std::string(1, c);
	return out;
}

/** Names like "x-y" are not parted at their hyphen. */
std::string headerHtml(const std::string& name)
{
	std::string html;
	std::istringstream words(name);
	for (std::string word; words >> word;)
	{
		const std::string text = escapedForXml(word);
		html += (html.empty() ? "" : " ") + (word.find('-') == std::string::npos ? text : "<span class=\"w\">" + text + "</span>");
	}
	return html;
}

/** Longer texts may have more than one line. */
constexpr size_t kLongText = 40;
}  // namespace

Table::Table(std::vector<Column> columns) : columns_(std::move(columns)) {}

void Table::addRow(std::vector<std::string> cells, std::set<size_t> bold)
{
	if (cells.size() != columns_.size()) throw std::invalid_argument("a row needs as many cells as the table has columns");
	rows_.push_back(std::move(cells));
	bold_.push_back(std::move(bold));
}

std::string Table::toText() const
{
	std::vector<std::string> names, units;
	std::vector<size_t> widths;
	for (const Column& column : columns_)
	{
		names.push_back(column.name);
		units.push_back(column.unit);
		widths.push_back(std::max(widthOf(column.name), widthOf(column.unit)));
	}
	for (const auto& row : rows_)
		for (size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], widthOf(row[i]));

	size_t total = 2 * (columns_.size() - 1);
	for (const size_t width : widths) total += width;
	std::string text = line(names, widths, columns_);
	if (std::any_of(units.begin(), units.end(), [](const std::string& u) { return !u.empty(); })) text += line(units, widths, columns_);
	text += std::string(total, '-') + "\n";
	for (const auto& row : rows_) text += line(row, widths, columns_);
	return text;
}

std::string Table::toMarkdown() const
{
	std::string header = "|", rule = "|";
	for (const Column& column : columns_)
	{
		header += " " + escaped(column.name) + (column.unit.empty() ? "" : " (" + escaped(column.unit) + ")") + " |";
		rule += column.left ? "---|" : "---:|";
	}
	std::string text = header + "\n" + rule + "\n";
	for (size_t r = 0; r < rows_.size(); ++r)
	{
		text += "|";
		for (size_t i = 0; i < rows_[r].size(); ++i)
		{
			const std::string mark = bold_[r].count(i) != 0 ? "**" : "";
			text += " " + mark + escaped(rows_[r][i]) + mark + " |";
		}
		text += "\n";
	}
	return text;
}

std::string Table::toCsv() const
{
	const auto quoted = [](const std::string& cell)
	{
		if (cell.find_first_of(",\"\n") == std::string::npos) return cell;
		std::string text = "\"";
		for (const char c : cell) text += c == '"' ? std::string("\"\"") : std::string(1, c);
		return text + "\"";
	};
	std::string text;
	for (size_t i = 0; i < columns_.size(); ++i)
		text += (i == 0 ? "" : ",") + quoted(columns_[i].name + (columns_[i].unit.empty() ? "" : " (" + columns_[i].unit + ")"));
	text += "\n";
	for (const auto& row : rows_)
	{
		for (size_t i = 0; i < row.size(); ++i) text += (i == 0 ? "" : ",") + quoted(row[i]);
		text += "\n";
	}
	return text;
}

std::string Table::toHtml() const
{
	const auto kind = [this](size_t i) { return columns_[i].left ? std::string(" class=\"l\"") : std::string(); };
	std::string html = "<table>\n<thead><tr>";
	for (size_t i = 0; i < columns_.size(); ++i)
		html += "<th scope=\"col\"" + kind(i) + ">" + headerHtml(columns_[i].name) +
		        (columns_[i].unit.empty() ? "" : " <small>" + escapedForXml(columns_[i].unit) + "</small>") + "</th>";
	html += "</tr></thead>\n<tbody>\n";
	for (size_t r = 0; r < rows_.size(); ++r)
	{
		html += "<tr>";
		for (size_t i = 0; i < rows_[r].size(); ++i)
		{
			const std::string content = escapedForXml(rows_[r][i]);
			const bool is_long = columns_[i].left && widthOf(rows_[r][i]) > kLongText;
			html += "<td" + (is_long ? " class=\"l long\"" : kind(i)) + ">" +
			        (bold_[r].count(i) != 0 ? "<b>" + content + "</b>" : content) + "</td>";
		}
		html += "</tr>\n";
	}
	return html + "</tbody>\n</table>\n";
}
}  // namespace viwo
