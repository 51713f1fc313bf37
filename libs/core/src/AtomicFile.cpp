#include <viwo/core/AtomicFile.h>
#include <viwo/core/Error.h>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

namespace fs = std::filesystem;

namespace viwo
{
namespace
{
/** A device or pipe (/dev/stdout) is written as it is: renaming would replace it. */
bool isSpecial(const std::string& path)
{
	std::error_code ignored;
	return fs::exists(path, ignored) && !fs::is_regular_file(path, ignored) && !fs::is_directory(path, ignored);
}
}  // namespace

AtomicFile::AtomicFile(const std::string& path) : path_(path)
{
	std::error_code ignored;
	if (fs::is_symlink(path_, ignored)) path_ = fs::weakly_canonical(path_, ignored).string();
	if (fs::is_directory(path_, ignored)) throw Error(path + ": cannot write: it is a folder; give the name of a file");
	const fs::path folder = fs::path(path_).parent_path();
	if (!folder.empty() && !fs::is_directory(folder, ignored))
		throw Error(path + ": cannot write: there is no folder " + folder.string() + "; create it first");

	const bool special = isSpecial(path_);
	temporary_path_ = special ? path_ : path_ + ".part";
	if (!special) lock();
	errno = 0;
	stream_.open(temporary_path_, std::ios::binary | std::ios::trunc);
	if (!stream_) throw Error(path + ": cannot write: " + std::strerror(errno) + "; check the permissions of the folder");
}

/** Two programs that write one file at once would mix their lines. What a killed program has left behind holds no lock. */
void AtomicFile::lock()
{
	for (;;)
	{
		lock_ = ::open(temporary_path_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
		if (lock_ < 0) throw Error(path_ + ": cannot write: " + std::strerror(errno) + "; check the permissions of the folder");
		const bool taken = ::flock(lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
		struct stat mine = {}, there = {};
		// Between open() and flock() the other program may have given the file its final name.
		const bool same =
		    !taken && ::fstat(lock_, &mine) == 0 && ::stat(temporary_path_.c_str(), &there) == 0 && mine.st_ino == there.st_ino;
		if (same) return;
		::close(lock_);
		lock_ = -1;
		if (taken) throw Error(path_ + ": another program is writing this file; wait for its end, or write to another folder");
	}
}

AtomicFile::~AtomicFile()
{
	if (!committed_ && temporary_path_ != path_)
	{
		stream_.close();
		std::remove(temporary_path_.c_str());
	}
	if (lock_ >= 0) ::close(lock_);
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

void requireWritable(const std::string& path)
{
	// A pipe that is opened and closed again has ended for its reader.
	if (!isSpecial(path)) AtomicFile probe(path);
}
}  // namespace viwo
