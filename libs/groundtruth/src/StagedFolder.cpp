#include "StagedFolder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>
#include <viwo/core/Error.h>

#include <algorithm>
#include <vector>

namespace fs = std::filesystem;

namespace viwo::gt
{
StagedFolder::StagedFolder(const std::string& dir) : dir_(dir), staging_((dir_ / ".viwo-groundtruth.part").string())
{
	try
	{
		makeFolders();
		lock();
		std::error_code error;
		fs::remove_all(staging_, error);  // of a run that was killed
		if (!error) fs::create_directory(staging_, error);
		if (error) throw Error(dir + ": cannot write into this folder (" + error.message() + "); choose another with -o");
	}
	catch (...)
	{
		undo();
		throw;
	}
}

StagedFolder::~StagedFolder()
{
	undo();
}

void StagedFolder::makeFolders()
{
	std::error_code error;
	for (fs::path p = fs::absolute(dir_, error); !p.empty() && !fs::exists(p, error); p = p.parent_path())
	{
		if (!p.filename().empty()) made_ = p;
		if (p == p.parent_path()) break;
	}
	error.clear();
	fs::create_directories(dir_, error);
	if (error) throw Error(dir_.string() + ": cannot make this folder (" + error.message() + "); choose another with -o");
}

/** Held until the end: two programs would mix their files. One that was killed holds no lock. */
void StagedFolder::lock()
{
	lock_ = ::open(dir_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
	if (lock_ >= 0 && ::flock(lock_, LOCK_EX | LOCK_NB) != 0)
	{
		::close(lock_);
		lock_ = -1;
		throw Error(dir_.string() + ": another program is writing into this folder; wait for its end, or choose another with -o");
	}
}

void StagedFolder::undo()
{
	std::error_code ignored;
	if (lock_ >= 0) fs::remove_all(staging_, ignored);
	if (!committed_ && !made_.empty())
	{
		// Only what is empty goes.
		for (fs::path p = fs::absolute(dir_, ignored); fs::remove(p, ignored) || p.filename().empty(); p = p.parent_path())
			if (p == made_) break;
	}
	if (lock_ >= 0) ::close(lock_);
	lock_ = -1;
}

void StagedFolder::commit(const std::string& last)
{
	std::vector<std::string> names;
	for (const auto& entry : fs::directory_iterator(staging_)) names.push_back(entry.path().filename().string());
	std::sort(names.begin(), names.end());
	std::stable_partition(names.begin(), names.end(), [&](const std::string& name) { return name != last; });
	std::error_code error;
	for (const std::string& name : names)
		if (fs::is_directory(dir_ / name, error))
			throw Error((dir_ / name).string() + ": cannot write: it is a folder; remove it, or choose another folder with -o");
	for (const std::string& name : names)
	{
		fs::rename(fs::path(staging_) / name, dir_ / name, error);
		if (error) throw Error((dir_ / name).string() + ": cannot be written (" + error.message() + "); check the permissions");
	}
	committed_ = true;
}
}  // namespace viwo::gt
