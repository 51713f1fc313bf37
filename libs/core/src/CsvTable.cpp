#include <viwo/core/CsvTable.h>
#include <viwo/core/Error.h>
#include <viwo/core/NumberText.h>

#include <algorithm>

namespace viwo
{
CsvTable::CsvTable(const std::string& path, const std::vector<std::string>& columns) : rows_(path, TextRows::Split::cells)
{
	if (!rows_.next()) throw Error(path + ": no line names the columns");
	const std::vector<std::string>& names = rows_.words();
	for (const std::string& column : columns)
	{
		const auto at = std::find(names.begin(), names.end(), column);
		if (at == names.end()) fail("there is no column '" + column + "'");
		places_.push_back(static_cast<size_t>(at - names.begin()));
	}
}

bool CsvTable::next()
{
	if (!rows_.next()) return false;
	for (const size_t place : places_)
		if (place >= rows_.words().size()) fail("only " + counted(rows_.words().size(), "cell") + " in this row");
	return true;
}
}  // namespace viwo
