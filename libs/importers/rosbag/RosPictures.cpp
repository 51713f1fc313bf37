#include "RosInstance.h"
#include "RosMessages.h"

#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <viwo/core/AtomicFile.h>
#include <viwo/core/NumberText.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace viwo
{
namespace
{
/** How the bytes of an encoding lie, and what makes grey or BGR of them. */
struct Encoding
{
	const char* name;
	int cv_type;
	int to_bgr;  //!< OpenCV's conversion; -1: none
};

// ROS names a Bayer pattern by its first row, OpenCV by the second one's second and third pixel.
constexpr Encoding kEncodings[] = {
    {"mono8", CV_8UC1, -1},
    {"8UC1", CV_8UC1, -1},
    {"mono16", CV_16UC1, -1},
    {"16UC1", CV_16UC1, -1},
    {"bgr8", CV_8UC3, -1},
    {"8UC3", CV_8UC3, -1},
    {"rgb8", CV_8UC3, cv::COLOR_RGB2BGR},
    {"bgra8", CV_8UC4, cv::COLOR_BGRA2BGR},
    {"rgba8", CV_8UC4, cv::COLOR_RGBA2BGR},
    {"bayer_rggb8", CV_8UC1, cv::COLOR_BayerBG2BGR},
    {"bayer_bggr8", CV_8UC1, cv::COLOR_BayerRG2BGR},
    {"bayer_gbrg8", CV_8UC1, cv::COLOR_BayerGR2BGR},
    {"bayer_grbg8", CV_8UC1, cv::COLOR_BayerGB2BGR},
    {"bayer_rggb16", CV_16UC1, cv::COLOR_BayerBG2BGR},
    {"bayer_bggr16", CV_16UC1, cv::COLOR_BayerRG2BGR},
    {"bayer_gbrg16", CV_16UC1, cv::COLOR_BayerGR2BGR},
    {"bayer_grbg16", CV_16UC1, cv::COLOR_BayerGB2BGR},
    {"yuv422", CV_8UC2, cv::COLOR_YUV2BGR_UYVY},
    {"yuv422_yuy2", CV_8UC2, cv::COLOR_YUV2BGR_YUY2},
};

const Encoding& encodingOf(const std::string& name, const std::string& topic)
{
	// Drivers call both so: grey of an infrared camera, and millimetres.
	const bool is_depth = name == "16UC1" && isNamedAsDepth(topic);
	for (const Encoding& encoding : kEncodings)
		if (name == encoding.name && !is_depth) return encoding;
	throw UnusableTopic(topic, "pictures of encoding '" + name + "'" + (is_depth ? ", of depth by the topic's name," : "") +
	                               " cannot be taken (grey, colour, Bayer and YUV 4:2:2 can)");
}

void requireWritten(bool done, const std::string& path)
{
	if (!done) throw Error(path + ": cannot be written; check the space on the disk");
}

void writePng(const std::string& path, const cv::Mat& pixels)
{
	// Level 1: a third of the time of the default, and hardly larger.
	requireWritten(cv::imwrite(path, pixels, {cv::IMWRITE_PNG_COMPRESSION, 1}), path);
}

/** Of the bytes of a PNG or JPEG: PNG's signature, length and name of its first chunk, width and height come before the depth. */
bool isPngOf16Bit(const std::vector<uint8_t>& data)
{
	return data.size() > 24 && data[0] == 0x89 && data[24] == 16;
}

/** Empty where it cannot be decoded. OpenCV throws at sizes beyond its limits. */
cv::Mat decoded(const std::vector<uint8_t>& data)
try
{
	return cv::imdecode(data, cv::IMREAD_UNCHANGED);
}
catch (const cv::Exception&)
{
	return {};
}

/** The bytes are as many as the size needs. */
bool isSound(const sensor_msgs::Image& image, const Encoding& encoding)
{
	const uint64_t row_bytes = uint64_t{image.width} * static_cast<uint64_t>(CV_ELEM_SIZE(encoding.cv_type));
	constexpr uint32_t kLargest = std::numeric_limits<int>::max();
	return image.width > 0 && image.height > 0 && image.width <= kLargest && image.height <= kLargest && image.step >= row_bytes &&
	       image.data.size() >= uint64_t{image.step} * image.height;
}

/** The message's bytes as a matrix, in this machine's byte order. */
cv::Mat pixelsOf(const sensor_msgs::Image& image, const Encoding& encoding, const std::string& topic)
{
	if (!isSound(image, encoding))
		throw Error(topic + ": a picture of " + std::to_string(image.width) + "x" + std::to_string(image.height) + " " + image.encoding +
		            " has only " + counted(image.data.size(), "byte") + ": damaged; leave the topic out by a --map");
	cv::Mat pixels = cv::Mat(static_cast<int>(image.height), static_cast<int>(image.width), encoding.cv_type,
	                         const_cast<uint8_t*>(image.data.data()), image.step)
	                     .clone();
	if (CV_MAT_DEPTH(encoding.cv_type) != CV_16U || !image.is_bigendian) return pixels;
	for (auto at = pixels.begin<uint16_t>(); at != pixels.end<uint16_t>(); ++at) *at = static_cast<uint16_t>(*at << 8 | *at >> 8);
	return pixels;
}
}  // namespace

int RosPictures::bitsOf16(const std::string& topic, double brightest)
{
	const auto [at, is_new] = bits_of_topic_.try_emplace(topic, 16);
	if (is_new)
	{
		for (const int bits : {8, 10, 12, 14})
			if (brightest < std::ldexp(1, bits))
			{
				at->second = bits;
				break;
			}
		notes_.push_back(topic + ": pictures of 16 bit are written with 8, the brightest of the first one's says that " +
		                 std::to_string(at->second) + " are in use");
	}
	return at->second;
}

std::string RosPictures::extension(const rosbag::MessageInstance& message)
{
	if (message.isType<sensor_msgs::Image>()) return "png";
	const auto picture = instance<sensor_msgs::CompressedImage>(message);
	const auto& data = picture->data;
	if (data.size() > 2 && data[0] == 0xFF && data[1] == 0xD8) return "jpg";
	if (data.size() > 4 && data[0] == 0x89 && data[1] == 'P' && data[2] == 'N') return "png";
	throw UnusableTopic(message.getTopic(), "a compressed picture that is neither JPEG nor PNG");
}

std::pair<int, int> RosPictures::sizeOf(const rosbag::MessageInstance& message)
{
	if (message.isType<sensor_msgs::CompressedImage>())
	{
		extension(message);
		const cv::Mat pixels = decoded(instance<sensor_msgs::CompressedImage>(message)->data);
		return {pixels.cols, pixels.rows};
	}
	const auto image = instance<sensor_msgs::Image>(message);
	if (!isSound(*image, encodingOf(image->encoding, message.getTopic()))) return {0, 0};
	return {static_cast<int>(image->width), static_cast<int>(image->height)};
}

void RosPictures::to8Bit(cv::Mat& pixels, const std::string& topic)
{
	if (pixels.depth() != CV_16U) return;
	double brightest = 0;
	cv::minMaxLoc(pixels.reshape(1), nullptr, &brightest);
	pixels.convertTo(pixels, CV_8U, std::ldexp(1, 8 - bitsOf16(topic, brightest)));
}

std::pair<int, int> RosPictures::writeCompressed(const rosbag::MessageInstance& message, const std::string& path)
{
	const std::string& topic = message.getTopic();
	const auto picture = instance<sensor_msgs::CompressedImage>(message);
	const auto& data = picture->data;
	const auto [size, is_new] = compressed_size_.try_emplace(topic);
	if (is_new || isPngOf16Bit(data))
	{
		cv::Mat pixels = decoded(data);
		if (pixels.empty()) throw Error(topic + ": a compressed picture cannot be decoded: damaged; leave the topic out by a --map");
		size->second = {pixels.cols, pixels.rows};
		if (pixels.depth() == CV_16U)
		{
			to8Bit(pixels, topic);
			if (pixels.channels() == 4) cv::cvtColor(pixels, pixels, cv::COLOR_BGRA2BGR);
			writePng(path, pixels);
			return size->second;
		}
	}
	std::ofstream file(path, std::ios::binary);
	file.write(reinterpret_cast<const char*>(data.data()), static_cast<std::streamsize>(data.size()));
	file.close();
	requireWritten(static_cast<bool>(file), path);
	return size->second;
}

std::pair<int, int> RosPictures::write(const rosbag::MessageInstance& message, const std::string& path)
{
	if (message.isType<sensor_msgs::CompressedImage>()) return writeCompressed(message, path);
	const std::string& topic = message.getTopic();
	const auto image = instance<sensor_msgs::Image>(message);
	const Encoding& encoding = encodingOf(image->encoding, topic);
	cv::Mat pixels = pixelsOf(*image, encoding, topic);
	to8Bit(pixels, topic);
	if (encoding.to_bgr >= 0) cv::cvtColor(pixels, pixels, encoding.to_bgr);
	writePng(path, pixels);
	return {pixels.cols, pixels.rows};
}
}  // namespace viwo
