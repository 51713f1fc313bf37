#pragma once

#include <chrono>
#include <map>
#include <string>
#include <vector>

namespace viwo
{
/** How long each stage took, call by call (mrpt::system::CTimeLogger keeps no distribution). Nested stages of different names are fine. */
class StageTimes
{
   public:
	struct Statistics
	{
		size_t calls = 0;
		double mean_ms = 0, median_ms = 0, p95_ms = 0, max_ms = 0;
	};

	void begin(const std::string& stage);
	/** Throws nothing, as it is called where others have thrown: without memory the call is not counted. */
	void end(const std::string& stage) noexcept;

	Statistics statistics(const std::string& stage) const;
	/** Of the calls with these indices, [from, to). */
	Statistics statistics(const std::string& stage, size_t from, size_t to) const;
	std::vector<std::string> stages() const;

   private:
	struct Stage
	{
		std::chrono::steady_clock::time_point begin;
		std::vector<float> ms;
	};
	std::map<std::string, Stage> stages_;
};
}  // namespace viwo
