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
		bringAlongOtherFiles();
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
		++result_.observations;
		const auto image = std::dynamic_pointer_cast<CObservationImage>(observation);
		if (image && image->image.isExternallyStored())
		{
			const fs::path file = image->image.getExternalStorageFile();
			bringAlong(file, fs::path(writer_.imagesFolder()) / file.filename());
			image->image.setExternalStorage(file.filename().string());
			++result_.images;
		}
		writer_.write(*observation);
	}

	/** Depth images and clouds name files of the same folder. */
	void bringAlongOtherFiles()
	{
		const fs::path folder =
		    reader_.imagesFolder().empty() ? fs::path(options_.input).replace_extension("").string() + "_Images" : reader_.imagesFolder();
		if (!fs::is_directory(folder)) return;
		for (const auto& entry : fs::directory_iterator(folder))
			if (const fs::path to = fs::path(writer_.imagesFolder()) / entry.path().filename(); entry.is_regular_file() && !fs::exists(to))
				bringAlong(entry.path(), to);
	}

	const RawlogWithPosesOptions& options_;
	const Trajectory& trajectory_;
	RawlogReader reader_;
	RawlogWriter writer_;
	RawlogWithPosesResult result_;
};
}  // namespace

RawlogWithPosesResult writeRawlogWithPoses(const RawlogWithPosesOptions& options, const Trajectory& trajectory)
{
	std::error_code ignored;
	if (fs::equivalent(options.input, options.output, ignored)) throw Error(options.output + ": is the input; give another name with -o");
	return Copy(options, trajectory).run();
}
}  // namespace viwo
