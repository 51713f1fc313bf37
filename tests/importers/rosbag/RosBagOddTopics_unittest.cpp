#include "AllTypesBag.h"
#include "BagFixture.h"
#include "ExpectError.h"
#include "RosTopicMap.h"
#include "RunProgram.h"

#include <std_msgs/String.h>
#include <viwo/importers/RecordingInfo.h>

#include <filesystem>
#include <limits>

using namespace viwo;
using namespace viwo::testing;

namespace
{
class RosBagOddTopics : public RosBag
{
   protected:
	/** As of another release's definition: the same name with another sum. */
	template <class Message>
	void changeSumOf()
	{
		std::string bytes = readFile(path("x.bag"));
		const std::string sum = ros::message_traits::MD5Sum<Message>::value();
		for (size_t at = bytes.find(sum); at != std::string::npos; at = bytes.find(sum, at + 1)) bytes.replace(at, 4, "0000");
		writeFile(path("x.bag"), bytes);
	}
	void expectLeftOut(const ImportResult& result, const std::string& note)
	{
		EXPECT_TRUE(isNote(result, note)) << note;
		EXPECT_EQ(result.odometry_samples, 10u);
	}
	std::string verdicts()
	{
		return describeRecording(inspectRecording(path("x.bag"), [](double) { return true; }));
	}
	void expectVerdict(const std::string& line)
	{
		const std::string text = verdicts();
		EXPECT_NE(text.find(line), std::string::npos) << line << "\n" << text;
	}
	static ProgramResult run(const std::vector<std::string>& arguments)
	{
		return runProgram(VIWO_BINARY_DIR "/bin/viwo-import", arguments);
	}
};

sensor_msgs::CompressedImage compressedImage(int64_t t_ms, const cv::Mat& pixels)
{
	auto message = stamped<sensor_msgs::CompressedImage>(t_ms, "cam");
	message.format = "png";
	cv::imencode(".png", pixels, message.data);
	return message;
}
/** rosbag knows a connection by its topic, unless it is given what a publisher said of itself. */
template <class Message>
void writeOnAConnectionOfItsOwn(rosbag::Bag& bag, const std::string& topic, const Message& message)
{
	namespace traits = ros::message_traits;
	auto publisher = boost::make_shared<ros::M_string>();
	(*publisher)["type"] = traits::datatype(message);
	(*publisher)["md5sum"] = traits::md5sum(message);
	(*publisher)["message_definition"] = traits::definition(message);
	bag.write(topic, bagTime(20), message, publisher);
}
}  // namespace

TEST_F(RosBagOddTopics, PicturesThatAreNoneAreLeftOut)
{
	writeBag(
	    [](rosbag::Bag& bag)
	    {
		    bag.write("/a/image", bagTime(0), imageMessage(0, "cam", "mono8", 1, 1));
		    bag.write("/b/image", bagTime(0), imageMessage(0, "cam", "32FC1", 1, 4));
		    auto message = stamped<sensor_msgs::CompressedImage>(1, "cam");
		    message.data = {'n', 'o', 't', 'h', 'i', 'n', 'g'};
		    bag.write("/c/compressed", bagTime(1), message);
	    });
	const ImportResult result = import();
	expectLeftOut(result, "/b/image (sensor_msgs/Image) is left out: pictures of encoding '32FC1'");
	expectLeftOut(result, "/c/compressed (sensor_msgs/CompressedImage) is left out: a compressed picture that is neither JPEG nor PNG");
	EXPECT_EQ(result.images, 1u);
	expectVerdict("note: /b/image (sensor_msgs/Image) is left out");
	expectError([&] { import(writeMap("[CAM]\ntopic = /b/image\n")); }, {"/b/image", "32FC1", "--map"});
}

