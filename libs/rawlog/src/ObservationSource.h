#pragma once

#include <mrpt/obs/CObservation.h>
#include <viwo/rawlog/RawlogReader.h>

#include <optional>
#include <string>
#include <vector>

#include "ActionOdometry.h"
#include "GzipArchive.h"

namespace viwo
{
/** Without namespace. */
std::string shortClassName(const mrpt::obs::CObservation& observation);

/** The observations of a rawlog of either format in the order of the file. */
class ObservationSource
{
   public:
	/** @param action_odometry on which the file's actions build.
	 *  @throws Error: cannot be opened, no entries, zstd-compressed, not a rawlog.
	 */
	ObservationSource(const std::string& path, const ActionOdometry& action_odometry);

	/** The observations of the next entry (none, one, or those of a sensory frame and the actions before it); false at the end,
	 *  where actions that never got a stamp come first, without one.
	 *  @throws Error for damage; truncated() tells whether it was that.
	 */
	bool readEntry(std::vector<mrpt::obs::CObservation::Ptr>& observations);

	bool truncated() const { return archive_.state() == GzipArchiveReader::State::truncated; }
	uint64_t entries() const { return entries_; }
	const std::string& comment() const { return comment_; }
	double progress() const;
	const ActionOdometry& actionOdometry() const { return action_odometry_; }

   private:
	mrpt::serialization::CSerializable::Ptr readObject();
	void addEntry(const mrpt::serialization::CSerializable::Ptr& object, std::vector<mrpt::obs::CObservation::Ptr>& observations);
	[[noreturn]] void failOnObject(const std::string& mrpt_message) const;

	std::string path_;
	GzipArchiveReader archive_;
	ActionOdometry action_odometry_;
	std::vector<mrpt::obs::CObservation::Ptr> waiting_;  //!< odometry of actions without a stamp
	std::string comment_;
	uint64_t entries_ = 0, file_bytes_ = 0;
};
}  // namespace viwo
