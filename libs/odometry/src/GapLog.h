#pragma once

#include <viwo/odometry/OdometryOptions.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace viwo
{
/** Times without data of a sensor that the mode uses, longer than the estimator bridges. */
class GapLog
{
   public:
	struct Gap
	{
		std::string label;
		int64_t begin_ns = 0;
		double duration_s = 0;
	};

	explicit GapLog(const OdometryOptions& options);

	/** The next observation of the log. @return the gap that ends with it, if there is one. */
	std::optional<Gap> add(const std::string& label, int64_t t_ns);
	/** The log ends: sensors that were silent by then have a gap up to there. */
	void finish(int64_t t_ns);
	const std::vector<Gap>& gaps() const { return gaps_; }
	size_t count(const std::string& label) const;

   private:
	std::map<std::string, double> longest_s_;  //!< by label
	std::map<std::string, int64_t> last_ns_;
	std::vector<Gap> gaps_;
};
}  // namespace viwo
