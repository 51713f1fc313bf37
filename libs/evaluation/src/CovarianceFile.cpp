#include <viwo/core/Error.h>
#include <viwo/core/TimeText.h>
#include <viwo/evaluation/Consistency.h>

#include <cstdlib>
#include <fstream>
#include <limits>

namespace viwo
{
namespace
{
constexpr size_t kColumns = 23;  // t_s, 21 entries, flag

std::vector<std::string> split(const std::string& line)
{
	std::vector<std::string> cells;
	size_t begin = 0;
	while (true)
	{
		const size_t comma = line.find(',', begin);
		std::string cell = line.substr(begin, comma == std::string::npos ? std::string::npos : comma - begin);
		const size_t first = cell.find_first_not_of(" \t\r");
		const size_t last = cell.find_last_not_of(" \t\r");
		cells.push_back(first == std::string::npos ? "" : cell.substr(first, last - first + 1));
		if (comma == std::string::npos) return cells;
		begin = comma + 1;
	}
}

class CovarianceReader
{
   public:
	explicit CovarianceReader(const std::string& path) : path_(path) {}

	std::vector<StampedCovariance> read()
	{
		std::ifstream file(path_);
		if (!file) throw Error(path_ + ": cannot be read");
		std::string line;
		bool header = false;
		while (std::getline(file, line))
		{
			++line_number_;
			if (line.find_first_not_of(" \t\r") == std::string::npos || line[0] == '#') continue;
			const auto cells = split(line);
			if (cells.size() != kColumns)
				fail(std::to_string(cells.size()) + " columns instead of 23 (t_s, 21 of the upper triangle, flag)");
			if (!header && cells[0] != "t_s") fail("the header line that begins with t_s is missing");
			if (header) append(cells);
			header = true;
		}
		if (entries_.empty()) throw Error(path_ + ": holds no covariance");
		return std::move(entries_);
	}

   private:
	[[noreturn]] void fail(const std::string& what) const { throw Error(path_ + ":" + std::to_string(line_number_) + ": " + what); }

	double number(const std::string& cell) const
	{
		if (cell.empty()) return std::numeric_limits<double>::quiet_NaN();
		char* end = nullptr;
		const double value = std::strtod(cell.c_str(), &end);
		if (*end != '\0') fail("'" + cell + "' is not a number");
		return value;
	}

	void append(const std::vector<std::string>& cells)
	{
		StampedCovariance entry;
		const auto t_ns = parseSeconds(cells[0]);
		if (!t_ns) fail("'" + cells[0] + "' is not a time in seconds");
		entry.t_ns = *t_ns;
		if (!entries_.empty() && entry.t_ns <= entries_.back().t_ns) fail("time stamps do not increase");
		size_t cell = 1;
		for (int row = 0; row < 6; ++row)
			for (int column = row; column < 6; ++column, ++cell)
				entry.covariance(row, column) = entry.covariance(column, row) = number(cells[cell]);
		entry.flag = cells.back();
		entries_.push_back(std::move(entry));
	}

	std::string path_;
	size_t line_number_ = 0;
	std::vector<StampedCovariance> entries_;
};
}  // namespace

std::vector<StampedCovariance> loadCovariances(const std::string& csv_path)
{
	return CovarianceReader(csv_path).read();
}
}  // namespace viwo
