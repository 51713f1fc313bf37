#pragma once

#include <string>

namespace viwo::experiments
{
/** Keeps other programs out of a folder that they lock as well; it goes with the object, and with the program however that ends. */
class FolderLock
{
   public:
	/** Does not wait. @pre the folder is there. */
	explicit FolderLock(const std::string& folder);
	~FolderLock();
	FolderLock(const FolderLock&) = delete;
	FolderLock& operator=(const FolderLock&) = delete;

	/** Whether another program has it. Where the file system knows no locks, none has. */
	bool taken() const { return taken_; }

   private:
	int descriptor_;
	bool taken_ = false;
};
}  // namespace viwo::experiments
