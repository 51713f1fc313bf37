#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

namespace viwo::testing
{
/** A new empty folder that goes away with its object. */
class TempFolder
{
   public:
	TempFolder()
	{
		std::string name = (std::filesystem::temp_directory_path() / "viwo_test_XXXXXX").string();
		if (!mkdtemp(name.data())) throw std::runtime_error("cannot create " + name);
		path_ = name;
	}
	~TempFolder()
	{
		std::error_code ignored;
		std::filesystem::remove_all(path_, ignored);
	}
	TempFolder(const TempFolder&) = delete;
	TempFolder& operator=(const TempFolder&) = delete;

	std::string path() const { return path_.string(); }
	std::string file(const std::string& name) const { return (path_ / name).string(); }

   private:
	std::filesystem::path path_;
};

inline std::string readFile(const std::string& path)
{
	std::ifstream file(path, std::ios::binary);
	return {std::istreambuf_iterator<char>(file), {}};
}

inline void writeFile(const std::string& path, const std::string& content)
{
	std::ofstream file(path, std::ios::binary);
	file << content;
}
}  // namespace viwo::testing
