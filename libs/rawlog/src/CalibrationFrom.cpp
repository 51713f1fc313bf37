#include <viwo/core/MrptPose.h>
#include <viwo/rawlog/ObservationAdapter.h>
#include <viwo/rawlog/RawlogWriter.h>
#include <viwo/rawlog/RigFile.h>

#include "RawlogSequence.h"

namespace viwo
{
namespace
{
Pose3 finitePose(const mrpt::poses::CPose3D& T_Ox, const std::string& label)
{
	Pose3 pose = fromMrpt(T_Ox);
	if (!pose.p.allFinite() || !pose.R.coeffs().allFinite())
		throw Error("label " + label + ": the pose of the sensor on the robot is not finite; correct it with rawlog-edit --sensors-pose");
	return pose;
}

/** The first observations with a stamp under the two labels. Images are not looked for: a calibration needs none. */
struct FirstObservations
{
	explicit FirstObservations(const AdapterOptions& options) : options(options) {}

	void take(const mrpt::obs::CObservation::Ptr& observation)
	{
		auto& sensor = counts.sensors[{observation->sensorLabel, shortClassName(*observation)}];
		++sensor.read;
		if (observation->timestamp == INVALID_TIMESTAMP)
		{
			++sensor.unstamped;
			return;
		}
		if (!image && observation->sensorLabel == options.cam_label)
			image = std::dynamic_pointer_cast<mrpt::obs::CObservationImage>(observation);
		if (!imu && observation->sensorLabel == options.imu_label) imu = std::dynamic_pointer_cast<mrpt::obs::CObservationIMU>(observation);
	}

	const AdapterOptions& options;
	mrpt::obs::CObservationImage::Ptr image;
	mrpt::obs::CObservationIMU::Ptr imu;
	RawlogCounts counts;
};
}  // namespace

Calibration calibrationFrom(const AdapterOptions& options, const mrpt::obs::CObservationImage* image, const mrpt::obs::CObservationIMU* imu)
{
	Calibration calibration;
	calibration.wheels = {options.left_scale, options.right_scale,
	                      options.calibrated_track_m > 0 ? options.calibrated_track_m : options.track_m};
	if (imu) calibration.T_OB = finitePose(imu->sensorPose, imu->sensorLabel);
	if (!image) return calibration;
	calibration.T_OC = finitePose(image->cameraPose, image->sensorLabel);
	try
	{
		calibration.camera = fromMrpt(image->cameraParams);
	}
	catch (const Error& e)
	{
		throw Error("label " + image->sensorLabel + ": " + e.what() + "; set it with rawlog-edit --camera-params " + image->sensorLabel +
		            ",CALIBRATION.ini");
	}
	return calibration;
}

Calibration readCalibration(const std::string& rawlog_path, const AdapterOptions& options, bool needs_camera, bool needs_imu,
                            bool allow_truncated)
{
	return readCalibration(std::vector<std::string>{rawlog_path}, options, needs_camera, needs_imu, allow_truncated);
}

Calibration readCalibration(const std::vector<std::string>& rawlog_paths, const AdapterOptions& options, bool needs_camera, bool needs_imu,
                            bool allow_truncated, const RigFile* rig)
{
	FirstObservations first(options);
	RawlogSequence source(rawlog_paths, options.odometry_label, allow_truncated);
	const auto complete = [&] { return (!needs_camera || first.image) && (!needs_imu || first.imu); };
	std::vector<mrpt::obs::CObservation::Ptr> observations;
	while (!complete() && source.readEntry(observations))
		for (const auto& observation : observations)
		{
			if (rig) rig->apply(*observation);
			first.take(observation);
		}
	const std::string where = rawlogNames(rawlog_paths);
	if (!complete())
		throw missingSensorError(where, needs_camera && !first.image ? SensorKind::camera : SensorKind::imu, options, first.counts);
	try
	{
		return calibrationFrom(options, needs_camera ? first.image.get() : nullptr, needs_imu ? first.imu.get() : nullptr);
	}
	catch (const Error& e)
	{
		throw Error(where + ": " + e.what());
	}
}

Error missingSensorError(const std::string& rawlog_path, SensorKind kind, const AdapterOptions& options, const RawlogCounts& counts)
{
	struct Names
	{
		const char *what, *class_name, *key;
		std::string label;
	};
	Names names{"image", "CObservationImage", "cam_label", options.cam_label};
	if (kind == SensorKind::imu) names = {"IMU", "CObservationIMU", "imu_label", options.imu_label};
	if (kind == SensorKind::odometry) names = {"odometry", "CObservationOdometry", "odometry_label", options.odometry_label};
	const auto there = counts.sensors.find({names.label, names.class_name});
	if (there != counts.sensors.end() && there->second.unstamped == there->second.read)
		return Error(rawlog_path + ": none of the " + std::to_string(there->second.read) + " observations (" + names.class_name +
		             ") under label " + names.label + " has a time stamp; record them with their times");
	return Error(rawlog_path + ": no " + names.what + " (" + names.class_name + ") under label " + names.label +
	             "; labels here: " + counts.describe() + "; set " + names.key + " to one of them");
}
}  // namespace viwo
