#pragma once

#include <string>

namespace viwo
{
/** Full path of a file or folder of share/viwo, e.g. "config_files/viwo-odometry/default.ini": under $VIWO_SHARE, then beside the installed
 *  program (../share/viwo), then in the source tree that the library was built from. @throws Error that names the places looked at.
 */
std::string findShare(const std::string& relative);
}  // namespace viwo
