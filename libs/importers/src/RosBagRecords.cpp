#include "RosBagRecords.h"

#include "RosBagFields.h"

#include <viwo/core/Error.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <vector>

namespace viwo
{
namespace
{
constexpr uint64_t kMagicBytes = 13;
/** Headers have some fields of some bytes; those of connections, whose message definitions are data, too. */
constexpr uint64_t kMaxHeaderBytes = 1 << 20;
constexpr uint64_t kIndexEntryBytes = 12, kChunkCountBytes = 8;

enum Op : uint64_t
{
	message = 2,
	bag_header = 3,
	index = 4,
	chunk = 5,
	chunk_info = 6,
	connection = 7
};

struct Record
{
	uint64_t begin, data, end;  //!< places in the file
	std::map<std::string, std::string> fields;

	Op op() const { return static_cast<Op>(number("op", 1).value_or(0)); }
	std::optional<uint64_t> number(const std::string& name, size_t bytes) const
	{
		const auto field = fields.find(name);
		if (field == fields.end() || field->second.size() != bytes) return std::nullopt;
		return littleEndian(field->second);
	}
};

class BagRecords
{
   public:
	explicit BagRecords(const std::string& path) : path_(path), size_(std::filesystem::file_size(path))
	{
		// Most of what a large buffer would read is messages.
		file_.rdbuf()->pubsetbuf(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
		file_.open(path, std::ios::binary);
	}

	void check()
	{
		for (uint64_t at = kMagicBytes; at < size_ && !complete();)
		{
			const Record record = read(at, size_);
			if (record.op() == Op::chunk_info || record.op() == Op::connection) index_records_.insert(at);
			take(record);
			at = record.end;
		}
		if (!complete()) fail(size_, "ends before its index does");
		if (index_at_ != size_ && index_records_.count(index_at_) == 0) fail(index_at_, "is no index");
	}

   private:
	[[noreturn]] void fail(uint64_t at, const std::string& what) const
	{
		throw Error(path_ + ": damaged, what stands at byte " + std::to_string(at) + " " + what +
		            "; copy it again, or save what is there with `rosbag reindex`");
	}

	/** Whether all that the header announces has been seen; what follows does not matter. */
	bool complete() const { return announced_ && connections_ >= announced_connections_ && chunk_infos_ >= announced_chunks_; }

	std::string bytes(uint64_t at, uint64_t count)
	{
		std::string text(count, '\0');
		file_.clear();
		if (!file_.seekg(static_cast<std::streamoff>(at)) || !file_.read(text.data(), static_cast<std::streamsize>(count)))
			throw Error(path_ + ": cannot be read at byte " + std::to_string(at) + "; check the disk");
		return text;
	}

	Record read(uint64_t at, uint64_t end)
	{
		const auto length = [&](uint64_t place)
		{
			if (place + 4 > end) fail(at, "is cut off");
			const uint64_t value = littleEndian(bytes(place, 4));
			if (value > end - place - 4) fail(at, "would reach beyond the end");
			return value;
		};
		const uint64_t header_bytes = length(at);
		if (header_bytes > kMaxHeaderBytes) fail(at, "has an absurd length");
		Record record{at, at + 8 + header_bytes, 0, rosBagFields(bytes(at + 4, header_bytes))};
		if (!record.number("op", 1)) fail(at, "is no record of a bag");
		record.end = record.data + length(at + 4 + header_bytes);
		return record;
	}

	void take(const Record& record)
	{
		switch (record.op())
		{
			case Op::bag_header:
				takeHeader(record);
				break;
			case Op::chunk:
				takeChunk(record);
				break;
			case Op::index:
				takeIndex(record);
				break;
			case Op::connection:
				++connections_;
				takeConnection(record);
				break;
			case Op::chunk_info:
				++chunk_infos_;
				if (chunks_.count(record.number("chunk_pos", 8).value_or(0)) == 0) fail(record.begin, "points at no chunk");
				if (record.number("count", 4).value_or(0) * kChunkCountBytes != record.end - record.data)
					fail(record.begin, "has a wrong length");
				break;
			default:
				fail(record.begin, "is of no kind that a bag has");
		}
	}

	void takeHeader(const Record& record)
	{
		const auto connections = record.number("conn_count", 4), chunks = record.number("chunk_count", 4);
		const auto index_at = record.number("index_pos", 8);
		if (!connections || !chunks || !index_at) fail(record.begin, "is no header of a bag");
		announced_ = true;
		announced_connections_ = *connections, announced_chunks_ = *chunks, index_at_ = *index_at;
	}

	void takeConnection(const Record& record)
	{
		const auto id = record.number("conn", 4);
		if (!id || record.end - record.data > kMaxHeaderBytes || rosBagFields(bytes(record.data, record.end - record.data)).empty())
			fail(record.begin, "is no connection");
	}

	void takeChunk(const Record& record)
	{
		chunks_.insert(record.begin);
		const auto size = record.number("size", 4);
		const auto compression = record.fields.find("compression");
		if (!size || compression == record.fields.end()) fail(record.begin, "is no chunk");
		chunk_bytes_ = *size;
		chunk_is_plain_ = compression->second == "none";
		targets_.clear();
		if (!chunk_is_plain_) return;
		if (*size != record.end - record.data) fail(record.begin, "has a wrong length");
		takeMessages(record);
	}

	/** Of a chunk that is not compressed. An index entry may point at a message, or at the connection that stands before its first one. */
	void takeMessages(const Record& chunk)
	{
		std::vector<uint64_t> pending;
		for (uint64_t at = chunk.data; at < chunk.end;)
		{
			const Record record = read(at, chunk.end);
			pending.push_back(at - chunk.data);
			if (record.op() == Op::connection)
				takeConnection(record);
			else if (record.op() == Op::message && record.number("conn", 4) && record.number("time", 8))
			{
				targets_.insert(targets_.end(), pending.begin(), pending.end());
				pending.clear();
			}
			else
				fail(at, "is no message");
			at = record.end;
		}
	}

	void takeIndex(const Record& record)
	{
		const uint64_t count = record.number("count", 4).value_or(0), length = record.end - record.data;
		if (!record.number("conn", 4) || count * kIndexEntryBytes != length) fail(record.begin, "has a wrong length");
		const std::string entries = bytes(record.data, length);
		for (uint64_t i = 0; i < count; ++i)
		{
			const uint64_t offset = littleEndian(entries.substr(i * kIndexEntryBytes + 8, 4));
			const bool is_message = chunk_is_plain_ ? std::binary_search(targets_.begin(), targets_.end(), offset) : offset < chunk_bytes_;
			if (!is_message) fail(record.begin, "points at no message");
		}
	}

	std::string path_;
	uint64_t size_;
	std::array<char, 512> buffer_{};
	std::ifstream file_;
	bool announced_ = false;
	uint64_t announced_connections_ = 0, announced_chunks_ = 0, index_at_ = 0;
	uint64_t connections_ = 0, chunk_infos_ = 0;
	std::set<uint64_t> chunks_, index_records_;
	uint64_t chunk_bytes_ = 0;
	bool chunk_is_plain_ = false;
	std::vector<uint64_t> targets_;  //!< rising: offsets in the chunk from which a message is found
};
}  // namespace

void requireSoundRecords(const std::string& path)
{
	BagRecords(path).check();
}
}  // namespace viwo
