#pragma once

#include <mrpt/serialization/CSerializable.h>

#include <string>

namespace viwo
{
/** One object of MRPT in a file of its own, compressed by gzip, as MRPT's programs load it. It appears whole or not at all; the same object
 *  gives the same bytes.
 *  @throws Error when it cannot be written.
 */
void saveObject(const std::string& path, const mrpt::serialization::CSerializable& object);
}  // namespace viwo
