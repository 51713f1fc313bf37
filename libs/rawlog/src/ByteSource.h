#pragma once

#include <cstddef>
#include <fstream>
#include <memory>
#include <string>

namespace viwo
{
class PipeSpool;

/** The bytes of a file from its beginning. A pipe gives its bytes once only: they are kept in a temporary file without a name, so that
 *  every ByteSource of the same pipe, too, sees them from the beginning.
 */
class ByteSource
{
   public:
	/** @throws Error when the file cannot be opened. */
	explicit ByteSource(const std::string& path);
	~ByteSource();

	/** Of a pipe as many as there are, after waiting for the first. @return bytes read; 0 at the end, or after an error. */
	size_t read(void* target, size_t length);

	/** The last read failed, rather than meeting the end. */
	bool failed() const { return failed_; }

   private:
	std::ifstream file_;
	std::shared_ptr<PipeSpool> pipe_;
	size_t position_ = 0;  //!< in the pipe
	bool failed_ = false;
};
}  // namespace viwo
