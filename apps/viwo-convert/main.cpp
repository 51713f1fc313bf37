#include <viwo/app/Program.h>
#include <viwo/core/Scalars.h>
#include <viwo/mapping/Landmarks.h>
#include <viwo/mapping/RawlogWithPoses.h>
#include <viwo/mapping/TrajectoryFormats.h>
#include <viwo/rawlog/ObservationAdapter.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

using namespace viwo;

namespace
{
const std::vector<std::string> kFormats{"tum", "kitti", "euroc", "mrpt", "g2o"}, kFrames{"O", "B", "C"};

struct Arguments
{
	std::string input, output, trajectory;
	std::string from, to, stamps;
	std::string from_frame = "O", to_frame, rawlog;
	AdapterOptions labels;
	double rate_hz = 0, max_gap_s = 1;
	std::string like;
	std::string key_frames, pose_label = "POSE";
	std::vector<std::string> map_labels;
	double distance_m = 0.5, angle_deg = 20, max_offset_s = 0.1;
	bool allow_truncated = false;
};

void declareTrajectory(CLI::App& cli, Arguments& a)
{
	CLI::App& c = *cli.add_subcommand("trajectory", "A trajectory in another format, frame or rate");
	c.add_option("-i,--input", a.input, "Trajectory")->type_name("FILE.tum|.kitti|.csv|.mrpt|.g2o")->required();
	c.add_option("-o,--output", a.output, "Trajectory; its stamps go to X_kitti_times.txt (kitti) or X_g2o_stamps.csv (g2o)")
	    ->type_name("FILE.tum|.kitti|.csv|.mrpt|.g2o")
	    ->required();
	c.add_option("--from", a.from, "Format of the input; by default by its extension (.tum .kitti .csv .mrpt .g2o)")
	    ->check(CLI::IsMember(kFormats));
	c.add_option("--to", a.to, "Format of the output")->check(CLI::IsMember(kFormats));
	c.add_option("--stamps", a.stamps,
	             "Stamps of an input without any; by default those beside it: X_kitti_times.txt or X_times.txt (kitti), "
	             "X_g2o_stamps.csv or X_stamps.csv (g2o)")
	    ->type_name("FILE");
	c.add_option("--from-frame", a.from_frame, "What the input is the pose of: O vehicle, B IMU, C camera")
	    ->check(CLI::IsMember(kFrames))
	    ->capture_default_str();
	c.add_option("--to-frame", a.to_frame, "What the output is to be the pose of; needs --rawlog")->check(CLI::IsMember(kFrames));
	c.add_option("--rawlog", a.rawlog, "Where the poses of IMU and camera on the vehicle are read")->type_name("FILE.rawlog");
	c.add_option("--cam-label", a.labels.cam_label, "Sensor label of the camera")->capture_default_str();
	c.add_option("--imu-label", a.labels.imu_label, "Sensor label of the IMU")->capture_default_str();
	auto* rate = c.add_option("--rate", a.rate_hz, "Poses a second, interpolated, Hz")->check(app::between(0.001, 10000));
	c.add_option("--like", a.like, "Poses at the stamps of this trajectory (TUM), interpolated")->type_name("FILE.tum")->excludes(rate);
	c.add_option("--max-gap", a.max_gap_s, "Longest gap to interpolate across, s")->check(app::positive())->capture_default_str();
}

void declareOthers(CLI::App& cli, Arguments& a)
{
	CLI::App& landmarks = *cli.add_subcommand("landmarks", "Landmarks of viwo-odometry as .ply or .pcd");
	landmarks.add_option("-i,--input", a.input, "Landmarks (.ply)")->type_name("FILE.ply")->required();
	landmarks.add_option("-o,--output", a.output, "Landmarks (.ply or .pcd)")->type_name("FILE.ply|.pcd")->required();

	CLI::App& rawlog = *cli.add_subcommand("rawlog", "A rawlog with a trajectory put in as CObservationRobotPose");
	rawlog.add_option("-i,--input", a.input, "Rawlog")->type_name("FILE.rawlog")->required();
	rawlog.add_option("-t,--trajectory", a.trajectory, "Trajectory of the vehicle (TUM)")->type_name("FILE.tum")->required();
	rawlog.add_option("-o,--output", a.output, "Rawlog")->type_name("FILE.rawlog")->required();
	rawlog.add_option("--label", a.pose_label, "Sensor label of the poses")->check(app::notEmpty())->capture_default_str();
	rawlog.add_flag("--allow-truncated", a.allow_truncated, "Take a truncated rawlog as far as it goes");

	CLI::App& map = *cli.add_subcommand("simplemap", "Key frames with their observations as MRPT's CSimpleMap");
	map.add_option("-i,--input", a.input, "Rawlog")->type_name("FILE.rawlog")->required();
	map.add_option("-t,--trajectory", a.trajectory, "Trajectory of the vehicle (TUM)")->type_name("FILE.tum")->required();
	map.add_option("-o,--output", a.output, "CSimpleMap (.simplemap)")->type_name("FILE.simplemap")->required();
	auto* key_frames = map.add_option("--keyframes", a.key_frames, "keyframes.csv of viwo-odometry; without it, key frames by the way")
	                       ->type_name("FILE.csv");
	map.add_option("--distance", a.distance_m, "A key frame after this way, m")
	    ->excludes(key_frames)
	    ->check(app::positive())
	    ->capture_default_str();
	map.add_option("--angle", a.angle_deg, "Or after this turn, deg")->excludes(key_frames)->check(app::positive())->capture_default_str();
	map.add_flag("--allow-truncated", a.allow_truncated, "Take a truncated rawlog as far as it goes");
	map.add_option("--labels", a.map_labels, "Sensor labels to keep; by default all images, scans and clouds")->delimiter(',');
	map.add_option("--max-offset", a.max_offset_s, "Longest time from a key frame to its observations, s")
	    ->check(app::positive())
	    ->capture_default_str();
}

TrajectoryFormat formatOf(const std::string& word, const std::string& path, const char* option)
{
	const auto format = word.empty() ? trajectoryFormatOf(path) : trajectoryFormat(word);
	if (!format) throw app::UsageError(path + ": the name tells no format (.tum .kitti .csv .mrpt .g2o); give it with " + option);
	return *format;
}

/** T_OX of one of O, B, C. */
Pose3 mounting(const std::string& frame, const Calibration& calibration)
{
	return frame == "B" ? calibration.T_OB : frame == "C" ? calibration.T_OC : Pose3();
}

/** Stamps go in and out beside the files that the arguments name. */
void requireDifferentFiles(std::vector<std::string> inputs, std::vector<std::string> outputs)
{
	for (std::vector<std::string>* files : {&inputs, &outputs}) files->erase(std::remove(files->begin(), files->end(), ""), files->end());
	app::requireInputsAreKept(inputs, outputs);
}

void requireExtension(const std::string& path, const std::string& extension)
{
	std::filesystem::path name(path);
	if (name.extension() == ".gz") name.replace_extension();
	if (name.extension() != extension) throw app::UsageError(path + ": the name must end in " + extension + " or " + extension + ".gz");
}

int convertTrajectory(const Arguments& a)
{
	const TrajectoryFormat from = formatOf(a.from, a.input, "--from"), to = formatOf(a.to, a.output, "--to");
	const std::string to_frame = a.to_frame.empty() ? a.from_frame : a.to_frame;
	if (to_frame != a.from_frame && a.rawlog.empty())
		throw app::UsageError("--to-frame needs --rawlog, which has the poses of the sensors on the vehicle");
	const std::string stamps = a.stamps.empty() ? existingStampsPathOf(a.input, from) : a.stamps, new_stamps = stampsPathOf(a.output, to);
	requireDifferentFiles({a.input, stamps, a.like, a.rawlog}, {a.output, new_stamps});
	Trajectory trajectory = loadTrajectory(a.input, from, stamps);
	if (to_frame != a.from_frame)
	{
		const auto uses = [&](const char* frame) { return a.from_frame == frame || to_frame == frame; };
		const Calibration calibration = readCalibration(a.rawlog, a.labels, uses("C"), uses("B"), true);
		trajectory = inOtherFrame(trajectory, mounting(a.from_frame, calibration).inverse() * mounting(to_frame, calibration));
	}
	if (a.rate_hz > 0) trajectory = resampled(trajectory, a.rate_hz, a.max_gap_s);
	if (!a.like.empty()) trajectory = resampledLike(trajectory, Trajectory::loadTum(a.like), a.max_gap_s);
	if (trajectory.empty()) throw Error(a.input + ": no pose at the stamps of " + a.like);
	saveTrajectory(a.output, to, trajectory);
	std::printf("%s: %zu poses, %.2f m%s\n", a.output.c_str(), trajectory.size(), trajectory.length_m(),
	            new_stamps.empty() ? "" : ("; stamps in " + new_stamps).c_str());
	return 0;
}

int convertLandmarks(const Arguments& a)
{
	const std::vector<Landmark> landmarks = loadLandmarks(a.input);
	saveLandmarks(a.output, landmarks);
	std::printf("%s: %zu landmarks\n", a.output.c_str(), landmarks.size());
	return 0;
}

int convertRawlog(const Arguments& a)
{
	requireExtension(a.output, ".rawlog");
	const Trajectory trajectory = Trajectory::loadTum(a.trajectory);
	app::ProgressBar bar;
	RawlogWithPosesOptions options;
	options.input = a.input;
	options.output = a.output;
	options.label = a.pose_label;
	options.allow_truncated = a.allow_truncated;
	options.progress = [&](double fraction) { bar.update(fraction); };
	options.interrupted = [] { return app::interrupted(); };
	const RawlogWithPosesResult result = writeRawlogWithPoses(options, trajectory);
	bar.clear();
	std::printf("%s: %zu observations and %zu poses%s\n", a.output.c_str(), result.observations, result.poses,
	            result.images_folder.empty() ? "" : ("; their files in " + result.images_folder).c_str());
	if (result.left_out > 0)
		app::tellNotes(
		    {std::to_string(result.left_out) + " observations left out: they have no stamp, or one that does not fit the others"});
	return 0;
}

int convertToSimpleMap(const Arguments& a)
{
	requireExtension(a.output, ".simplemap");
	const Trajectory trajectory = Trajectory::loadTum(a.trajectory);
	KeyFrameMapOptions options;
	options.rawlog = a.input;
	options.output = a.output;
	options.labels = a.map_labels;
	options.max_offset_s = a.max_offset_s;
	options.max_gap_s = a.max_gap_s;
	options.allow_truncated = a.allow_truncated;
	if (a.key_frames.empty())
		options.key_frames_ns = keyFramesAlong(trajectory, a.distance_m, a.angle_deg * kDegree);
	else
		for (const KeyFramePose& frame : loadKeyFrames(a.key_frames)) options.key_frames_ns.push_back(frame.t_ns);
	std::sort(options.key_frames_ns.begin(), options.key_frames_ns.end());
	std::printf("%s: %zu key frames\n", a.output.c_str(), writeKeyFrameMap(options, trajectory));
	return 0;
}
}  // namespace

