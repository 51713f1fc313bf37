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

	/** After a frame was solved: landmarks of known depth that it sees, and their number needed. */
	void update(int64_t t_ns, int known_landmarks, bool has_camera);

   private:
	WindowOptions options_;
	Status now_ = Status::waiting;
	std::vector<StatusChange> changes_;
	int64_t last_good_ns_ = 0;
};
}  // namespace viwo
