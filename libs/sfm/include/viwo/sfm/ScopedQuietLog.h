#pragma once

namespace viwo
{
/** While it lives, Ceres' warnings are not printed: a failed step is an ordinary event of a solve, and its outcome is in the summary. */
class ScopedQuietLog
{
   public:
	ScopedQuietLog();
	~ScopedQuietLog();
	ScopedQuietLog(const ScopedQuietLog&) = delete;
	ScopedQuietLog& operator=(const ScopedQuietLog&) = delete;

   private:
	int previous_level_;
};
}  // namespace viwo
