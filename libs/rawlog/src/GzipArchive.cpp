#include "GzipArchive.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace viwo
{
namespace
{
constexpr size_t kBuffer_bytes = size_t{1} << 16;
constexpr unsigned char kGzipMagic[2] = {0x1f, 0x8b};
constexpr int kGzipWithLargestWindow = 15 + 16;
constexpr int kCompressionLevel = 1;  // as rawlog-edit: the images, most of a rawlog, are compressed already
}  // namespace

GzipArchiveReader::GzipArchiveReader(const std::string& path) : file_(path), input_(kBuffer_bytes), buffer_(kBuffer_bytes)
{
	if (inflateInit2(&stream_, kGzipWithLargestWindow) != Z_OK) throw std::bad_alloc();
	while (stream_.avail_in < 2 && readInput()) continue;
	is_compressed_ = stream_.avail_in >= 2 && input_[0] == kGzipMagic[0] && input_[1] == kGzipMagic[1];
}

GzipArchiveReader::~GzipArchiveReader()
{
	inflateEnd(&stream_);
}

bool GzipArchiveReader::readInput()
{
	// What is left of the input comes first: a pipe may give a single byte.
	const size_t left = stream_.avail_in;
	if (left > 0) std::memmove(input_.data(), stream_.next_in, left);
	const size_t count = file_.read(input_.data() + left, input_.size() - left);
	stream_.next_in = input_.data();
	stream_.avail_in = static_cast<uInt>(left + count);
	position_ += count;
	if (file_.failed()) state_ = State::damaged;
	return count > 0;
}

void GzipArchiveReader::copyPlain()
{
	const size_t chunk = std::min<size_t>(buffer_.size() - end_, stream_.avail_in);
	std::memcpy(freeSpace(), stream_.next_in, chunk);
	end_ += chunk;
	stream_.next_in += chunk;
	stream_.avail_in -= static_cast<uInt>(chunk);
}

void GzipArchiveReader::inflateSome()
{
	if (member_ended_)
	{
		// Another gzip member may follow (files that were appended to); anything else is padding.
		if (*stream_.next_in != kGzipMagic[0])
		{
			finished_ = true;
			return;
		}
		inflateReset(&stream_);
		member_ended_ = false;
	}
	stream_.next_out = freeSpace();
	stream_.avail_out = static_cast<uInt>(buffer_.size() - end_);
	const int code = inflate(&stream_, Z_NO_FLUSH);
	end_ = buffer_.size() - stream_.avail_out;
	member_ended_ = code == Z_STREAM_END;
	if (code != Z_OK && code != Z_STREAM_END && code != Z_BUF_ERROR) state_ = State::damaged;
}

void GzipArchiveReader::fill(size_t count)
{
	if (end_ - begin_ >= count) return;
	std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
	end_ -= begin_;
	begin_ = 0;
	while (end_ < count && state_ == State::good && !finished_)
	{
		if (stream_.avail_in == 0 && !readInput())
		{
			finished_ = true;
			if (is_compressed_ && !member_ended_ && state_ == State::good) state_ = State::truncated;
		}
		else if (is_compressed_)
			inflateSome();
		else
			copyPlain();
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
	return {reinterpret_cast<const char*>(buffer_.data()) + begin_, std::min(count, end_ - begin_)};
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
