#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ObservationSource.h"

namespace viwo
{
/** Several rawlogs, one behind the other, as if they were one; odometry of actions goes on from file to file. */
class RawlogSequence
{
   public:
	/** @throws Error: none given, one of them missing or empty, the first zstd-compressed or not a rawlog. */
	RawlogSequence(std::vector<std::string> paths, const std::string& action_odometry_label, bool allow_truncated);

	/** As ObservationSource::readEntry; false at the end of the last. A truncated file that is allowed ends like any other.
	 *  @throws Error for damage, and for a later file that is no rawlog.
	 */
	bool readEntry(std::vector<mrpt::obs::CObservation::Ptr>& observations);

	/** The file of the last entry. */
	const std::string& path() const { return paths_[file_]; }
	size_t file() const { return file_; }
	const std::string& pathBefore() const { return paths_[file_ - 1]; }

	bool truncated() const { return truncated_; }
	uint64_t entries() const { return entries_before_ + source_->entries(); }
	std::string comment() const { return comments_before_ + source_->comment(); }
	/** Fraction of the bytes, 0 to 1; of pipes 0. */
	double progress() const;

   private:
	bool readOfFile(std::vector<mrpt::obs::CObservation::Ptr>& observations);

	std::vector<std::string> paths_;
	bool allow_truncated_;
	size_t file_ = 0;
	std::unique_ptr<ObservationSource> source_;
	uint64_t entries_before_ = 0;
	std::string comments_before_;
	bool truncated_ = false;
	double bytes_ = 0, bytes_before_ = 0;
};
}  // namespace viwo
