#include <gtest/gtest.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CRawlog.h>
#include <viwo/rawlog/RawlogReader.h>
#include <viwo/rawlog/RawlogWriter.h>

#include <cstring>

#include "GzipArchive.h"
#include "TempFolder.h"

/** doc/rawlog-format.md, "Byte by byte", followed to the letter and without MRPT: what it makes is what MRPT writes and reads. */
namespace viwo
{
namespace
{
constexpr int64_t kStart_ns = 1'700'000'000'123'456'700;

/** Little endian, as the machines that MRPT runs on here. */
class ByHand
{
   public:
	std::string bytes;

	template <class Number>
	ByHand& put(Number value)
	{
		bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
		return *this;
	}
	ByHand& text(const std::string& s)
	{
		put(static_cast<uint32_t>(s.size()));
		bytes += s;
		return *this;
	}
	ByHand& begin(const std::string& class_name, uint8_t version)
	{
		put(static_cast<uint8_t>(0x80 | class_name.size()));
		bytes += class_name;
		return put(version);
	}
	ByHand& end() { return put(uint8_t{0x88}); }
	ByHand& stamp(int64_t t_ns) { return put(static_cast<uint64_t>(t_ns / 100 + 116'444'736'000'000'000)); }
	ByHand& pose(double x, double y, double z, const double (&R)[9])
	{
		begin("mrpt::poses::CPose3D", 3).put(x).put(y).put(z);
		for (const double r : R) put(r);
		return end();
	}
};

const double kIdentity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
const double kForwards[9] = {0, 0, 1, -1, 0, 0, 0, -1, 0};  //!< optical axes of a camera that looks along x

void imu(ByHand& b)
{
	b.begin("mrpt::obs::CObservationIMU", 4).pose(0.1, 0.2, 0.3, kIdentity);
	for (int i = 0; i < 31; ++i) b.put(static_cast<uint8_t>(i < 6 ? 1 : 0));
	b.stamp(kStart_ns);
	const double values[] = {1, 2, 9.8, 0.3, 0.2, 0.1};  // acc x y z, then rates about z, y, x
	for (int i = 0; i < 31; ++i) b.put(i < 6 ? values[i] : 0.0);
	b.text("IMU").end();
}

void odometry(ByHand& b, bool with_ticks)
{
	b.begin("mrpt::obs::CObservationOdometry", 2);
	b.begin("mrpt::poses::CPose2D", 1).put(1.0).put(2.0).put(0.5).end();
	b.text("ODOMETRY").stamp(kStart_ns + 1000).put(static_cast<uint8_t>(with_ticks));
	if (with_ticks) b.put(int32_t{30}).put(int32_t{-40});
	b.put(uint8_t{1}).put(0.2).put(0.0).put(0.1).end();
}

void scan(ByHand& b)
{
	b.begin("mrpt::obs::CObservation2DRangeScan", 7).put(1.5f).put(uint8_t{1}).put(20.f).pose(0.1, 0, 0.2, kIdentity);
	b.put(uint32_t{3}).put(1.f).put(2.f).put(20.f).put(uint8_t{1}).put(uint8_t{1}).put(uint8_t{0});
	b.put(0.01f).stamp(kStart_ns + 2000).put(0.f).text("LMS100").put(0.0).put(uint8_t{0}).end();
}

void image(ByHand& b)
{
	b.begin("mrpt::obs::CObservationImage", 4).pose(0.1, 0.06, 0.3, kForwards);
	b.begin("mrpt::img::TCamera", 6).put(0.0);
	for (const double d : {-0.25, 0.125, 1e-4, 2e-4, 0.0, 0.0, 0.0, 0.0}) b.put(d);
	b.put(338.0).put(339.0).put(321.0).put(238.0).put(uint32_t{480}).put(uint32_t{640}).text("camera1").put(uint8_t{1}).end();
	b.begin("mrpt::img::CImage", 9).put(uint8_t{1}).text("CAM_1700000000.123456700.jpg").end();
	b.stamp(kStart_ns + 3000).text("CAM").end();
}

/** The same by the library. */
void writeWithLibrary(const std::string& path)
{
	RawlogWriter writer(path);
	const auto at = [](double x, double y, double z) { return Pose3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(x, y, z)); };
	ImuSample sample;
	sample.t_ns = kStart_ns;
	sample.acc_m_s2 = {1, 2, 9.8};
	sample.gyro_rad_s = {0.1, 0.2, 0.3};
	writer.write(makeImu(sample, at(0.1, 0.2, 0.3)));
	writer.write(makeOdometry(kStart_ns + 1000, {0.2, 0.1}, EncoderTicks{30, -40}, 1, 2, 0.5));
	writer.write(makeOdometry(kStart_ns + 1000, {0.2, 0.1}, {}, 1, 2, 0.5));
	writer.write(makeScan(kStart_ns + 2000, {1.f, 2.f, 0.f}, 1.5, 20, at(0.1, 0, 0.2)));
	Eigen::Matrix3d R;
	R << 0, 0, 1, -1, 0, 0, 0, -1, 0;
	const CameraModel camera(640, 480, 338, 339, 321, 238, CameraModel::Distortion::plumb_bob, {-0.25, 0.125, 1e-4, 2e-4, 0});
	writer.write(
	    makeImage(kStart_ns + 3000, camera, Pose3(Eigen::Quaterniond(R), {0.1, 0.06, 0.3}), RawlogWriter::imageName("CAM", kStart_ns)));
	writer.close();
}

std::string plainBytes(const std::string& path)
{
	GzipArchiveReader reader(path);
	std::string bytes;
	char byte = 0;
	while (!reader.atEnd())
	{
		reader.ReadBuffer(&byte, 1);
		bytes += byte;
	}
	return bytes;
}

std::string all()
{
	ByHand b;
	imu(b);
	odometry(b, true);
	odometry(b, false);
	scan(b);
	image(b);
	return b.bytes;
}
}  // namespace

TEST(ByHand, IsByteForByteWhatMrptWrites)
{
	const testing::TempFolder folder;
	writeWithLibrary(folder.file("x.rawlog"));
	const std::string theirs = plainBytes(folder.file("x.rawlog")), ours = all();
	ASSERT_EQ(ours.size(), theirs.size());
	for (size_t i = 0; i < ours.size(); ++i) ASSERT_EQ(ours[i], theirs[i]) << "byte " << i;
}

TEST(ByHand, IsReadByMrpt)
{
	const testing::TempFolder folder;
	testing::writeFile(folder.file("x.rawlog"), all());
	mrpt::obs::CRawlog log;
	ASSERT_TRUE(log.loadFromRawLogFile(folder.file("x.rawlog")));
	ASSERT_EQ(log.size(), 5u);
	const auto imu = std::dynamic_pointer_cast<mrpt::obs::CObservationIMU>(log.getAsObservation(0));
	EXPECT_EQ(imu->get(mrpt::obs::IMU_WX), 0.1);
	EXPECT_EQ(imu->get(mrpt::obs::IMU_Z_ACC), 9.8);
	const auto odometry = std::dynamic_pointer_cast<mrpt::obs::CObservationOdometry>(log.getAsObservation(1));
	EXPECT_EQ(odometry->encoderRightTicks, -40);
	const auto image = std::dynamic_pointer_cast<mrpt::obs::CObservationImage>(log.getAsObservation(4));
	EXPECT_EQ(image->image.getExternalStorageFile(), "CAM_1700000000.123456700.jpg");
	EXPECT_EQ(image->cameraParams.fy(), 339);
	EXPECT_EQ(image->cameraParams.ncols, 640u);
}
}  // namespace viwo
