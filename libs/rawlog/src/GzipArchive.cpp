#include "GzipArchive.h"

#include <viwo/core/Error.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace viwo
{
namespace
{
constexpr size_t kBuffer_bytes = size_t{1} << 16;
constexpr int kGzipWithLargestWindow = 15 + 16;
constexpr int kCompressionLevel = 1;  // as rawlog-edit: the images, most of a rawlog, are compressed already
}  // namespace

GzipArchiveReader::GzipArchiveReader(const std::string& path) : buffer_(kBuffer_bytes)
{
	errno = 0;
	file_ = gzopen(path.c_str(), "rb");
	if (!file_) throw Error(path + ": cannot open this rawlog: " + std::strerror(errno) + "; check its name and permissions");
	gzbuffer(file_, static_cast<unsigned>(kBuffer_bytes));
}

GzipArchiveReader::~GzipArchiveReader()
{
	gzclose(file_);
}

void GzipArchiveReader::fill(size_t count)
{
	if (end_ - begin_ >= count || state_ != State::good) return;
	std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(begin_), buffer_.begin() + static_cast<std::ptrdiff_t>(end_), buffer_.begin());
	end_ -= begin_;
	begin_ = 0;
	while (end_ < count)
	{
		const int got = gzread(file_, buffer_.data() + end_, static_cast<unsigned>(buffer_.size() - end_));
		int code = Z_OK;
		gzerror(file_, &code);
		if (got > 0) end_ += static_cast<size_t>(got);
		if (got > 0 && code == Z_OK) continue;
		// Z_BUF_ERROR: the file ends before the gzip trailer.
		if (code != Z_OK && code != Z_STREAM_END) state_ = code == Z_BUF_ERROR ? State::truncated : State::damaged;
		return;
	}
}

bool GzipArchiveReader::atEnd()
{
	fill(1);
	return begin_ == end_ && state_ == State::good;
}

std::string GzipArchiveReader::peek(size_t count)
{
	fill(count);
	return {buffer_.data() + begin_, std::min(count, end_ - begin_)};
}

uint64_t GzipArchiveReader::position() const
{
	return static_cast<uint64_t>(std::max<z_off_t>(0, gzoffset(file_)));
}

size_t GzipArchiveReader::read(void* target, size_t length)
{
	char* out = static_cast<char*>(target);
	for (size_t missing = length; missing > 0;)
	{
		fill(1);
		const size_t chunk = std::min(missing, end_ - begin_);
		if (chunk == 0)
		{
			if (state_ == State::good) state_ = State::truncated;
			throw std::runtime_error("unexpected end of file");
		}
		std::memcpy(out, buffer_.data() + begin_, chunk);
		begin_ += chunk;
		out += chunk;
		missing -= chunk;
	}
	return length;
}

GzipArchiveWriter::GzipArchiveWriter(std::ostream& target) : target_(target), output_(kBuffer_bytes)
{
	constexpr int kDefaultMemoryLevel = 8;
	if (deflateInit2(&stream_, kCompressionLevel, Z_DEFLATED, kGzipWithLargestWindow, kDefaultMemoryLevel, Z_DEFAULT_STRATEGY) != Z_OK)
		throw std::bad_alloc();
}

GzipArchiveWriter::~GzipArchiveWriter()
{
	deflateEnd(&stream_);
}

void GzipArchiveWriter::deflateInput(int flush)
{
	do
	{
		stream_.next_out = output_.data();
		stream_.avail_out = static_cast<uInt>(output_.size());
		deflate(&stream_, flush);
		target_.write(reinterpret_cast<const char*>(output_.data()), static_cast<std::streamsize>(output_.size() - stream_.avail_out));
	} while (stream_.avail_out == 0);
}

size_t GzipArchiveWriter::write(const void* buffer, size_t length)
{
	stream_.next_in = const_cast<Bytef*>(static_cast<const Bytef*>(buffer));  // zlib does not write there
	stream_.avail_in = static_cast<uInt>(length);
	deflateInput(Z_NO_FLUSH);
	return length;
}

void GzipArchiveWriter::finish()
{
	deflateInput(Z_FINISH);
}
}  // namespace viwo
