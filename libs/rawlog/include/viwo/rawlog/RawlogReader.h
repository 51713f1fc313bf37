#pragma once

#include <mrpt/obs/CObservation.h>

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace viwo
{
struct RigFile;
/** How a rawlog is read. */
struct RawlogReaderOptions
{
	/** Labels to deliver; empty: all. */
	std::vector<std::string> labels;
	/** Observations are sorted by stamp within this span. */
	double reorder_window_s = 0.5;
	/** Observations whose stamp is farther than this from the stream are dropped (and counted), unless the whole stream goes on there; 0:
	 * none are. See StampGate. */
	double max_stamp_jump_s = 60;
	/** The end of a truncated file is an end like any other; see RawlogReader::truncated(). */
	bool allow_truncated = false;
	/** Drop (and count) image observations whose external file is missing, instead of an Error. */
	bool skip_missing_images = false;
	/** Label of the CObservationOdometry made of the actions of an action/sensory-frame rawlog. */
	std::string action_odometry_label = "ODOMETRY";
	/** Calibration that counts instead of the rawlog's; null: the rawlog's. */
	std::shared_ptr<const RigFile> rig;
};

/** What was met so far in a rawlog; whole once the reader has reached the end. */
struct RawlogCounts
{
	struct Sensor
	{
		uint64_t read = 0;                      //!< observations in the file, whether delivered or not
		uint64_t late = 0;                      //!< of these, dropped for coming later than the re-ordering window allows
		uint64_t unstamped = 0;                 //!< of these, dropped for lack of a stamp
		uint64_t stamp_jumps = 0;               //!< of these, dropped for a stamp far from the stream
		uint64_t missing_images = 0;            //!< of these, dropped for lack of the external image file
		int64_t first_t_ns = 0, last_t_ns = 0;  //!< smallest and largest stamp
	};
	/** By (label, class name without namespace); actions count under the label of their odometry. */
	std::map<std::pair<std::string, std::string>, Sensor> sensors;
	uint64_t entries = 0;  //!< objects at the file's top level
	uint64_t late = 0;     //!< sum over the sensors

	/** "CAM (300 CObservationImage), IMU (6000 CObservationIMU)" or "none". */
	std::string describe() const;
};

/** "a.rawlog, b.rawlog": the rawlogs of one run, for messages. */
std::string rawlogNames(const std::vector<std::string>& paths);

/** Streams the observations of a rawlog in the order of their stamps; memory use is that of the re-ordering window.
 *
 *  Both formats are read (observation-only, and actions with sensory frames), compressed by gzip or not. An odometry action becomes a
 *  CObservationOdometry with pose and encoder ticks accumulated from the file's start (absolute, as that class wants them); where it has no
 *  stamp it takes that of the sensory frame after it, as do observations without one. Names of external image files are made absolute:
 *  they are looked for in `<name>_Images/` beside the rawlog, and then in any other `*_Images` folder there (`rawlog-edit --cut` makes no
 * folder).
 *
 *  @code
 *  RawlogReader reader("run.rawlog");
 *  while (auto observation = reader.next()) module.processObservation(observation);
 *  @endcode
 */
class RawlogReader
{
   public:
	/** @throws Error: missing, empty, zstd-compressed, not a rawlog. */
	explicit RawlogReader(const std::string& path, const RawlogReaderOptions& options = {});
	/** Several rawlogs, in the order of their time, as one. A pipe counts as a file; what it gave is kept in a temporary file, so that
	 * other readers of it, too, begin at its beginning. @throws Error as above, for any file that is missing or empty.
	 */
	explicit RawlogReader(const std::vector<std::string>& paths, const RawlogReaderOptions& options = {});
	~RawlogReader();
	RawlogReader(RawlogReader&&) noexcept;

	/** Next observation, or null at the end.
	 *  @throws Error, once all that could be read has been delivered: truncated or damaged file, unknown class. After it next() gives null.
	 *  @throws Error for a missing image file, at the observation's turn in the file; the next call goes on behind it.
	 */
	mrpt::obs::CObservation::Ptr next();

	/** The file ended within an entry (or within its gzip stream). */
	bool truncated() const;

	const RawlogCounts& counts() const;

	/** Text of the CObservationComment entries, which next() leaves out. */
	std::string comment() const;

	/** Folder where external image files were found; "" before the first. */
	const std::string& imagesFolder() const;

	/** Fraction of the (compressed) file read, 0 to 1. */
	double progress() const;

	/** The file that is being read. */
	const std::string& path() const;

   private:
	struct Impl;
	std::unique_ptr<Impl> impl_;
};
}  // namespace viwo
