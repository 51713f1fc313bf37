#pragma once

#include <viwo/evaluation/Json.h>

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace viwo::accuracy
{
/** One bar: a figure and its limits. */
struct Row
{
	std::string name;
	std::string unit;
	double value = std::numeric_limits<double>::quiet_NaN();
	std::optional<double> min, max;
	std::string detail;    //!< e.g. the figure of each seed
	bool skipped = false;  //!< could not be measured here; the detail says why

	/** NaN, the figure of a run that failed, holds nowhere. */
	bool holds() const { return !std::isnan(value) && (!min || value >= *min) && (!max || value <= *max); }
};

/** A bar from above. */
Row atMost(const std::string& name, double value, double limit, const std::string& unit, const std::string& detail);
/** A bar from below. */
Row atLeast(const std::string& name, double value, double limit, const std::string& unit, const std::string& detail);
/** A bar that was not measured. */
Row skippedRow(const std::string& name, const std::string& why);

/** The rows of a run of this program, in the order of the table. */
class Results
{
   public:
	void add(Row row) { rows_.push_back(std::move(row)); }
	const std::vector<Row>& rows() const { return rows_; }

	/** Whether every measured bar holds. */
	bool allHold() const;

	/** `<stem>.json`: all_hold and rows with name, value, limit (a number, or [from, to]), holds (null when skipped), unit, detail.
	 *  `<stem>.md`: the same as a table. @throws Error when they cannot be written. */
	void save(const std::string& stem) const;

	std::string toText() const;

   private:
	std::vector<Row> rows_;
};
}  // namespace viwo::accuracy
