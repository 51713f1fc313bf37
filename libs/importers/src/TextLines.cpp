#include "TextLines.h"

#include <viwo/core/Error.h>

#include <bzlib.h>
#include <zlib.h>

#include <array>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

namespace viwo
{
namespace
{
constexpr size_t kBlock = 1 << 16;
using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

/** Ends the reading of what is no text before it fills the memory: /dev/zero has no end. */
void appendText(const std::string& path, const char* begin, int bytes, std::string& text)
{
	const auto size = static_cast<size_t>(bytes);
	if (std::memchr(begin, 0, size) != nullptr) throw OtherFormat(path + ": is not text; give a log, or one packed by gzip or bzip2");
	text.append(begin, size);
}

bool isBzip2(const std::string& path)
{
	const File file(std::fopen(path.c_str(), "rb"), std::fclose);
	if (!file) throw Error(path + ": cannot be read; check the name and the permissions");
	std::array<char, 3> head{};
	return std::fread(head.data(), 1, head.size(), file.get()) == head.size() && head[0] == 'B' && head[1] == 'Z' && head[2] == 'h';
}

/** Plain files pass through zlib as they are. */
std::string readGzipOrPlain(const std::string& path)
{
	const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), gzclose);
	if (!file) throw Error(path + ": cannot be read; check the name and the permissions");
	std::string text;
	std::array<char, kBlock> block;
	int bytes = 0;
	while ((bytes = gzread(file.get(), block.data(), static_cast<unsigned>(block.size()))) > 0) appendText(path, block.data(), bytes, text);
	int status = Z_OK;
	gzerror(file.get(), &status);
	if (bytes < 0 || status != Z_OK) throw Error(path + ": damaged or cut short: gzip cannot unpack it; copy it again");
	return text;
}

std::string readBzip2(const std::string& path)
{
	const std::unique_ptr<void, void (*)(void*)> file(BZ2_bzopen(path.c_str(), "rb"), BZ2_bzclose);
	if (!file) throw Error(path + ": cannot be read; check the name and the permissions");
	std::string text;
	std::array<char, kBlock> block;
	int bytes = 0;
	while ((bytes = BZ2_bzread(file.get(), block.data(), static_cast<int>(block.size()))) > 0) appendText(path, block.data(), bytes, text);
	int status = BZ_OK;
	BZ2_bzerror(file.get(), &status);
	if (bytes < 0 || status < 0) throw Error(path + ": damaged or cut short: bzip2 cannot unpack it; copy it again");
	return text;
}
}  // namespace

std::vector<std::string> readTextLines(const std::string& path)
{
	std::error_code error;
	if (!std::filesystem::exists(path, error)) throw Error(path + ": no such file");
	if (std::filesystem::is_directory(path, error)) throw Error(path + ": is a folder, not a log");
	const std::string text = isBzip2(path) ? readBzip2(path) : readGzipOrPlain(path);
	std::vector<std::string> lines;
	for (size_t begin = 0; begin < text.size();)
	{
		size_t end = text.find('\n', begin);
		if (end == std::string::npos) end = text.size();
		const size_t length = end - begin;
		lines.push_back(text.substr(begin, length > 0 && text[end - 1] == '\r' ? length - 1 : length));
		begin = end + 1;
	}
	return lines;
}
}  // namespace viwo
