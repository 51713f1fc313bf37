#pragma once

#include <string>
#include <vector>

namespace viwo
{
/** Endings of the files that stand beside a rawlog X.rawlog, as X_ground_truth.tum. @{ */
constexpr char kGroundTruthEnding[] = "_ground_truth.tum";
constexpr char kGpsEnding[] = "_gps.tum";
constexpr char kStampsEnding[] = "_stamps.csv";
/** @} */

std::string besideRawlog(const std::string& rawlog_path, const std::string& ending);

/** Files under these names that an import into rawlog_path has not written belong to another one: they become NAME.old, or
 *  NAME.old2 and so on, as someone may have made them with effort. @param written the paths that the import did write. @return a note for
 * each. */
std::vector<std::string> putAsideOthers(const std::string& rawlog_path, const std::vector<std::string>& written);
}  // namespace viwo
