#include "ExpectError.h"
#include "Refused.h"
#include "ScanRoom.h"

#include <octomap/OcTree.h>
#include <viwo/mapping/Landmarks.h>
#include <viwo/mapping/OctoMapRun.h>

#include <gtest/gtest.h>

#include <sstream>

namespace viwo
{
namespace
{
using namespace testing;

/** A folder as viwo-odometry leaves it: two key frames, three landmarks, of which one is vague. */
void writeOdometryFolder(const TempFolder& folder)
{
	Trajectory trajectory;
	for (int i = 0; i <= 10; ++i)
		trajectory.push_back({ScanRoom::kStart_ns + i * 100'000'000, Pose3(Eigen::Quaterniond::Identity(), {0.1 * i, 0, 0})});
	trajectory.saveTum(folder.file("trajectory.tum"));
	saveLandmarks(folder.file("landmarks.ply"), {{4, {3, 1, 2}, 0.01}, {7, {3, -1, 1.5}, 0.02}, {9, {2, 2, 2}, 0.5}});
	writeFile(folder.file("keyframes.csv"),
	          "# camera\nt_ns,x,y,z,qx,qy,qz,qw\n1700000000200000000,0.3,0,0.5,0,0,0,1\n1700000000600000000,0.7,0,0.5,0,0,0,1\n");
	writeFile(folder.file("landmark_observations.csv"),
	          "landmark_id,t_ns\n4,1700000000200000000\n4,1700000000600000000\n7,1700000000600000000\n9,1700000000600000000\n");
}
}  // namespace

TEST(Landmarks, RaysFromTheKeyFramesThatSawThem)
{
	const TempFolder folder;
	writeOdometryFolder(folder);
	const Trajectory own = Trajectory::loadTum(folder.file("trajectory.tum"));
	const std::vector<RayScan> scans = landmarkRays(folder.path(), own, 1, 0.05);
	ASSERT_EQ(scans.size(), 2u);
	ASSERT_EQ(scans[0].hits.size(), 1u);
	ASSERT_EQ(scans[1].hits.size(), 2u) << "the vague one is left out";
	EXPECT_LT((scans[0].hits[0].origin - octomap::point3d(0.3f, 0, 0.5f)).norm(), 1e-5);
	EXPECT_LT((scans[1].hits[1].end - octomap::point3d(3, -1, 1.5f)).norm(), 1e-5);
}

TEST(Landmarks, MoveAlongWithABetterTrajectory)
{
	const TempFolder folder;
	writeOdometryFolder(folder);
	const Pose3 T_new_W(Eigen::Quaterniond(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ())), Eigen::Vector3d(5, 6, 0));
	Trajectory better;
	const Trajectory own = Trajectory::loadTum(folder.file("trajectory.tum"));
	for (const StampedPose& pose : own.poses()) better.push_back({pose.t_ns, T_new_W * pose.T});
	const std::vector<RayScan> scans = landmarkRays(folder.path(), better, 1, 0.05);
	const Eigen::Vector3d p = T_new_W * Eigen::Vector3d(3, 1, 2);
	EXPECT_LT(
	    (scans[0].hits[0].end - octomap::point3d(static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()))).norm(),
	    1e-5);
}

TEST(Landmarks, GiveTheMapHeight)
{
	const ScanRoomFiles files;
	const TempFolder folder;
	writeOdometryFolder(folder);
	OctoMapRunOptions options;
	options.rawlog = files.rawlog;
	options.trajectory = files.tum;
	options.output = files.folder.file("map.bt");
	options.landmarks_dir = folder.path();
	const OctoMapRunResult result = runOctoMap(options);
	EXPECT_EQ(result.used, 42u);
	octomap::OcTree tree(0.05);
	ASSERT_TRUE(tree.readBinary(options.output));
	double highest = 0;
	for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf)
		if (tree.isNodeOccupied(*leaf)) highest = std::max(highest, leaf.getZ());
	EXPECT_GT(highest, 1.9) << "the scans are at 0.2 m";
}

