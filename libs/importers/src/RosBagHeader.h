#pragma once

#include <string>

namespace viwo
{
/** Looks at the first bytes of a file: a ROS 1 bag of format 2.0 that can be read from its index.
 *  @throws Error, one line with the remedy: missing, empty, a folder, a ROS 2 bag (sqlite3, MCAP), an old format, encrypted, unindexed
 * (its recording was not ended), truncated, not a bag.
 */
void requireReadableBag(const std::string& path);
}  // namespace viwo
