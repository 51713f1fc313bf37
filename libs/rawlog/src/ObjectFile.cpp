#include <viwo/core/AtomicFile.h>
#include <viwo/rawlog/ObjectFile.h>

#include "GzipArchive.h"

namespace viwo
{
void saveObject(const std::string& path, const mrpt::serialization::CSerializable& object)
{
	AtomicFile file(path);
	GzipArchiveWriter archive(file.stream());
	archive.WriteObject(object);
	archive.finish();
	file.commit();
}
}  // namespace viwo