/** A small reader of the PCD format of its own, after the format's definition. */
TEST(Landmarks, PcdReadByAnIndependentReader)
{
	const TempFolder folder;
	const std::vector<Landmark> landmarks{{4, {3, 1, 2}, 0.01}, {4000000000u, {-3.5, -1, 1.5}, 0.02}};
	saveLandmarks(folder.file("l.pcd"), landmarks);
	std::istringstream file(readFile(folder.file("l.pcd")));
	std::vector<std::string> fields;
	size_t points = 0;
	std::string line;
	while (std::getline(file, line) && line.rfind("DATA", 0) != 0)
	{
		std::istringstream words(line);
		std::string key, word;
		words >> key;
		if (key == "FIELDS")
			while (words >> word) fields.push_back(word);
		if (key == "POINTS") words >> points;
	}
	EXPECT_EQ(line, "DATA ascii");
	ASSERT_EQ(fields, (std::vector<std::string>{"x", "y", "z", "depth_deviation", "id"}));
	ASSERT_EQ(points, landmarks.size());
	for (const Landmark& landmark : landmarks)
	{
		double x = 0, y = 0, z = 0, deviation = 0;
		uint64_t id = 0;
		ASSERT_TRUE(file >> x >> y >> z >> deviation >> id);
		EXPECT_EQ(Eigen::Vector3d(x, y, z), landmark.p_W);
		EXPECT_EQ(id, landmark.id);
	}
}

/** What viwo-convert makes, read word by word after the format's definition. */
TEST(Landmarks, PlyReadByAnIndependentReader)
{
	const TempFolder folder;
	const std::vector<Landmark> landmarks{{4, {3, 1, 2}, 0.01}, {4000000000u, {-3.5, -1, 1.5}, 0.02}};
	saveLandmarks(folder.file("l.ply"), landmarks);
	expectDone(runProgram(VIWO_BINARY_DIR "/bin/viwo-convert", {"landmarks", "-i", folder.file("l.ply"), "-o", folder.file("m.ply")}));
	std::istringstream file(readFile(folder.file("m.ply")));
	std::vector<std::string> header;
	for (std::string line; std::getline(file, line) && line != "end_header";)
		if (line.rfind("comment ", 0) != 0) header.push_back(line);
	EXPECT_EQ(header, (std::vector<std::string>{"ply", "format ascii 1.0", "element vertex 2", "property float x", "property float y",
	                                            "property float z", "property float depth_deviation", "property uint id"}));
	for (const Landmark& landmark : landmarks)
	{
		float x = 0, y = 0, z = 0, deviation = 0;
		uint32_t id = 0;
		ASSERT_TRUE(file >> x >> y >> z >> deviation >> id);
		EXPECT_EQ(Eigen::Vector3f(x, y, z), landmark.p_W.cast<float>());
		EXPECT_FLOAT_EQ(deviation, static_cast<float>(landmark.depth_deviation));
		EXPECT_EQ(id, landmark.id);
	}
	std::string rest;
	EXPECT_FALSE(file >> rest) << rest;
}

TEST(Landmarks, PlyComesBack)
{
	const TempFolder folder;
	const std::vector<Landmark> landmarks{{4, {3, 1, 2}, 0.01}, {7, {-3.5, -1, 1.5}, 0.02}};
	saveLandmarks(folder.file("l.ply"), landmarks);
	const std::vector<Landmark> read = loadLandmarks(folder.file("l.ply"));
	ASSERT_EQ(read.size(), 2u);
	EXPECT_EQ(read[1].p_W, landmarks[1].p_W);
	EXPECT_EQ(read[1].id, 7u);
	EXPECT_EQ(read[1].depth_deviation, 0.02);
}

TEST(Landmarks, DamagedFilesAreOneLine)
{
	const TempFolder folder;
	const auto withPly = [&](const std::string& content)
	{
		writeFile(folder.file("l.ply"), content);
		loadLandmarks(folder.file("l.ply"));
	};
	expectError([&] { loadLandmarks(folder.file("absent.ply")); }, {"absent.ply"});
	expectError([&] { withPly("plyx\n"); }, {"l.ply:1", "not a PLY"});
	expectError([&] { withPly("ply\nformat binary_little_endian 1.0\n"); }, {"l.ply:2", "ASCII"});
	expectError([&] { withPly("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n"); }, {"x, y, z"});
	const std::string header =
	    "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
	expectError(
	    [&]
	    {
		    withPly(
		        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nproperty int "
		        "id\nend_header\n1 2 3 -4\n");
	    },
	    {"l.ply:9", "id"});
	expectError([&] { withPly(header + "1 2 3\n"); }, {"ends after 1 of 2"});
	expectError([&] { withPly(header + "1 2 3\n1 x 3\n"); }, {"l.ply:9"});
	writeOdometryFolder(folder);
	writeFile(folder.file("keyframes.csv"), "t_ns,x,y\n");
	const Trajectory own = Trajectory::loadTum(folder.file("trajectory.tum"));
	expectError([&] { landmarkRays(folder.path(), own, 1, 0.05); }, {"keyframes.csv:1", "'z'"});
	expectError([&] { saveLandmarks(folder.file("l.xyz"), {}); }, {"l.xyz", ".pcd"});
}
}  // namespace viwo
