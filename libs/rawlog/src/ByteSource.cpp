#include "ByteSource.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>
#include <viwo/core/Error.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <mutex>

namespace fs = std::filesystem;

namespace viwo
{
namespace
{
Error cannotOpen(const std::string& path)
{
	return Error(path + ": cannot open this rawlog: " + std::strerror(errno) + "; check its name and permissions");
}

bool isPipe(const std::string& path)
{
	std::error_code ignored;
	const auto type = fs::status(path, ignored).type();
	return type == fs::file_type::fifo || type == fs::file_type::character || type == fs::file_type::socket;
}
}  // namespace

class PipeSpool
{
   public:
	/** The one of this pipe, for as long as the program runs: what was read from a pipe cannot be read again. */
	static std::shared_ptr<PipeSpool> of(const std::string& path)
	{
		static std::mutex mutex;
		static std::map<std::string, std::shared_ptr<PipeSpool>> spools;
		const std::lock_guard<std::mutex> lock(mutex);
		std::shared_ptr<PipeSpool>& spool = spools[path];
		if (!spool) spool = std::make_shared<PipeSpool>(path);
		return spool;
	}

	// A pipe that nobody writes to yet is waited for where it is read: there a signal is heard.
	explicit PipeSpool(const std::string& path) : pipe_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)), kept_(std::tmpfile())
	{
		if (pipe_ < 0) throw cannotOpen(path);
		if (!kept_)
			throw Error(path + ": no temporary file for what comes out of this pipe: " + std::strerror(errno) + "; make room in /tmp");
	}
	~PipeSpool()
	{
		::close(pipe_);
		std::fclose(kept_);
	}
	PipeSpool(const PipeSpool&) = delete;
	PipeSpool& operator=(const PipeSpool&) = delete;

	/** @return bytes read, 0 at the end, -1 after an error; a signal ends what is read, for the program may have been asked to stop. */
	ssize_t read(size_t position, void* target, size_t length)
	{
		const std::lock_guard<std::mutex> lock(mutex_);
		if (position == size_) return readOn(target, length);
		if (std::fseek(kept_, static_cast<long>(position), SEEK_SET) != 0) return -1;
		const size_t count = std::fread(target, 1, std::min(length, size_ - position), kept_);
		return count > 0 ? static_cast<ssize_t>(count) : -1;
	}

   private:
	ssize_t readOn(void* target, size_t length)
	{
		// Unlike a read that waits, poll() is ended by a signal in any case.
		pollfd ready = {pipe_, POLLIN, 0};
		if (::poll(&ready, 1, -1) < 0) return errno == EINTR ? 0 : -1;
		const ssize_t count = ::read(pipe_, target, length);
		if (count <= 0) return count < 0 && errno == EINTR ? 0 : count;
		if (std::fseek(kept_, 0, SEEK_END) != 0) return -1;
		if (std::fwrite(target, 1, static_cast<size_t>(count), kept_) != static_cast<size_t>(count)) return -1;
		size_ += static_cast<size_t>(count);
		return count;
	}

	std::mutex mutex_;
	int pipe_;
	std::FILE* kept_;
	size_t size_ = 0;
};

ByteSource::ByteSource(const std::string& path)
{
	if (isPipe(path))
	{
		pipe_ = PipeSpool::of(path);
		return;
	}
	errno = 0;
	file_.open(path, std::ios::binary);
	if (!file_) throw cannotOpen(path);
}

ByteSource::~ByteSource() = default;

size_t ByteSource::read(void* target, size_t length)
{
	if (!pipe_)
	{
		file_.read(static_cast<char*>(target), static_cast<std::streamsize>(length));
		failed_ = file_.bad();
		return static_cast<size_t>(file_.gcount());
	}
	const ssize_t count = pipe_->read(position_, target, length);
	failed_ = count < 0;
	if (count > 0) position_ += static_cast<size_t>(count);
	return count > 0 ? static_cast<size_t>(count) : 0;
}
}  // namespace viwo
