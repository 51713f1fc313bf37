#include "RawlogSequence.h"

#include <viwo/core/Error.h>

#include <algorithm>
#include <filesystem>

namespace fs = std::filesystem;

namespace viwo
{
namespace
{
[[noreturn]] void refuseFolder(const std::string& path)
{
	const auto has = [&path](const char* name)
	{
		std::error_code ignored;
		return fs::is_directory(fs::path(path) / name, ignored);
	};
	const auto convertBy = [&path](const std::string& kind, const std::string& command)
	{ return Error(path + ": a " + kind + ", not a rawlog; make one of it first: viwo-import " + command + " " + path + " -o X.rawlog"); };
	if (has("mav0") || has("imu0")) throw convertBy("sequence in EuRoC's layout", "euroc");
	if (has("oxts")) throw convertBy("drive in KITTI's layout", "kitti");
	throw Error(path + ": is a folder, not a rawlog");
}

void requireReadableFile(const std::string& path)
{
	std::error_code error;
	if (!fs::exists(path, error)) throw Error(path + ": no such file; check the name of the rawlog");
	if (fs::is_directory(path, error)) refuseFolder(path);
	if (fs::is_regular_file(path, error) && fs::file_size(path, error) == 0)
		throw Error(path + ": the file is empty; record or copy it again");
}

/** 0 of a pipe. */
double bytesOf(const std::string& path)
{
	std::error_code error;
	const auto bytes = fs::file_size(path, error);
	return error ? 0 : static_cast<double>(bytes);
}

/** Every observation twice would pass for a sensor at twice the rate. */
void requireOnce(const std::string& path, const std::vector<std::string>& paths)
{
	std::error_code ignored;
	const auto same = [&](const std::string& other) { return other == path || fs::equivalent(path, other, ignored); };
	if (std::count_if(paths.begin(), paths.end(), same) > 1) throw Error(path + ": given twice; name each rawlog of a run once");
}
}  // namespace

RawlogSequence::RawlogSequence(std::vector<std::string> paths, const std::string& action_odometry_label, bool allow_truncated)
    : paths_(std::move(paths)), allow_truncated_(allow_truncated)
{
	if (paths_.empty()) throw Error("no rawlog was given");
	for (const std::string& path : paths_)
	{
		requireReadableFile(path);
		requireOnce(path, paths_);
		bytes_ += bytesOf(path);
	}
	source_ = std::make_unique<ObservationSource>(path(), ActionOdometry(action_odometry_label));
}

bool RawlogSequence::readOfFile(std::vector<mrpt::obs::CObservation::Ptr>& observations)
try
{
	return source_->readEntry(observations);
}
catch (const Error&)
{
	truncated_ = truncated_ || source_->truncated();
	if (!source_->truncated() || !allow_truncated_) throw;
	return false;
}

bool RawlogSequence::readEntry(std::vector<mrpt::obs::CObservation::Ptr>& observations)
{
	while (!readOfFile(observations))
	{
		if (file_ + 1 == paths_.size()) return false;
		auto next = std::make_unique<ObservationSource>(paths_[file_ + 1], source_->actionOdometry());
		bytes_before_ += bytesOf(path());
		entries_before_ += source_->entries();
		comments_before_ += source_->comment();
		source_ = std::move(next);
		++file_;
	}
	return true;
}

double RawlogSequence::progress() const
{
	return bytes_ > 0 ? (bytes_before_ + source_->progress() * bytesOf(path())) / bytes_ : 0;
}
}  // namespace viwo
