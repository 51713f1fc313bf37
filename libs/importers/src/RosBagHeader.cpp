#include "RosBagHeader.h"

#include <viwo/core/Error.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>

namespace viwo
{
namespace
{
namespace fs = std::filesystem;
constexpr char kMagic[] = "#ROSBAG V2.0\n";
constexpr size_t kMagicSize = sizeof kMagic - 1;
/** rosbag pads the header record to 4096 bytes. */
constexpr uint32_t kMaxHeader = 1 << 16;

bool startsWith(const std::string& text, const std::string& start)
{
	return text.compare(0, start.size(), start) == 0;
}

[[noreturn]] void refuseRos2(const std::string& path, const std::string& what)
{
	throw Error(path + ": a ROS 2 bag (" + what + "); convert it first: pip install rosbags, then rosbags-convert --src " + path +
	            " --dst " + fs::path(path).stem().string() + ".bag");
}

uint32_t littleEndian32(const std::string& bytes, size_t at)
{
	uint32_t value = 0;
	for (size_t i = 0; i < 4; ++i) value |= static_cast<uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
	return value;
}

/** The fields of a record's header: uint32 length, then `name=value` each. Nothing where they are damaged. */
std::map<std::string, std::string> fieldsOf(const std::string& header)
{
	std::map<std::string, std::string> fields;
	for (size_t at = 0; at + 4 <= header.size();)
	{
		const size_t length = littleEndian32(header, at);
		const size_t equals = header.find('=', at + 4);
		if (at + 4 + length > header.size() || equals == std::string::npos || equals >= at + 4 + length) return {};
		fields[header.substr(at + 4, equals - at - 4)] = header.substr(equals + 1, at + 4 + length - equals - 1);
		at += 4 + length;
	}
	return fields;
}

std::map<std::string, std::string> firstRecord(std::ifstream& file)
{
	std::string length(4, '\0');
	if (!file.read(length.data(), 4) || littleEndian32(length, 0) > kMaxHeader) return {};
	std::string header(littleEndian32(length, 0), '\0');
	if (!file.read(header.data(), static_cast<std::streamsize>(header.size()))) return {};
	return fieldsOf(header);
}

uint64_t indexPosition(const std::string& field)
{
	uint64_t value = 0;
	for (size_t i = 0; i < 8; ++i) value |= static_cast<uint64_t>(static_cast<unsigned char>(field[i])) << (8 * i);
	return value;
}

void refuseForeign(const std::string& path, const std::string& start)
{
	if (startsWith(start, "SQLite format")) refuseRos2(path, "sqlite3");
	if (startsWith(start, "\x89MCAP")) refuseRos2(path, "MCAP");
	if (startsWith(start, "#ROSBAG V1") || startsWith(start, "#ROSRECORD"))
		throw Error(path + ": a bag of an old format; bring it to 2.0 with `rosbag fix` of a ROS 1 installation");
	if (!startsWith(start, kMagic)) throw Error(path + ": not a ROS bag, it does not begin with #ROSBAG V2.0");
}
}  // namespace

void requireReadableBag(const std::string& path)
{
	std::error_code ignored;
	if (fs::is_directory(path, ignored))
	{
		if (fs::exists(fs::path(path) / "metadata.yaml", ignored)) refuseRos2(path, "folder with metadata.yaml");
		throw Error(path + ": a folder; give the .bag files");
	}
	std::ifstream file(path, std::ios::binary);
	if (!file) throw Error(path + ": cannot be read; check the name");
	std::string start(kMagicSize, '\0');
	file.read(start.data(), static_cast<std::streamsize>(kMagicSize));
	start.resize(static_cast<size_t>(file.gcount()));
	if (start.empty()) throw Error(path + ": an empty file");
	refuseForeign(path, start);

	const auto fields = firstRecord(file);
	const auto encryptor = fields.find("encryptor");
	if (encryptor != fields.end() && !encryptor->second.empty())
		throw Error(path + ": encrypted (" + encryptor->second + "); decrypt it with `rosbag decrypt` on the machine that has the key");
	const auto index = fields.find("index_pos");
	if (index == fields.end() || index->second.size() != 8) throw Error(path + ": damaged, its first record is not a bag's header");
	const uint64_t index_at = indexPosition(index->second), size = fs::file_size(path, ignored);
	if (index_at == 0)
		throw Error(path + ": unindexed, its recording was not ended; repair it with `rosbag reindex` of a ROS 1 installation");
	if (index_at >= size)
		throw Error(path + ": truncated, its index would be at byte " + std::to_string(index_at) + " of " + std::to_string(size) +
		            "; copy it again, or save what is there with `rosbag reindex`");
}
}  // namespace viwo
