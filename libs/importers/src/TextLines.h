#pragma once

#include <viwo/core/Error.h>

#include <cstddef>
#include <string>
#include <vector>

namespace viwo
{
/** A file of another kind than the reader's. */
class OtherFormat : public Error
{
   public:
	using Error::Error;
};

/** The lines of a text file that may be compressed by gzip or bzip2 (told by its first bytes, not by its name), line ends removed.
 *  @throws Error: missing, a folder, not text (OtherFormat), damaged or cut compression.
 */
std::vector<std::string> readTextLines(const std::string& path);
}  // namespace viwo
