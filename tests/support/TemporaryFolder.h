#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

namespace viwo::test
{
/** A folder of its own for one test; removed at the end. */
class TemporaryFolder
{
   public:
	TemporaryFolder()
	{
		std::string name = (std::filesystem::temp_directory_path() / "viwo_test_XXXXXX").string();
		if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder could be made");
		path_ = name;
	}
	~TemporaryFolder()
	{
		std::error_code ignored;
		std::filesystem::remove_all(path_, ignored);
	}
	TemporaryFolder(const TemporaryFolder&) = delete;
	TemporaryFolder& operator=(const TemporaryFolder&) = delete;

	std::string path() const { return path_.string(); }
	std::string operator/(const std::string& name) const { return (path_ / name).string(); }

	/** Writes a file, making the folders that it needs; @return its full path. */
	std::string write(const std::string& name, const std::string& content) const
	{
		const std::filesystem::path file = path_ / name;
		std::filesystem::create_directories(file.parent_path());
		std::ofstream(file, std::ios::binary) << content;
		return file.string();
	}

   private:
	std::filesystem::path path_;
};

inline std::string readFile(const std::string& path)
{
	std::ifstream file(path, std::ios::binary);
	std::ostringstream content;
	content << file.rdbuf();
	return content.str();
}
}  // namespace viwo::test
