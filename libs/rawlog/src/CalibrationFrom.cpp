#include <viwo/core/MrptPose.h>
#include <viwo/rawlog/ObservationAdapter.h>
#include <viwo/rawlog/RawlogWriter.h>

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
}  // namespace

Calibration calibrationFrom(const AdapterOptions& options, const mrpt::obs::CObservationImage* image, const mrpt::obs::CObservationIMU* imu)
{
	Calibration calibration;
	calibration.wheels.track_m = options.track_m;
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
	RawlogReaderOptions reader_options;
	reader_options.labels = {options.cam_label, options.imu_label};
	reader_options.allow_truncated = allow_truncated;
	reader_options.skip_missing_images = true;
	RawlogReader reader(rawlog_path, reader_options);
	mrpt::obs::CObservationImage::Ptr image;
	mrpt::obs::CObservationIMU::Ptr imu;
	while ((needs_camera && !image) || (needs_imu && !imu))
	{
		const auto observation = reader.next();
		if (!observation)
			throw missingSensorError(rawlog_path, needs_camera && !image ? SensorKind::camera : SensorKind::imu, options, reader.counts());
		if (!image && observation->sensorLabel == options.cam_label)
			image = std::dynamic_pointer_cast<mrpt::obs::CObservationImage>(observation);
		if (!imu && observation->sensorLabel == options.imu_label) imu = std::dynamic_pointer_cast<mrpt::obs::CObservationIMU>(observation);
	}
	try
	{
		return calibrationFrom(options, needs_camera ? image.get() : nullptr, needs_imu ? imu.get() : nullptr);
	}
	catch (const Error& e)
	{
		throw Error(rawlog_path + ": " + e.what());
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
	             "; labels here: " + counts.describe() + "; set " + names.key + " in the configuration");
}
}  // namespace viwo
