#pragma once

#include <gtest/gtest.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>
#include <viwo/core/Error.h>
#include <viwo/rawlog/MrptTime.h>
#include <viwo/rawlog/RawlogReader.h>
#include <viwo/rawlog/RawlogWriter.h>

#include <functional>
#include <string>
#include <vector>

#include "TempFolder.h"

namespace viwo::testing
{
constexpr int64_t kStart_ns = 1700000000123456700;
constexpr int64_t kMillisecond_ns = 1000000;

/** The bytes of objects, one behind the other, as in an uncompressed rawlog. */
class PlainRawlog
{
   public:
	PlainRawlog& operator<<(const mrpt::serialization::CSerializable& object)
	{
		auto archive = mrpt::serialization::archiveFrom(stream_);
		archive.WriteObject(object);
		return *this;
	}
	std::string bytes()
	{
		const auto* begin = static_cast<const char*>(stream_.getRawBufferData());
		return {begin, static_cast<size_t>(stream_.getTotalBytesCount())};
	}

   private:
	mrpt::io::CMemoryStream stream_;
};

inline CameraModel smallCamera()
{
	return {64, 48, 30.5, 31.5, 32.25, 24.75, CameraModel::Distortion::plumb_bob, {-0.1, 0.02, 0.001, -0.002, 0.003}};
}

inline mrpt::img::CImage gradientImage(int width = 64, int height = 48)
{
	mrpt::img::CImage image(static_cast<unsigned>(width), static_cast<unsigned>(height), mrpt::img::CH_GRAY);
	for (int v = 0; v < height; v++)
		for (int u = 0; u < width; u++)
			*image.ptr<uint8_t>(static_cast<unsigned>(u), static_cast<unsigned>(v)) = static_cast<uint8_t>(40 + 2 * u + v);
	return image;
}

inline ImuSample imuSample(int64_t t_ns)
{
	return {t_ns, Eigen::Vector3d(0.1, -0.2, 9.7), Eigen::Vector3d(0.01, 0.02, -0.03)};
}

/** 1 s: images at 10 Hz in their own files, IMU at 200 Hz, odometry at 20 Hz, scans at 25 Hz; in the order of time. */
inline void writeSecond(const std::string& path, bool external_images = true)
{
	RawlogWriter writer(path);
	const Pose3 T_OC(forwardOpticalAxes(), Eigen::Vector3d(0.1, 0, 0.3));
	for (int ms = 0; ms < 1000; ms += 5)
	{
		const int64_t t_ns = kStart_ns + ms * kMillisecond_ns;
		writer.write(makeImu(imuSample(t_ns), Pose3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.05, 0, 0.3))));
		if (ms % 50 == 0) writer.write(makeOdometry(t_ns, {0.15, 0.1}, EncoderTicks{ms, 2 * ms}, 0.15e-3 * ms));
		if (ms % 40 == 0) writer.write(makeScan(t_ns, std::vector<float>(541, 2.5f), 4.712389, 20, Pose3()));
		if (ms % 100 != 0) continue;
		if (external_images)
		{
			gradientImage().saveToFile(writer.imagePath("CAM", t_ns, "png"));
			writer.write(makeImage(t_ns, smallCamera(), T_OC, RawlogWriter::imageName("CAM", t_ns, "png")));
		}
		else
			writer.write(makeEmbeddedImage(t_ns, smallCamera(), T_OC, gradientImage()));
	}
	writer.close();
}
constexpr size_t kSecondImages = 10, kSecondImu = 200, kSecondOdometry = 20, kSecondScans = 25;
constexpr size_t kSecondEntries = kSecondImages + kSecondImu + kSecondOdometry + kSecondScans;

inline std::vector<mrpt::obs::CObservation::Ptr> readAll(RawlogReader& reader)
{
	std::vector<mrpt::obs::CObservation::Ptr> observations;
	while (auto observation = reader.next()) observations.push_back(observation);
	return observations;
}

inline std::vector<mrpt::obs::CObservation::Ptr> readAll(const std::string& path, const RawlogReaderOptions& options = {})
{
	RawlogReader reader(path, options);
	return readAll(reader);
}

/** What is delivered up to the first Error, and its message ("" at a clean end). */
struct PartialRead
{
	std::vector<mrpt::obs::CObservation::Ptr> observations;
	std::string error;
};

inline PartialRead readUntilError(RawlogReader& reader)
{
	PartialRead result;
	try
	{
		while (auto observation = reader.next()) result.observations.push_back(observation);
	}
	catch (const Error& e)
	{
		result.error = e.what();
	}
	return result;
}

class RawlogTest : public ::testing::Test
{
   protected:
	/** A whole file of our writer, in memory. */
	std::string secondBytes()
	{
		writeSecond(folder.file("second.rawlog"), false);
		return readFile(folder.file("second.rawlog"));
	}

	TempFolder folder;
	std::string path = folder.file("test.rawlog");
};
}  // namespace viwo::testing