int main(int argc, char** argv)
{
	CLI::App cli{"Trajectories, landmarks and key frames in other formats and frames", "viwo-convert"};
	Arguments arguments;
	cli.require_subcommand(1);
	cli.fallthrough();
	declareTrajectory(cli, arguments);
	declareOthers(cli, arguments);
	cli.footer(
	    "Examples:\n"
	    "  viwo-convert trajectory -i out/trajectory.tum -o out/trajectory.kitti\n"
	    "  viwo-convert trajectory -i out/trajectory.tum -o camera.csv --to-frame C --rawlog run.rawlog --rate 20\n"
	    "  viwo-convert landmarks -i out/landmarks.ply -o landmarks.pcd\n"
	    "  viwo-convert rawlog -i run.rawlog -t truth/trajectory.tum -o run_with_poses.rawlog\n"
	    "  viwo-convert simplemap -i run.rawlog -t out/trajectory.tum --keyframes out/keyframes.csv -o run.simplemap\n"
	    "Exit status: 0 done, 1 failed, 2 bad usage.");
	return app::run(cli, argc, argv,
	                [&]
	                {
		                if (cli.got_subcommand("trajectory")) return convertTrajectory(arguments);
		                if (cli.got_subcommand("landmarks")) return convertLandmarks(arguments);
		                if (cli.got_subcommand("rawlog")) return convertRawlog(arguments);
		                return convertToSimpleMap(arguments);
	                });
}
