#pragma once

#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <viwo/core/CameraModel.h>
#include <viwo/core/ImuSample.h>
#include <viwo/core/Pose3.h>
#include <viwo/core/WheelSample.h>
#include <viwo/rawlog/EncoderTicks.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace viwo
{
/** Writes an observation-only rawlog, compressed by gzip, of MRPT's stock classes. It appears under its name with close(), whole or not at
 * all. The same observations give the same bytes.
 */
class RawlogWriter
{
   public:
	/** @throws Error when the folder does not exist or cannot be written. */
	explicit RawlogWriter(const std::string& path);
	/** Without close() no rawlog appears; files that imagePath() named and that were not there before are removed again, and so is their
	 * folder if it was made for them. */
	~RawlogWriter();

	void write(const mrpt::obs::CObservation& observation);

	/** @throws Error when anything could not be written (disk full). */
	void close();

	/** NAME_Images beside the rawlog; created by the first call. @throws Error when it cannot be. */
	const std::string& imagesFolder();

	/** File name of an image inside of imagesFolder(): LABEL_SECONDS.EXTENSION, with 9 decimals. What makeImage() takes. */
	static std::string imageName(const std::string& label, int64_t t_ns, const std::string& extension = "jpg");

	/** Where to save that image: imagesFolder() + "/" + imageName(). */
	std::string imagePath(const std::string& label, int64_t t_ns, const std::string& extension = "jpg");

   private:
	struct Impl;
	std::unique_ptr<Impl> impl_;
};

/** @name Observations of the stock classes, made from viwo's types. Stamps are rounded to MRPT's 100 ns. T_Ox: pose of the sensor in O.
 *  @{ */

/** Slots in MRPT's order (acc x y z, then the rates wz wy wx). */
mrpt::obs::CObservationIMU makeImu(const ImuSample& sample, const Pose3& T_OB, const std::string& label = "IMU");

/** @param ticks absolute.
 *  @param pose_x_m, pose_y_m, pose_yaw_rad odometry's own pose, accumulated from the start (absolute). */
mrpt::obs::CObservationOdometry makeOdometry(int64_t t_ns, const WheelTwist& twist, const std::optional<EncoderTicks>& ticks = {},
                                             double pose_x_m = 0, double pose_y_m = 0, double pose_yaw_rad = 0,
                                             const std::string& label = "ODOMETRY");

/** An image kept in its own file. @param file_name what RawlogWriter::imageName() gave. @param T_OC optical axes. */
mrpt::obs::CObservationImage makeImage(int64_t t_ns, const CameraModel& camera, const Pose3& T_OC, const std::string& file_name,
                                       const std::string& label = "CAM");

/** An image inside of the rawlog. */
mrpt::obs::CObservationImage makeEmbeddedImage(int64_t t_ns, const CameraModel& camera, const Pose3& T_OC, const mrpt::img::CImage& image,
                                               const std::string& label = "CAM");

/** Ranges (m) from right to left, evenly over the aperture; 0, NaN or beyond max_range_m: no return. */
mrpt::obs::CObservation2DRangeScan makeScan(int64_t t_ns, const std::vector<float>& ranges_m, double aperture_rad, double max_range_m,
                                            const Pose3& T_OL, const std::string& label = "LMS100");
/** @} */

/** The two camera models: MRPT's TCamera (any pinhole, plumb_bob or kannala_brandt) and ours. */
mrpt::img::TCamera toMrpt(const CameraModel& camera);
/** @throws Error: focal length 0, negative or not finite; image size 0; more than 5 plumb_bob coefficients. */
CameraModel fromMrpt(const mrpt::img::TCamera& camera);
}  // namespace viwo
