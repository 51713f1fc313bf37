#pragma once

#include <fstream>
#include <string>

namespace viwo
{
/** A text or binary file that appears under its name only when it is whole: written beside it under a temporary name and renamed by
 * commit(). Without commit() the destructor keeps what is there under the final name untouched and removes the temporary file.
 */
class AtomicFile
{
   public:
	/** @throws Error when the folder does not exist or cannot be written, or while another program is writing the same file. */
	explicit AtomicFile(const std::string& path);
	~AtomicFile();
	AtomicFile(const AtomicFile&) = delete;
	AtomicFile& operator=(const AtomicFile&) = delete;

	std::ostream& stream() { return stream_; }

	/** Flushes, closes, renames. @throws Error when anything could not be written (disk full). */
	void commit();

   private:
	void lock();

	std::string path_, temporary_path_;
	int lock_ = -1;  //!< of the temporary file, until it has its final name
	std::ofstream stream_;
	bool committed_ = false;
};

/** A whole AtomicFile at once. @throws Error when it cannot be written. */
void writeAtomically(const std::string& path, const std::string& content);

/** Throws what AtomicFile would, before the work whose result is to be written; leaves nothing behind. */
void requireWritable(const std::string& path);
}  // namespace viwo
