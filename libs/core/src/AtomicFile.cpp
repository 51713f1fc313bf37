#include <viwo/core/AtomicFile.h>
#include <viwo/core/Error.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

namespace fs = std::filesystem;

namespace viwo
{
AtomicFile::AtomicFile(const std::string& path) : path_(path)
{
	std::error_code ignored;
	if (fs::is_symlink(path_, ignored)) path_ = fs::weakly_canonical(path_, ignored).string();
	if (fs::is_directory(path_, ignored)) throw Error(path + ": cannot write: it is a folder; give the name of a file");
	const fs::path folder = fs::path(path_).parent_path();
	if (!folder.empty() && !fs::is_directory(folder, ignored))
		throw Error(path + ": cannot write: there is no folder " + folder.string() + "; create it first");

	// A device or pipe (/dev/stdout) is written as it is: renaming would replace it.
	const bool special = fs::exists(path_, ignored) && !fs::is_regular_file(path_, ignored);
	temporary_path_ = special ? path_ : path_ + ".part";
	errno = 0;
	stream_.open(temporary_path_, std::ios::binary | std::ios::trunc);
	if (!stream_) throw Error(path + ": cannot write: " + std::strerror(errno) + "; check the permissions of the folder");
}

AtomicFile::~AtomicFile()
{
	if (committed_ || temporary_path_ == path_) return;
	stream_.close();
	std::remove(temporary_path_.c_str());
}

void AtomicFile::commit()
{
	errno = 0;
	stream_.close();
	if (!stream_) throw Error(path_ + ": cannot write: " + (errno != 0 ? std::strerror(errno) : "write failed") + "; is the disk full?");
	if (temporary_path_ != path_ && std::rename(temporary_path_.c_str(), path_.c_str()) != 0)
		throw Error(path_ + ": cannot rename " + temporary_path_ + ": " + std::strerror(errno));
	committed_ = true;
}

void writeAtomically(const std::string& path, const std::string& content)
{
	AtomicFile file(path);
	file.stream() << content;
	file.commit();
}
}  // namespace viwo
