#pragma once

#include <filesystem>
#include <string>

namespace viwo::gt
{
/** A folder of files that belong together: they are written beside their place and get there all at once. Without commit() the destructor
 *  leaves everything as it was: files of a former run, and no folder where there was none.
 */
class StagedFolder
{
   public:
	/** Makes the folder where it is not there. @throws Error when it cannot be made or written, or another program writes into it. */
	explicit StagedFolder(const std::string& dir);
	~StagedFolder();
	StagedFolder(const StagedFolder&) = delete;
	StagedFolder& operator=(const StagedFolder&) = delete;

	/** Where to write the files. */
	const std::string& path() const { return staging_; }

	/** Moves all files to their place, `last` (which tells that the others are there) after the others.
	 *  @throws Error when one has no place, before any is moved. */
	void commit(const std::string& last);

   private:
	void makeFolders();
	void lock();
	void undo();

	std::filesystem::path dir_;
	std::string staging_;
	std::filesystem::path made_;  //!< the first folder that was not there; empty: all were
	int lock_ = -1;
	bool committed_ = false;
};
}  // namespace viwo::gt
