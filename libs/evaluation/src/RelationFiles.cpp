#include <viwo/core/CsvTable.h>
#include <viwo/core/Error.h>
#include <viwo/evaluation/RelationErrors.h>

namespace viwo
{
std::vector<Relation> loadRelations(const std::string& path)
{
	TextRows rows(path, TextRows::Split::blanks);
	std::vector<Relation> relations;
	while (rows.next())
	{
		rows.expectWords(8, true, "t1 t2 x y z roll pitch yaw");
		relations.push_back({rows.seconds_ns(0), rows.seconds_ns(1), rows.number(2), rows.number(3), rows.number(7)});
	}
	if (relations.empty()) throw Error(path + ": holds no relation (t1 t2 x y z roll pitch yaw)");
	return relations;
}

StampTable loadStampTable(const std::string& path)
{
	CsvTable rows(path, {"rawlog_ns", "original_s"});
	StampTable table;
	while (rows.next()) table[toMicroseconds(rows.seconds_ns(1))] = rows.integer(0);
	if (table.empty()) throw Error(path + ": holds no stamps");
	return table;
}
}  // namespace viwo