// That nothing is damaged is for the import to see.
TEST_F(RosBagOddTopics, ADamagedPictureDoesNotKeepViwoInfoFromCounting)
{
	writeBag(
	    [](rosbag::Bag& bag)
	    {
		    auto message = stamped<sensor_msgs::CompressedImage>(1, "cam");
		    message.data = {0xFF, 0xD8, 'n', 'o', 'n', 'e'};
		    bag.write("/cam/image_raw/compressed", bagTime(1), message);
		    bag.write("/cam/camera_info", bagTime(1), cameraInfoMessage("cam", "plumb_bob", {0, 0, 0, 0, 0}));
	    });
	expectVerdict("/cam/image_raw/compressed  sensor_msgs/CompressedImage");
	expectError([&] { import(); }, {"/cam/image_raw/compressed", "cannot be decoded: damaged"});
}

TEST_F(RosBagOddTopics, CloudsAndScansWithoutWhatTheyNeedAreLeftOut)
{
	writeBag(
	    [](rosbag::Bag& bag)
	    {
		    auto cloud = cloudMessage(0, "laser", {{1, 2, 3}});
		    cloud.fields[0].datatype = sensor_msgs::PointField::FLOAT64;
		    bag.write("/points", bagTime(0), cloud);
		    bag.write("/scan", bagTime(1), stamped<sensor_msgs::LaserScan>(1, "laser"));
	    });
	const ImportResult result = import();
	expectLeftOut(result, "/points (sensor_msgs/PointCloud2) is left out: its points have no x of 32-bit floating point");
	expectLeftOut(result, "/scan (sensor_msgs/LaserScan) is left out: a scan without ranges");
	expectVerdict("viwo-groundtruth  no, without 2D scans");
}

TEST_F(RosBagOddTopics, AnotherDefinitionOfATypeIsLeftOut)
{
	writeBag([](rosbag::Bag& bag) { bag.write("/base/twist", bagTime(0), stamped<geometry_msgs::TwistStamped>(0, "base")); });
	changeSumOf<geometry_msgs::TwistStamped>();
	expectLeftOut(import(), "/base/twist (geometry_msgs/TwistStamped) is left out: geometry_msgs/TwistStamped with MD5 sum 0000");
}

TEST_F(RosBagOddTopics, ACameraInfoThatDoesNotFitLeavesThePictures)
{
	const auto write = [this](const sensor_msgs::CameraInfo& info)
	{
		writeBag(
		    [&](rosbag::Bag& bag)
		    {
			    bag.write("/cam/image_raw", bagTime(0), imageMessage(0, "cam", "mono8", 1, 1));
			    bag.write("/cam/camera_info", bagTime(0), info);
		    });
	};
	write(cameraInfoMessage("cam", "rational_polynomial", {0.1, 0.1, 0, 0, 0.1, 0.1, 0.1, 0.1}));
	const ImportResult rational = import();
	expectLeftOut(rational, "/cam/camera_info is left out for /cam/image_raw: lens model 'rational_polynomial' with 8 coefficients");
	EXPECT_EQ(rational.images, 1u);

	auto large = cameraInfoMessage("cam", "plumb_bob", {0, 0, 0, 0, 0});
	large.width = 32, large.height = 24;
	write(large);
	const ImportResult scaled = import();
	expectLeftOut(scaled, "/cam/camera_info is left out for /cam/image_raw: it is for 32x24 pixels, not for 16x12");
	EXPECT_EQ(scaled.images, 1u);
	EXPECT_EQ(RawlogContent(path("x.rawlog")).images.at(0)->cameraParams.fx(), 0);
}

TEST_F(RosBagOddTopics, The16BitOfAnInfraredCameraAreGreyAndThoseOfDepthAreNot)
{
	writeBag([](rosbag::Bag& bag) { bag.write("/thermal/image_raw", bagTime(0), imageMessage(0, "cam", "16UC1", 1, 2)); });
	const ImportResult result = import();
	EXPECT_EQ(result.images, 1u);
	EXPECT_TRUE(isNote(result, "/thermal/image_raw: pictures of 16 bit are written with 8"));

	writeBag([](rosbag::Bag& bag) { bag.write("/depth/image_raw", bagTime(0), imageMessage(0, "cam", "16UC1", 1, 2)); });
	expectLeftOut(import(), "/depth/image_raw (sensor_msgs/Image) is left out: not a picture in grey or colour");
	expectVerdict("--mode vio        no, without images, an IMU");
	expectError([&] { import(writeMap("[CAM]\ntopic = /depth/image_raw\n")); }, {"/depth/image_raw", "16UC1", "of depth"});
}

