#include <mrpt/core/format.h>
#include <viwo/core/AtomicFile.h>
#include <viwo/core/CsvTable.h>
#include <viwo/core/Error.h>
#include <viwo/core/MrptPose.h>
#include <viwo/core/PoseRows.h>
#include <viwo/core/Time.h>
#include <viwo/core/TimeText.h>
#include <viwo/mapping/TrajectoryFormats.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "CommitTogether.h"

namespace viwo
{
namespace
{
Trajectory loadKitti(const std::string& path, const std::string& times_path)
{
	TextRows rows(path, TextRows::Split::blanks), times(times_path, TextRows::Split::blanks);
	Trajectory trajectory;
	while (rows.next())
	{
		rows.expectWords(12, false, "the upper 3 x 4 of a pose, row by row");
		if (!times.next()) times.fail("there are more poses in " + path + " than times here");
		Eigen::Matrix3d R;
		Eigen::Vector3d p;
		for (int i = 0; i < 3; ++i)
			for (int j = 0; j < 4; ++j)
			{
				const double value = rows.number(4 * static_cast<size_t>(i) + static_cast<size_t>(j));
				if (j < 3)
					R(i, j) = value;
				else
					p[i] = value;
			}
		if ((R * R.transpose() - Eigen::Matrix3d::Identity()).norm() > 0.01 || R.col(0).cross(R.col(1)).dot(R.col(2)) < 0)
			rows.fail("the first three columns are no rotation");
		appendPose(times, {times.seconds_ns(0), Pose3(Eigen::Quaterniond(R).normalized(), p)}, trajectory);
	}
	if (times.next()) times.fail("there are fewer poses in " + path + " than times here");
	return trajectory;
}

Trajectory loadEuroc(const std::string& path)
{
	TextRows rows(path, TextRows::Split::commas_and_blanks);
	Trajectory trajectory;
	while (rows.next())
	{
		rows.expectWords(8, true, "t_ns,x,y,z,qw,qx,qy,qz");
		const int64_t t_ns = rows.integer(0);
		const Eigen::Vector3d p(rows.number(1), rows.number(2), rows.number(3));
		appendPose(rows, {t_ns, Pose3(rows.rotation(4, 5, 6, 7), p)}, trajectory);
	}
	return trajectory;
}

Trajectory loadMrpt(const std::string& path)
{
	TextRows rows(path, TextRows::Split::blanks);
	Trajectory trajectory;
	while (rows.next())
	{
		rows.expectWords(7, false, "t x y z yaw pitch roll");
		const mrpt::poses::CPose3D pose(rows.number(1), rows.number(2), rows.number(3), rows.number(4), rows.number(5), rows.number(6));
		appendPose(rows, {rows.seconds_ns(0), fromMrpt(pose)}, trajectory);
	}
	return trajectory;
}

std::map<int64_t, int64_t> loadGraphStamps(const std::string& path)
{
	CsvTable table(path, {"id", "t_ns"});
	std::map<int64_t, int64_t> stamps;
	while (table.next()) stamps[table.integer(0)] = table.integer(1);
	return stamps;
}

Trajectory loadG2o(const std::string& path, const std::string& stamps_path)
{
	TextRows rows(path, TextRows::Split::blanks);
	const std::map<int64_t, int64_t> stamps = loadGraphStamps(stamps_path);
	std::map<int64_t, Pose3> poses;
	while (rows.next())
	{
		const bool planar = rows.words()[0] == "VERTEX_SE2";
		if (!planar && rows.words()[0] != "VERTEX_SE3:QUAT") continue;
		rows.expectWords(planar ? 5 : 9, false, planar ? "VERTEX_SE2 id x y yaw" : "VERTEX_SE3:QUAT id x y z qx qy qz qw");
		const auto stamp = stamps.find(rows.integer(1));
		if (stamp == stamps.end()) rows.fail("vertex " + rows.words()[1] + " has no stamp in " + stamps_path);
		const auto at = [&](size_t word) { return rows.number(word); };
		const Pose3 T = planar ? Pose3(Eigen::Quaterniond(Eigen::AngleAxisd(at(4), Eigen::Vector3d::UnitZ())), {at(2), at(3), 0})
		                       : Pose3(rows.rotation(8, 5, 6, 7), {at(2), at(3), at(4)});
		if (!poses.emplace(stamp->second, T).second) rows.fail("two vertices have the stamp " + std::to_string(stamp->second));
	}
	Trajectory trajectory;
	for (const auto& [t_ns, T] : poses) trajectory.push_back({t_ns, T});
	return trajectory;
}

void saveKitti(const std::string& path, const Trajectory& trajectory)
{
	AtomicFile file(path), times(stampsPathOf(path, TrajectoryFormat::kitti));
	for (const StampedPose& pose : trajectory.poses())
	{
		const Eigen::Matrix3d R = pose.T.R.toRotationMatrix();
		for (int i = 0; i < 3; ++i)
			file.stream() << mrpt::format("%.12e %.12e %.12e %.12e%s", R(i, 0), R(i, 1), R(i, 2), pose.T.p[i], i < 2 ? " " : "\n");
		times.stream() << formatSeconds(pose.t_ns) << "\n";
	}
	commitTogether({&times, &file});
}

void saveEuroc(const std::string& path, const Trajectory& trajectory)
{
	AtomicFile file(path);
	file.stream() << "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z []\n";
	for (const StampedPose& pose : trajectory.poses())
	{
		const Eigen::Quaterniond& R = pose.T.R;
		const Eigen::Vector3d& p = pose.T.p;
		file.stream() << pose.t_ns
		              << mrpt::format(",%.9f,%.9f,%.9f,%.12f,%.12f,%.12f,%.12f\n", p.x(), p.y(), p.z(), R.w(), R.x(), R.y(), R.z());
	}
	file.commit();
}

void saveMrpt(const std::string& path, const Trajectory& trajectory)
{
	AtomicFile file(path);
	for (const StampedPose& pose : trajectory.poses())
	{
		const mrpt::poses::CPose3D T = toMrpt(pose.T);
		file.stream() << formatSeconds(pose.t_ns)
		              << mrpt::format(" %.9f %.9f %.9f %.12f %.12f %.12f\n", T.x(), T.y(), T.z(), T.yaw(), T.pitch(), T.roll());
	}
	file.commit();
}

void saveG2o(const std::string& path, const Trajectory& trajectory)
{
	AtomicFile file(path), stamps(stampsPathOf(path, TrajectoryFormat::g2o));
	stamps.stream() << "id,t_ns\n";
	const auto& poses = trajectory.poses();
	for (size_t i = 0; i < poses.size(); ++i)
	{
		file.stream() << "VERTEX_SE3:QUAT " << i << " " << poseRow(poses[i].T) << "\n";
		stamps.stream() << i << "," << poses[i].t_ns << "\n";
	}
	for (size_t i = 1; i < poses.size(); ++i)
	{
		file.stream() << "EDGE_SE3:QUAT " << i - 1 << " " << i << " " << poseRow(poses[i - 1].T.inverse() * poses[i].T);
		for (int r = 0; r < 6; ++r)
			for (int c = r; c < 6; ++c) file.stream() << (r == c ? " 1" : " 0");
		file.stream() << "\n";
	}
	commitTogether({&stamps, &file});
}
}  // namespace

std::optional<TrajectoryFormat> trajectoryFormat(const std::string& word)
{
	static const std::map<std::string, TrajectoryFormat> formats{{"tum", TrajectoryFormat::tum},
	                                                             {"kitti", TrajectoryFormat::kitti},
	                                                             {"euroc", TrajectoryFormat::euroc},
	                                                             {"mrpt", TrajectoryFormat::mrpt},
	                                                             {"g2o", TrajectoryFormat::g2o}};
	const auto at = formats.find(word);
	return at == formats.end() ? std::nullopt : std::optional(at->second);
}

std::optional<TrajectoryFormat> trajectoryFormatOf(const std::string& path)
{
	const std::string extension = std::filesystem::path(path).extension().string();
	if (extension == ".csv") return TrajectoryFormat::euroc;
	return trajectoryFormat(extension.empty() ? extension : extension.substr(1));
}

namespace
{
std::string besides(const std::string& path, const std::string& ending)
{
	return std::filesystem::path(path).replace_extension().string() + ending;
}
}  // namespace

std::string stampsPathOf(const std::string& path, TrajectoryFormat format)
{
	if (format == TrajectoryFormat::kitti) return besides(path, "_kitti_times.txt");
	return format == TrajectoryFormat::g2o ? besides(path, "_g2o_stamps.csv") : std::string();
}

std::string existingStampsPathOf(const std::string& path, TrajectoryFormat format)
{
	std::string ours = stampsPathOf(path, format);
	if (ours.empty() || std::filesystem::exists(ours) || !std::filesystem::exists(path)) return ours;
	std::string theirs = besides(path, format == TrajectoryFormat::kitti ? "_times.txt" : "_stamps.csv");
	if (std::filesystem::exists(theirs)) return theirs;
	throw Error(path + ": this format has no stamps, and neither " + ours + " nor " + theirs + " is there; name it with --stamps");
}

Trajectory loadTrajectory(const std::string& path, TrajectoryFormat format, const std::string& given_stamps_path)
{
	const std::string stamps_path = given_stamps_path.empty() ? existingStampsPathOf(path, format) : given_stamps_path;
	Trajectory trajectory;
	switch (format)
	{
		case TrajectoryFormat::tum:
			return Trajectory::loadTum(path);
		case TrajectoryFormat::kitti:
			trajectory = loadKitti(path, stamps_path);
			break;
		case TrajectoryFormat::euroc:
			trajectory = loadEuroc(path);
			break;
		case TrajectoryFormat::mrpt:
			trajectory = loadMrpt(path);
			break;
		case TrajectoryFormat::g2o:
			trajectory = loadG2o(path, stamps_path);
			break;
	}
	if (trajectory.empty()) throw Error(path + ": no pose in this trajectory");
	return trajectory;
}

void saveTrajectory(const std::string& path, TrajectoryFormat format, const Trajectory& trajectory)
{
	switch (format)
	{
		case TrajectoryFormat::tum:
			trajectory.saveTum(path);
			break;
		case TrajectoryFormat::kitti:
			saveKitti(path, trajectory);
			break;
		case TrajectoryFormat::euroc:
			saveEuroc(path, trajectory);
			break;
		case TrajectoryFormat::mrpt:
			saveMrpt(path, trajectory);
			break;
		case TrajectoryFormat::g2o:
			saveG2o(path, trajectory);
			break;
	}
}

Trajectory resampled(const Trajectory& trajectory, double rate_hz, double max_gap_s)
{
	Trajectory result;
	if (trajectory.empty()) return result;
	const int64_t first_ns = trajectory.poses().front().t_ns, last_ns = trajectory.poses().back().t_ns;
	const double span_s = secondsBetween(first_ns, last_ns);
	size_t next = 0;  // the pose at or behind the stamp
	for (double k = 0; k <= span_s * rate_hz + 1e-6; ++k)
	{
		const int64_t t_ns = first_ns + nanoseconds(k / rate_hz);
		while (next + 1 < trajectory.size() && trajectory.poses()[next].t_ns < t_ns) ++next;
		if (const auto T = trajectory.at(t_ns, max_gap_s))
			result.push_back({t_ns, *T});
		else  // on to the end of the gap, which may last from 1970 until now
			k = std::max(k, std::floor(secondsBetween(first_ns, trajectory.poses()[next].t_ns) * rate_hz) - 1);
	}
	return result;
}

Trajectory resampledLike(const Trajectory& trajectory, const Trajectory& other, double max_gap_s)
{
	Trajectory result;
	for (const StampedPose& pose : other.poses())
		if (const auto T = trajectory.at(pose.t_ns, max_gap_s)) result.push_back({pose.t_ns, *T});
	return result;
}

Trajectory inOtherFrame(const Trajectory& T_Wa, const Pose3& T_ab)
{
	Trajectory T_Wb;
	for (const StampedPose& pose : T_Wa.poses()) T_Wb.push_back({pose.t_ns, pose.T * T_ab});
	return T_Wb;
}
}  // namespace viwo
