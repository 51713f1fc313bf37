#pragma once

#include <viwo/estimator/Estimator.h>

namespace viwo
{
/** The estimator's status and how it came to it. */
class StatusLog
{
   public:
	explicit StatusLog(const WindowOptions& options) : options_(options) {}

	Status now() const { return now_; }
	const std::vector<StatusChange>& changes() const { return changes_; }

	void set(Status to, int64_t t_ns, const std::string& cause);

	/** After a frame was solved.
	 *  @param known landmarks of known depth that it sees. @param seen landmarks that it sees at all: turning on the spot shows plenty of
	 * them, none with a depth, and is no loss of the camera.
	 */
	void update(int64_t t_ns, int known, int seen);

   private:
	WindowOptions options_;
	Status now_ = Status::waiting;
	std::vector<StatusChange> changes_;
	int64_t last_good_ns_ = 0;
};
}  // namespace viwo