TEST_F(RosBagOddTopics, ACompressedPictureOf16BitIsWrittenWith8)
{
	for (const int type : {CV_16UC1, CV_16UC4})
	{
		cv::Mat pixels(12, 16, type, cv::Scalar::all(200));
		pixels.ptr<uint16_t>(0)[0] = 1000;
		writeBag(
		    [&](rosbag::Bag& bag)
		    {
			    // The first one says that ten bits are in use.
			    bag.write("/cam/image_raw/compressed", bagTime(0), compressedImage(0, pixels));
			    bag.write("/cam/image_raw/compressed", bagTime(100), compressedImage(100, cv::Mat(12, 16, type, cv::Scalar::all(400))));
		    });
		EXPECT_TRUE(isNote(import(), "10 are in use"));
		const RawlogContent content(path("x.rawlog"));
		ASSERT_EQ(content.images.size(), 2u);
		const auto picture = [&](size_t i)
		{ return cv::imread(content.images[i]->image.getExternalStorageFileAbsolutePath(), cv::IMREAD_UNCHANGED); };
		ASSERT_EQ(picture(0).type(), type == CV_16UC1 ? CV_8UC1 : CV_8UC3);
		EXPECT_EQ(picture(0).ptr<uint8_t>(0)[0], 250);
		EXPECT_EQ(picture(0).ptr<uint8_t>(5)[5], 50);
		EXPECT_EQ(picture(1).ptr<uint8_t>(5)[5], 100);
	}
}

TEST(RosTopicNames, RectifiedIsAPartOfTheLastWord)
{
	for (const char* topic : {"/left/image_rect", "/left/image_rect_color", "/image_rect/compressed", "/cam/Rectified"})
		EXPECT_TRUE(isRectified(topic)) << topic;
	for (const char* topic : {"/direct/image_raw", "/image_direct", "/rect/image_raw", "/rect/image_raw/compressed", "/cam/correction"})
		EXPECT_FALSE(isRectified(topic)) << topic;

	const auto leftOut = [](const std::vector<RosTopic>& topics) { return proposeTopicMap(topics).notes; };
	const std::string image = "sensor_msgs/Image", compressed = "sensor_msgs/CompressedImage";
	EXPECT_TRUE(leftOut({{"/direct/image_raw", image, 1}}).empty());
	EXPECT_TRUE(leftOut({{"/a/image_rect", image, 1}}).empty());
	EXPECT_EQ(leftOut({{"/a/image_raw", image, 1}, {"/a/image_rect", image, 1}}).size(), 1u);
	EXPECT_EQ(leftOut({{"/a/image_raw/compressed", compressed, 1}, {"/a/image_rect/compressed", compressed, 1}}).size(), 1u);
}

TEST(RosTopicNames, DepthIsToldByThePictureAndItsFolder)
{
	for (const char* topic : {"/camera/depth/image_raw", "/camera/depth/image_rect_raw/compressed", "/camera/Depth/image",
	                          "/camera/aligned_depth_to_color/image_raw", "/zed/depth_registered", "depth"})
		EXPECT_TRUE(isNamedAsDepth(topic)) << topic;
	for (const char* topic : {"/depth_camera/color/image_raw", "/depth_camera/color/image_raw/compressed", "/camera/image_raw"})
		EXPECT_FALSE(isNamedAsDepth(topic)) << topic;
}

TEST_F(RosBagOddTopics, OfTwoTypesOnATopicThatOfASensorIsRead)
{
	writeBag(
	    [](rosbag::Bag& bag)
	    {
		    std_msgs::String text;
		    text.data = "hello";
		    writeOnAConnectionOfItsOwn(bag, "/odom", text);
		    writeOnAConnectionOfItsOwn(bag, "/odom", geometry_msgs::PoseStamped());
	    });
	const ImportResult result = import();
	expectLeftOut(result, "/odom: of two types, nav_msgs/Odometry and std_msgs/String; left out: 1 message of the latter");
	expectLeftOut(result, "/odom: of two types, nav_msgs/Odometry and geometry_msgs/PoseStamped");
	expectVerdict("--mode wheel      yes\n");
	expectVerdict("note: /odom: of two types, nav_msgs/Odometry and std_msgs/String");
}

