#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace viwo
{
/** The lines of a text file that may be compressed by gzip or bzip2 (told by its first bytes, not by its name), line ends removed.
 *  @throws Error: missing, a folder, not text, damaged or cut compression.
 */
std::vector<std::string> readTextLines(const std::string& path);
}  // namespace viwo
