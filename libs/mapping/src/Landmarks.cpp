#include <mrpt/core/format.h>
#include <viwo/core/AtomicFile.h>
#include <viwo/core/CsvTable.h>
#include <viwo/core/Error.h>
#include <viwo/mapping/Landmarks.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

namespace viwo
{
namespace
{
/** What an ASCII PLY's header says. */
struct PlyHeader
{
	size_t vertices = 0;
	std::vector<std::string> properties;
};

[[noreturn]] void failAt(const std::string& path, int line, const std::string& what)
{
	throw Error(path + ":" + std::to_string(line) + ": " + what);
}

PlyHeader readHeader(std::ifstream& file, const std::string& path, int& line_number)
{
	PlyHeader header;
	std::string line, element;
	for (bool first = true; std::getline(file, line); first = false)
	{
		++line_number;
		std::istringstream words(line);
		std::string word, type, name;
		words >> word >> type >> name;
		if (first && word != "ply") failAt(path, line_number, "not a PLY file");
		if (word == "format" && type != "ascii") failAt(path, line_number, "only ASCII PLY is read here");
		if (word == "element") element = type;
		if (word == "element" && type == "vertex") header.vertices = static_cast<size_t>(std::strtoull(name.c_str(), nullptr, 10));
		if (word == "property" && element == "vertex") header.properties.push_back(name);
		if (word == "end_header") return header;
	}
	failAt(path, line_number, "the header has no end");
}

size_t columnOf(const PlyHeader& header, const std::string& name)
{
	return static_cast<size_t>(std::find(header.properties.begin(), header.properties.end(), name) - header.properties.begin());
}
}  // namespace

std::vector<Landmark> loadLandmarks(const std::string& ply_path)
{
	std::ifstream file(ply_path);
	if (!file) throw Error(ply_path + ": cannot read these landmarks; check the name");
	int line_number = 0;
	const PlyHeader header = readHeader(file, ply_path, line_number);
	const size_t n = header.properties.size(), x = columnOf(header, "x"), y = columnOf(header, "y"), z = columnOf(header, "z");
	const size_t id = columnOf(header, "id"), deviation = columnOf(header, "depth_deviation");
	if (x == n || y == n || z == n) throw Error(ply_path + ": its vertices have no x, y, z");
	std::vector<Landmark> landmarks;
	std::string line;
	while (landmarks.size() < header.vertices && std::getline(file, line))
	{
		++line_number;
		std::istringstream words(line);
		std::vector<double> values(n);
		for (double& value : values)
			if (!(words >> value)) failAt(ply_path, line_number, "not " + std::to_string(n) + " numbers");
		if (id < n && !(values[id] >= 0 && values[id] < 1e15)) failAt(ply_path, line_number, "the id is no whole number from 0 on");
		landmarks.push_back({id < n ? static_cast<uint64_t>(values[id]) : 0, Eigen::Vector3d(values[x], values[y], values[z]),
		                     deviation < n ? values[deviation] : 0});
	}
	if (landmarks.size() < header.vertices)
		throw Error(ply_path + ": ends after " + std::to_string(landmarks.size()) + " of " + std::to_string(header.vertices) + " points");
	return landmarks;
}

void saveLandmarks(const std::string& path, const std::vector<Landmark>& landmarks)
{
	const std::string extension = std::filesystem::path(path).extension().string(), count = std::to_string(landmarks.size());
	if (extension != ".ply" && extension != ".pcd") throw Error(path + ": a file of landmarks ends in .ply or .pcd");
	AtomicFile file(path);
	if (extension == ".ply")
		file.stream()
		    << "ply\nformat ascii 1.0\ncomment landmarks in W, m\nelement vertex " << count
		    << "\nproperty float x\nproperty float y\nproperty float z\nproperty float depth_deviation\nproperty uint id\nend_header\n";
	else
		file.stream()
		    << "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z depth_deviation id\nSIZE 4 4 4 4 4\nTYPE F F F F U\n"
		    << "COUNT 1 1 1 1 1\nWIDTH " << count << "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " << count << "\nDATA ascii\n";
	for (const Landmark& l : landmarks)
		file.stream() << mrpt::format("%.4f %.4f %.4f %.4f ", l.p_W.x(), l.p_W.y(), l.p_W.z(), l.depth_deviation) << l.id << "\n";
	file.commit();
}

std::vector<KeyFramePose> loadKeyFrames(const std::string& csv_path)
{
	CsvTable table(csv_path, {"t_ns", "x", "y", "z", "qx", "qy", "qz", "qw"});
	std::vector<KeyFramePose> frames;
	while (table.next())
	{
		const Eigen::Vector3d p(table.number(1), table.number(2), table.number(3));
		frames.push_back({table.integer(0), Pose3(table.rotation(7, 4, 5, 6), p)});
	}
	return frames;
}

std::vector<RayScan> landmarkRays(const std::string& dir, const Trajectory& trajectory, double max_gap_s, double max_deviation)
{
	std::map<uint64_t, Landmark> landmarks;
	for (const Landmark& landmark : loadLandmarks(dir + "/landmarks.ply"))
		if (landmark.depth_deviation <= max_deviation) landmarks[landmark.id] = landmark;
	std::map<int64_t, std::vector<uint64_t>> seen_at;
	std::map<uint64_t, int64_t> last_seen;  // the key frame that a landmark moves along with
	CsvTable observations(dir + "/landmark_observations.csv", {"landmark_id", "t_ns"});
	while (observations.next())
	{
		const auto id = static_cast<uint64_t>(observations.integer(0));
		seen_at[observations.integer(1)].push_back(id);
		last_seen[id] = std::max(last_seen[id], observations.integer(1));
	}
	const Trajectory own = Trajectory::loadTum(dir + "/trajectory.tum");
	std::map<int64_t, Pose3> T_new_old, T_WC;
	for (const KeyFramePose& frame : loadKeyFrames(dir + "/keyframes.csv"))
	{
		const auto before = own.at(frame.t_ns, max_gap_s), after = trajectory.at(frame.t_ns, max_gap_s);
		if (!before || !after) continue;
		T_new_old[frame.t_ns] = *after * before->inverse();
		T_WC[frame.t_ns] = T_new_old[frame.t_ns] * frame.T_WC;
	}
	const auto toOctomap = [](const Eigen::Vector3d& p)
	{ return octomap::point3d(static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())); };
	std::vector<RayScan> scans;
	for (const auto& [t_ns, pose] : T_WC)
	{
		RayScan scan;
		for (const uint64_t id : seen_at[t_ns])
		{
			const auto landmark = landmarks.find(id);
			if (landmark == landmarks.end()) continue;
			const auto moved = T_new_old.find(last_seen[id]);
			if (moved == T_new_old.end()) continue;
			const Eigen::Vector3d p = moved->second.R * landmark->second.p_W + moved->second.p;
			scan.hits.push_back({toOctomap(pose.p), toOctomap(p)});
		}
		if (!scan.hits.empty()) scans.push_back(std::move(scan));
	}
	return scans;
}
}  // namespace viwo
