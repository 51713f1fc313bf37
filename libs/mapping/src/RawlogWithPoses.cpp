#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <viwo/core/Error.h>
#include <viwo/core/MrptPose.h>
#include <viwo/core/TimeText.h>
#include <viwo/mapping/RawlogWithPoses.h>
#include <viwo/rawlog/MrptTime.h>
#include <viwo/rawlog/RawlogReader.h>
#include <viwo/rawlog/RawlogWriter.h>

#include <filesystem>
#include <map>

namespace viwo
{
namespace
{
namespace fs = std::filesystem;
using namespace mrpt::obs;

/** A link to the same file, or a copy on another disk. */
void bringAlong(const fs::path& from, const fs::path& to)
{
	std::error_code error;
	if (fs::equivalent(from, to, error)) return;
	fs::remove(to, error);
	fs::create_hard_link(from, to, error);
	if (error) fs::copy_file(from, to, fs::copy_options::overwrite_existing, error);
	if (error) throw Error(to.string() + ": cannot copy " + from.string() + ": " + error.message());
}

CObservationRobotPose robotPose(const StampedPose& pose, const std::string& label)
{
	CObservationRobotPose observation;
	observation.timestamp = mrptTime(pose.t_ns);
	observation.sensorLabel = label;
	observation.pose.mean = toMrpt(pose.T);
	return observation;
}

class Copy
{
   public:
	Copy(const RawlogWithPosesOptions& options, const Trajectory& trajectory)
	    : options_(options), trajectory_(trajectory), reader_(options.input, readerOptions(options)), writer_(options.output)
	{
	}

	RawlogWithPosesResult run()
	{
		const auto& poses = trajectory_.poses();
		size_t next = 0;
		int64_t last_ns = 0;
		while (const auto observation = reader_.next())
		{
			if (options_.interrupted && options_.interrupted()) throw Error("interrupted; nothing was written");
			if (options_.progress) options_.progress(reader_.progress());
			last_ns = nanosecondsOf(observation->timestamp);
			if (result_.observations == 0)
				while (next < poses.size() && poses[next].t_ns < last_ns) ++next;
			for (; next < poses.size() && poses[next].t_ns <= last_ns; ++next) writePose(poses[next]);
			writeObservation(observation);
		}
		if (result_.poses == 0)
			throw Error("no pose of the trajectory (" + formatSeconds(poses.front().t_ns) + " to " + formatSeconds(poses.back().t_ns) +
			            " s) lies within " + options_.input);
		for (const auto& [sensor, counts] : reader_.counts().sensors)
			result_.left_out += counts.unstamped + counts.late + counts.stamp_jumps;
		bringAlongFiles();
		writer_.close();
		return result_;
	}

   private:
	static RawlogReaderOptions readerOptions(const RawlogWithPosesOptions& options)
	{
		RawlogReaderOptions reading;
		reading.allow_truncated = options.allow_truncated;
		return reading;
	}

	void writePose(const StampedPose& pose)
	{
		writer_.write(robotPose(pose, options_.label));
		++result_.poses;
	}

	void writeObservation(const CObservation::Ptr& observation)
	{
		if (observation->sensorLabel == options_.label)
			throw Error(options_.input + ": label " + options_.label +
			            " is taken: by poses that were put in before, or by a sensor; give another one with --label");
		++result_.observations;
		const auto image = std::dynamic_pointer_cast<CObservationImage>(observation);
		if (image && image->image.isExternallyStored())
		{
			const fs::path file = image->image.getExternalStorageFile();
			const auto known = files_.emplace(file.filename().string(), file).first;
			if (known->second != file)
				throw Error(options_.input + ": two images have the name " + known->first + ", in " + known->second.parent_path().string() +
				            " and in " + file.parent_path().string() + ", and cannot go into one folder; rename one of them");
			image->image.setExternalStorage(known->first);
		}
		writer_.write(*observation);
	}

	/** Images, and what depth images and clouds name in the same folder. */
	void bringAlongFiles()
	{
		const fs::path folder =
		    reader_.imagesFolder().empty() ? fs::path(options_.input).replace_extension("").string() + "_Images" : reader_.imagesFolder();
		if (fs::is_directory(folder))
			for (const auto& entry : fs::directory_iterator(folder))
				if (entry.is_regular_file()) files_.emplace(entry.path().filename().string(), entry.path());
		if (files_.empty()) return;
		result_.images_folder = writer_.imagesFolder();
		for (const auto& [name, file] : files_) bringAlong(file, fs::path(result_.images_folder) / name);
	}

	const RawlogWithPosesOptions& options_;
	const Trajectory& trajectory_;
	RawlogReader reader_;
	RawlogWriter writer_;
	RawlogWithPosesResult result_;
	std::map<std::string, fs::path> files_;  //!< by the name they are to have
};
}  // namespace

RawlogWithPosesResult writeRawlogWithPoses(const RawlogWithPosesOptions& options, const Trajectory& trajectory)
{
	std::error_code ignored;
	if (fs::equivalent(options.input, options.output, ignored)) throw Error(options.output + ": is the input; give another name with -o");
	return Copy(options, trajectory).run();
}
}  // namespace viwo
