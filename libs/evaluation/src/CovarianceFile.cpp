#include <viwo/core/Error.h>
#include <viwo/core/TextRows.h>
#include <viwo/evaluation/Consistency.h>

#include <limits>

namespace viwo
{
namespace
{
constexpr size_t kColumns = 23;  // t_s, 21 entries, flag

StampedCovariance covarianceOf(const TextRows& rows)
{
	StampedCovariance entry;
	entry.t_ns = rows.seconds_ns(0);
	size_t cell = 1;
	for (int row = 0; row < 6; ++row)
		for (int column = row; column < 6; ++column, ++cell)
		{
			const std::string& text = rows.words()[cell];
			const bool has_none = text.empty() || text == "nan";
			entry.covariance(row, column) = entry.covariance(column, row) =
			    has_none ? std::numeric_limits<double>::quiet_NaN() : rows.number(cell);
		}
	entry.flag = rows.words().back();
	return entry;
}
}  // namespace

std::vector<StampedCovariance> loadCovariances(const std::string& csv_path)
{
	TextRows rows(csv_path, TextRows::Split::cells);
	std::vector<StampedCovariance> entries;
	for (bool header = true; rows.next(); header = false)
	{
		rows.expectWords(kColumns, false, "t_s, 21 of the upper triangle, flag");
		if (header && rows.words()[0] != "t_s") rows.fail("the header line that begins with t_s is missing");
		if (header) continue;
		entries.push_back(covarianceOf(rows));
		if (entries.size() > 1 && entries.back().t_ns <= (entries.end() - 2)->t_ns) rows.fail("time stamps do not increase");
	}
	if (entries.empty()) throw Error(csv_path + ": holds no covariance");
	return entries;
}
}  // namespace viwo
