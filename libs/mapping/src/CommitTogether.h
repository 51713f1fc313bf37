#pragma once

#include <viwo/core/AtomicFile.h>

#include <vector>

namespace viwo
{
/** All files appear, or none: what does not fit on the disk shows when it is flushed, before any of them has its name. */
inline void commitTogether(const std::vector<AtomicFile*>& files)
{
	for (AtomicFile* file : files)
		if (!file->stream().flush()) file->commit();  // tells what failed
	for (AtomicFile* file : files) file->commit();
}
}  // namespace viwo
