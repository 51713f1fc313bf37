#pragma once

#include <cstdint>
#include <string>

namespace viwo
{
/** Finds the external images of a rawlog. */
class ImageFolder
{
   public:
	explicit ImageFolder(const std::string& rawlog_path) : rawlog_path_(rawlog_path) {}

	/** @return the absolute path of the file with that name in the rawlog; "" and a reason when there is none. */
	std::string find(const std::string& name, std::string& reason);

	/** "" before the first file was found. */
	const std::string& path() const { return folder_; }

   private:
	std::string choose(const std::string& name, std::string& reason) const;

	std::string rawlog_path_, folder_;
};
}  // namespace viwo
