#pragma once

#include <viwo/mapping/OctreeFiles.h>

#include <cstddef>
#include <istream>

namespace viwo
{
/** Whether the data of a tree are all there and no deeper than a tree is: liboctomap itself goes on beyond the end of a file that was cut
 *  short, until the stack overflows.
 *  @param value_bytes of a node in a .ot file. The stream is left where it was.
 */
bool isWholeOctree(std::istream& file, OctreeFormat format, size_t value_bytes);
}  // namespace viwo
