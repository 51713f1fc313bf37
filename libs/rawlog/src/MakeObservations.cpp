#include <viwo/core/Error.h>
#include <viwo/core/MrptPose.h>
#include <viwo/core/NumberText.h>
#include <viwo/rawlog/MrptTime.h>
#include <viwo/rawlog/RawlogWriter.h>

#include <cmath>

namespace viwo
{
mrpt::obs::CObservationIMU makeImu(const ImuSample& sample, const Pose3& T_OB, const std::string& label)
{
	mrpt::obs::CObservationIMU imu;
	imu.sensorLabel = label;
	imu.timestamp = mrptTime(sample.t_ns);
	imu.sensorPose = toMrpt(T_OB);
	imu.set(mrpt::obs::IMU_X_ACC, sample.acc_m_s2.x());
	imu.set(mrpt::obs::IMU_Y_ACC, sample.acc_m_s2.y());
	imu.set(mrpt::obs::IMU_Z_ACC, sample.acc_m_s2.z());
	imu.set(mrpt::obs::IMU_WX, sample.gyro_rad_s.x());
	imu.set(mrpt::obs::IMU_WY, sample.gyro_rad_s.y());
	imu.set(mrpt::obs::IMU_WZ, sample.gyro_rad_s.z());
	return imu;
}

mrpt::obs::CObservationOdometry makeOdometry(int64_t t_ns, const WheelTwist& twist, const std::optional<EncoderTicks>& ticks,
                                             double pose_x_m, double pose_y_m, double pose_yaw_rad, const std::string& label)
{
	mrpt::obs::CObservationOdometry odometry;
	odometry.sensorLabel = label;
	odometry.timestamp = mrptTime(t_ns);
	odometry.odometry = mrpt::poses::CPose2D(pose_x_m, pose_y_m, pose_yaw_rad);
	odometry.hasVelocities = true;
	odometry.velocityLocal = {twist.v_m_s, 0, twist.w_rad_s};
	odometry.hasEncodersInfo = ticks.has_value();
	if (ticks)
	{
		odometry.encoderLeftTicks = ticks->left;
		odometry.encoderRightTicks = ticks->right;
	}
	return odometry;
}

mrpt::obs::CObservationImage makeImage(int64_t t_ns, const CameraModel& camera, const Pose3& T_OC, const std::string& file_name,
                                       const std::string& label)
{
	mrpt::obs::CObservationImage image;
	image.sensorLabel = label;
	image.timestamp = mrptTime(t_ns);
	image.cameraPose = toMrpt(T_OC);
	image.cameraParams = toMrpt(camera);
	image.image.setExternalStorage(file_name);
	return image;
}

mrpt::obs::CObservationImage makeEmbeddedImage(int64_t t_ns, const CameraModel& camera, const Pose3& T_OC, const mrpt::img::CImage& pixels,
                                               const std::string& label)
{
	mrpt::obs::CObservationImage image;
	image.sensorLabel = label;
	image.timestamp = mrptTime(t_ns);
	image.cameraPose = toMrpt(T_OC);
	image.cameraParams = toMrpt(camera);
	image.image = pixels;
	return image;
}

mrpt::obs::CObservation2DRangeScan makeScan(int64_t t_ns, const std::vector<float>& ranges_m, double aperture_rad, double max_range_m,
                                            const Pose3& T_OL, const std::string& label)
{
	mrpt::obs::CObservation2DRangeScan scan;
	scan.sensorLabel = label;
	scan.timestamp = mrptTime(t_ns);
	scan.sensorPose = toMrpt(T_OL);
	scan.aperture = static_cast<float>(aperture_rad);
	scan.maxRange = static_cast<float>(max_range_m);
	scan.rightToLeft = true;
	scan.resizeScan(ranges_m.size());
	for (size_t i = 0; i < ranges_m.size(); i++)
	{
		const bool is_return = ranges_m[i] > 0 && ranges_m[i] <= scan.maxRange;
		scan.setScanRange(i, is_return ? ranges_m[i] : scan.maxRange);
		scan.setScanRangeValidity(i, is_return);
	}
	return scan;
}

mrpt::img::TCamera toMrpt(const CameraModel& camera)
{
	mrpt::img::TCamera mrpt_camera;
	mrpt_camera.ncols = static_cast<uint32_t>(camera.width_px());
	mrpt_camera.nrows = static_cast<uint32_t>(camera.height_px());
	mrpt_camera.setIntrinsicParamsFromValues(camera.fx_px(), camera.fy_px(), camera.cx_px(), camera.cy_px());
	const auto& c = camera.coefficients();
	switch (camera.distortion())
	{
		case CameraModel::Distortion::none:
			break;
		case CameraModel::Distortion::plumb_bob:
			mrpt_camera.distortion = mrpt::img::DistortionModel::plumb_bob;
			mrpt_camera.dist = {c[0], c[1], c[2], c[3], c[4], 0, 0, 0};
			break;
		case CameraModel::Distortion::kannala_brandt:
			// MRPT's slots 2 and 3 are those of plumb_bob's p1 and p2.
			mrpt_camera.distortion = mrpt::img::DistortionModel::kannala_brandt;
			mrpt_camera.dist = {c[0], c[1], 0, 0, c[2], c[3], 0, 0};
			break;
	}
	return mrpt_camera;
}

CameraModel fromMrpt(const mrpt::img::TCamera& camera)
{
	const double fx = camera.fx(), fy = camera.fy();
	if (fx == 0 || fy == 0) throw Error("the camera has no calibration (focal length 0)");
	const auto& d = camera.dist;
	bool is_finite = std::isfinite(fx) && std::isfinite(fy) && std::isfinite(camera.cx()) && std::isfinite(camera.cy());
	for (double coefficient : d) is_finite = is_finite && std::isfinite(coefficient);
	if (!is_finite || fx < 0 || fy < 0) throw Error("the camera's calibration has a negative or non-finite value");
	if (camera.ncols == 0 || camera.nrows == 0 || camera.ncols > 100000 || camera.nrows > 100000)
		throw Error("the camera's calibration gives no sensible image size");
	// A calibration that was made at another resolution, with its size corrected and the rest not.
	const double width = camera.ncols, height = camera.nrows;
	if (camera.cx() < 0 || camera.cx() > width || camera.cy() < 0 || camera.cy() > height || fx < 0.1 * width || fx > 20 * width ||
	    fy / fx < 0.5 || fy / fx > 2)
		throw Error("the camera's calibration (fx " + fixed(fx, 1) + ", fy " + fixed(fy, 1) + ", cx " + fixed(camera.cx(), 1) + ", cy " +
		            fixed(camera.cy(), 1) + ") is not one of images of " + std::to_string(camera.ncols) + " x " +
		            std::to_string(camera.nrows) +
		            " pixels: the principal point must lie inside, fx and fy be alike, of some tenths to some times the width");

	const auto model = [&](CameraModel::Distortion distortion, const std::array<double, 5>& coefficients)
	{
		return CameraModel(static_cast<int>(camera.ncols), static_cast<int>(camera.nrows), fx, fy, camera.cx(), camera.cy(), distortion,
		                   coefficients);
	};
	switch (camera.distortion)
	{
		case mrpt::img::DistortionModel::plumb_bob:
			if (d[5] != 0 || d[6] != 0 || d[7] != 0)
				throw Error("the camera's distortion has more than the five terms k1 k2 p1 p2 k3; calibrate with five");
			return model(CameraModel::Distortion::plumb_bob, {d[0], d[1], d[2], d[3], d[4]});
		case mrpt::img::DistortionModel::kannala_brandt:
			return model(CameraModel::Distortion::kannala_brandt, {d[0], d[1], d[4], d[5], 0});
		default:
			return model(CameraModel::Distortion::none, {});
	}
}
}  // namespace viwo
