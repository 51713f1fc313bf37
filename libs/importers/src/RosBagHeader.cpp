#include "RosBagHeader.h"

#include "RosBagFields.h"

#include <viwo/core/Error.h>

#include <cstdint>
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

std::map<std::string, std::string> firstRecord(std::ifstream& file)
{
	std::string length(4, '\0');
	if (!file.read(length.data(), 4) || littleEndian(length) > kMaxHeader) return {};
	std::string header(littleEndian(length), '\0');
	if (!file.read(header.data(), static_cast<std::streamsize>(header.size()))) return {};
	return rosBagFields(header);
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
	const uint64_t index_at = littleEndian(index->second), size = fs::file_size(path, ignored);
	if (index_at == 0)
		throw Error(path + ": unindexed, its recording was not ended; repair it with `rosbag reindex` of a ROS 1 installation");
	// Of a recorder that nobody sent anything: header and nothing behind it.
	const auto chunks = fields.find("chunk_count"), connections = fields.find("conn_count");
	const auto isNone = [&](const auto& count) { return count != fields.end() && count->second == std::string(4, '\0'); };
	if (index_at == size && isNone(chunks) && isNone(connections)) throw Error(path + ": there are no messages in it");
	if (index_at >= size)
		throw Error(path + ": truncated, its index would be at byte " + std::to_string(index_at) + " of " + std::to_string(size) +
		            "; copy it again, or save what is there with `rosbag reindex`");
}
}  // namespace viwo
