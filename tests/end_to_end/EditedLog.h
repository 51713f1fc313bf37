#pragma once

#include <viwo/core/Time.h>
#include <viwo/rawlog/MrptTime.h>
#include <viwo/rawlog/RawlogReader.h>
#include <viwo/rawlog/RawlogWriter.h>

#include <filesystem>
#include <functional>
#include <string>

#include "TempFolder.h"

namespace viwo::testing
{
/** What becomes of an observation on its way into an edited log; writes as many as it likes. t_s: since the first. */
using Edit = std::function<void(mrpt::obs::CObservation& observation, double t_s, RawlogWriter& writer)>;

/** Copies the first seconds of a log into folder/bad.rawlog, each observation through the edit; the images stay where they are.
 *  @return the path of the copy.
 */
inline std::string editedLog(const std::string& rawlog, const TempFolder& folder, double duration_s, const Edit& edit)
{
	const std::string path = folder.file("bad.rawlog");
	RawlogReader reader(rawlog);
	RawlogWriter writer(path);
	int64_t begin_ns = 0;
	while (const auto observation = reader.next())
	{
		const int64_t t_ns = nanosecondsOf(observation->timestamp);
		if (begin_ns == 0) begin_ns = t_ns;
		const double t_s = secondsBetween(begin_ns, t_ns);
		if (t_s > duration_s) break;
		if (const auto image = std::dynamic_pointer_cast<mrpt::obs::CObservationImage>(observation))
			image->image.setExternalStorage(std::filesystem::path(image->image.getExternalStorageFile()).filename().string());
		edit(*observation, t_s, writer);
	}
	writer.close();
	std::filesystem::create_directory_symlink(reader.imagesFolder(), folder.file("bad_Images"));
	return path;
}

inline bool isImu(const mrpt::obs::CObservation& observation)
{
	return observation.sensorLabel == "IMU";
}
inline bool isImage(const mrpt::obs::CObservation& observation)
{
	return observation.sensorLabel == "CAM";
}
inline bool isOdometry(const mrpt::obs::CObservation& observation)
{
	return observation.sensorLabel == "ODOMETRY";
}

/** Moves the stamp of an observation. */
inline void shiftStamp(mrpt::obs::CObservation& observation, double by_s)
{
	observation.timestamp = mrptTime(nanosecondsOf(observation.timestamp) + nanoseconds(by_s));
}
}  // namespace viwo::testing
