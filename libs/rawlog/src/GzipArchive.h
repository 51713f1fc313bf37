#pragma once

#include <mrpt/serialization/CArchive.h>
#include <zlib.h>

#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include "ByteSource.h"

namespace viwo
{
/** MRPT's objects from a file, gzip-compressed or plain. Unlike MRPT's own stream it tells the end of the file from its truncation:
 *  a short read never passes for data.
 */
class GzipArchiveReader : public mrpt::serialization::CArchive
{
   public:
	enum class State
	{
		good,
		truncated,  //!< the file, or the gzip stream in it, ended within what was asked for
		damaged     //!< not what the gzip checksum says
	};

	/** @throws Error when the file cannot be opened. */
	explicit GzipArchiveReader(const std::string& path);
	~GzipArchiveReader() override;

	/** No byte is left, and the gzip stream, if it is one, is whole. */
	bool atEnd();

	/** Up to `count` of the next bytes, which stay unread. */
	std::string peek(size_t count);

	State state() const { return state_; }

	/** Bytes of the (compressed) file read so far, some of them ahead. */
	uint64_t position() const { return position_; }

   protected:
	size_t read(void* buffer, size_t length) override;
	size_t write(const void*, size_t) override { return 0; }

   private:
	void fill(size_t count);
	bool readInput();
	void copyPlain();
	void inflateSome();
	unsigned char* freeSpace() { return buffer_.data() + end_; }

	ByteSource file_;
	uint64_t position_ = 0;
	std::vector<unsigned char> input_;
	z_stream stream_{};  //!< its next_in, avail_in: what is left of input_
	bool is_compressed_ = false, member_ended_ = false, finished_ = false;
	std::vector<unsigned char> buffer_;  //!< plain bytes; those from begin_ to end_ are unread
	size_t begin_ = 0, end_ = 0;
	State state_ = State::good;
};

/** MRPT's objects into a stream, as a gzip member without name and time: the same objects give the same bytes. */
class GzipArchiveWriter : public mrpt::serialization::CArchive
{
   public:
	explicit GzipArchiveWriter(std::ostream& target);
	~GzipArchiveWriter() override;

	/** Writes what is pending and the trailer. */
	void finish();

   protected:
	size_t read(void*, size_t) override { return 0; }
	size_t write(const void* buffer, size_t length) override;

   private:
	void deflateInput(int flush);

	std::ostream& target_;
	z_stream stream_{};
	std::vector<unsigned char> output_;
};
}  // namespace viwo
