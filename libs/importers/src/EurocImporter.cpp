#include "CsvFile.h"
#include "RawlogAssembler.h"
#include "SensorYaml.h"

#include <viwo/core/Error.h>
#include <viwo/core/Joined.h>
#include <viwo/core/NumberText.h>
#include <viwo/importers/EurocImporter.h>

#include <filesystem>
#include <vector>

namespace viwo
{
namespace
{
namespace fs = std::filesystem;

class EurocSequence
{
   public:
	explicit EurocSequence(const std::string& folder)
	{
		std::error_code ignored;
		root_ = fs::is_directory(fs::path(folder) / "mav0", ignored) ? fs::path(folder) / "mav0" : fs::path(folder);
		if (!fs::is_directory(root_ / "cam0", ignored) && !fs::is_directory(root_ / "imu0", ignored))
			throw Error(folder + ": not a sequence in EuRoC's layout; the folder that holds mav0/cam0 and mav0/imu0 is needed");
	}

	Recording read()
	{
		Recording recording;
		const Pose3 T_BO = readOdometry(recording);
		readImu(recording, T_BO.inverse());
		readImages(recording, T_BO.inverse());
		readGroundTruth(recording, T_BO);
		return recording;
	}

	const std::vector<std::string>& notes() const { return notes_; }

   private:
	bool has(const std::string& relative) const
	{
		std::error_code ignored;
		return fs::exists(root_ / relative, ignored);
	}
	std::string file(const std::string& relative) const { return (root_ / relative).string(); }

	Pose3 readOdometry(Recording& recording)
	{
		if (!has("odom0"))
		{
			notes_.emplace_back("no odom0: no wheel odometry in this rawlog, and O is the body frame of the IMU");
			return {};
		}
		for (const CsvRow& row : readStampedCsv(file("odom0/data.csv"), 2, "t [ns], v [m/s], yaw rate [rad/s]"))
			recording.odometry.push_back({row.t_ns, {row.number(0), row.number(1)}});
		return readSensorYaml(file("odom0/sensor.yaml")).T_BS;
	}

	void readImu(Recording& recording, const Pose3& T_OB)
	{
		const SensorYaml yaml = readSensorYaml(file("imu0/sensor.yaml"));
		recording.T_OB = T_OB * yaml.T_BS;
		for (const CsvRow& row : readStampedCsv(file("imu0/data.csv"), 6, "t [ns], wx wy wz [rad/s], ax ay az [m/s^2]"))
			recording.imu.push_back(
			    {row.t_ns, {row.number(3), row.number(4), row.number(5)}, {row.number(0), row.number(1), row.number(2)}});
		noteOnNoise(yaml);
	}

	void noteOnNoise(const SensorYaml& yaml)
	{
		std::vector<std::string> known, unknown;
		const auto tell = [&](const char* key, const std::optional<double>& density)
		{
			if (density)
				known.push_back(std::string(key) + " = " + significant(*density, 6));
			else
				unknown.emplace_back(key);
		};
		tell("gyro_noise_rad_s_sqrtHz", yaml.gyro_noise_rad_s_sqrtHz);
		tell("gyro_walk_rad_s2_sqrtHz", yaml.gyro_walk_rad_s2_sqrtHz);
		tell("acc_noise_m_s2_sqrtHz", yaml.acc_noise_m_s2_sqrtHz);
		tell("acc_walk_m_s3_sqrtHz", yaml.acc_walk_m_s3_sqrtHz);
		if (!known.empty())
			notes_.push_back("a rawlog cannot hold the IMU's noise: set " + joined(known) + " in the configuration" +
			                 (unknown.empty() ? "" : "; the sequence does not say " + joined(unknown)));
	}

	void readImages(Recording& recording, const Pose3& T_OB)
	{
		recording.camera = readCameraYaml(file("cam0/sensor.yaml"));
		recording.T_OC = T_OB * readSensorYaml(file("cam0/sensor.yaml")).T_BS;
		std::vector<std::string> missing;
		for (const CsvRow& row : readStampedCsv(file("cam0/data.csv"), 1, "t [ns], file name"))
		{
			const std::string path = file("cam0/data/" + row.cells[0]);
			std::error_code ignored;
			if (fs::is_regular_file(path, ignored))
				recording.images.push_back({row.t_ns, path});
			else
				missing.push_back(path);
		}
		if (recording.images.empty())
			throw Error(file("cam0/data.csv") + ": none of its images is there, not even " + missing.front() +
			            "; copy or unpack the sequence again");
		if (!missing.empty())
			notes_.push_back("left out, as not there: " + std::to_string(missing.size()) + " of " +
			                 counted(missing.size() + recording.images.size(), "image") + ", the first is " + missing.front());
		if (has("cam1")) notes_.emplace_back("cam1 is left out: one camera is used, cam0");
	}

	void readGroundTruth(Recording& recording, const Pose3& T_BO)
	{
		const std::string folder = "state_groundtruth_estimate0";
		if (!has(folder + "/data.csv"))
		{
			notes_.push_back("no " + folder + ": no ground truth");
			return;
		}
		const Pose3 T_BS = has(folder + "/sensor.yaml") ? readSensorYaml(file(folder + "/sensor.yaml")).T_BS : Pose3();
		const Pose3 T_SO = T_BS.inverse() * T_BO;
		for (const CsvRow& row : readStampedCsv(file(folder + "/data.csv"), 7, "t [ns], px py pz [m], qw qx qy qz"))
		{
			const Eigen::Quaterniond R_WS(row.number(3), row.number(4), row.number(5), row.number(6));
			if (std::abs(R_WS.norm() - 1) > 0.01) throw Error(row.where + ": the quaternion has not unit length");
			recording.ground_truth.push_back({row.t_ns, Pose3(R_WS.normalized(), {row.number(0), row.number(1), row.number(2)}) * T_SO});
		}
	}

	fs::path root_;
	std::vector<std::string> notes_;
};
}  // namespace

ImportResult importEuroc(const ImportJob& job)
{
	EurocSequence sequence(job.folder);
	const Recording recording = sequence.read();
	ImportResult result = writeRecording(recording, job);
	result.notes.insert(result.notes.begin(), sequence.notes().begin(), sequence.notes().end());
	return result;
}
}  // namespace viwo