TEST_F(RosBagOddTopics, WhatNeedsAMapOrIsACommandIsSaidSoByBothPrograms)
{
	{
		rosbag::Bag bag(path("x.bag"), rosbag::bagmode::Write);
		bag.write("/joint_states", bagTime(0), wheelsMessage(0));
		bag.close();
	}
	expectVerdict("--mode wheel      yes; /joint_states needs a --map in viwo-import rosbag\n");
	expectError([&] { import(); },
	            {"without a --map", "/joint_states", "left_joints, right_joints, wheel_radius_m and track_m", "left out"});

	writeBag([](rosbag::Bag& bag) { bag.write("/joint_states", bagTime(0), wheelsMessage(0)); });
	expectVerdict("--mode wheel      yes\n");

	rosbag::Bag bag(path("x.bag"), rosbag::bagmode::Write);
	bag.write("/cmd_vel_stamped", bagTime(0), stamped<geometry_msgs::TwistStamped>(0, "base"));
	bag.close();
	expectVerdict("--mode wheel      no, without wheel odometry\n");
	expectVerdict("note: /cmd_vel_stamped (geometry_msgs/TwistStamped) is left out: a command, not a measurement");
	expectError([&] { import(); }, {"without a --map", "a command, not a measurement"});
}

TEST_F(RosBagOddTopics, ABagWithoutMessagesIsNotTruncated)
{
	rosbag::Bag(path("x.bag"), rosbag::bagmode::Write).close();
	expectError([&] { import(); }, {"x.bag: there are no messages in it"});
	expectError([&] { verdicts(); }, {"x.bag: there are no messages in it"});
}

// What a user edits is there though the import fails.
TEST_F(RosBagOddTopics, TheProposalIsPrintedBeforeTheWork)
{
	writeBag(
	    [](rosbag::Bag& bag)
	    {
		    bag.write("/cam/image_raw", bagTime(0), imageMessage(0, "cam", "mono8", 1, 1));
		    bag.write("/cam/image_raw", bagTime(100), imageMessage(100, "cam", "32FC1", 1, 4));
	    });
	const ProgramResult late = run({"rosbag", "--auto", path("x.bag"), "-o", path("x.rawlog")});
	EXPECT_EQ(late.status, 1);
	EXPECT_EQ(late.errorLines(), 1u) << late.err;
	EXPECT_NE(late.out.find("[CAM]\ntopic = /cam/image_raw\n"), std::string::npos) << late.out;
	EXPECT_FALSE(std::filesystem::exists(path("x.rawlog")));
	writeFile(path("edited.ini"), late.out.substr(0, late.out.find("[CAM]")) + "\n[ODOMETRY]\ntopic = /odom\n");
	const ProgramResult edited = run({"rosbag", "--map", path("edited.ini"), path("x.bag"), "-o", path("x.rawlog")});
	EXPECT_EQ(edited.status, 0) << edited.err;
	EXPECT_EQ(edited.out.find("[general]"), 0u);
	EXPECT_EQ(edited.out.rfind("[general]"), 0u) << "printed once";

	// Before a word can be said on frames: the message that has them is of another definition.
	writeBag([](rosbag::Bag& bag) { bag.write("/tf_static", bagTime(0), tf2_msgs::TFMessage()); });
	changeSumOf<tf2_msgs::TFMessage>();
	const ProgramResult early = run({"rosbag", path("x.bag"), "-o", path("x.rawlog")});
	EXPECT_EQ(early.status, 1) << early.err;
	EXPECT_NE(early.out.find("[ODOMETRY]\ntopic = /odom\n"), std::string::npos) << early.out;
}
