#include <mrpt/img/CImage.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <viwo/core/AtomicFile.h>
#include <viwo/core/Error.h>
#include <viwo/core/TimeText.h>
#include <viwo/mapping/Landmarks.h>
#include <viwo/mapping/OctoMapRun.h>
#include <viwo/mapping/OctreeFiles.h>
#include <viwo/mapping/PoseFlags.h>
#include <viwo/rawlog/MrptTime.h>
#include <viwo/rawlog/RawlogReader.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>

#include "CommitTogether.h"
#include "ScanGraphLog.h"

namespace viwo
{
namespace
{
namespace fs = std::filesystem;

/** All files, opened before the work begins: what cannot be written is told at once. */
class MapOutputs
{
   public:
	explicit MapOutputs(const OctoMapRunOptions& o)
	{
		const OctreeFormat format = octreeFormatOf(o.output);
		if (o.colours != VoxelColours::none && (o.both || format == OctreeFormat::bt))
			throw Error(o.output + ": colours are kept in .ot files only");
		std::string ot = o.output, bt = o.output;
		if (format == OctreeFormat::ot)
			bt = fs::path(o.output).replace_extension(".bt").string();
		else
			ot = fs::path(o.output).replace_extension(".ot").string();
		if (o.both || format == OctreeFormat::ot) ot_.emplace(ot);
		if (o.both || format == OctreeFormat::bt) bt_.emplace(bt);
		if (!o.ply.empty()) ply_.emplace(o.ply);
		if (!o.scan_graph.empty()) scan_graph.emplace(o.scan_graph);
		if (!o.grid.empty() && fs::path(o.grid).extension() != ".yaml") throw Error(o.grid + ": a grid map's name ends in .yaml");
		if (!o.grid.empty()) AtomicFile probe(o.grid);
	}

	/** The binary tree last: writing it takes the log-odds off. */
	template <class Tree>
	void write(Tree& tree, const OctoMapRunOptions& o)
	{
		std::optional<OccupancyImage> grid;
		std::string no_grid;
		if (!o.grid.empty()) grid = gridOf(tree, o, no_grid);
		if (ply_) writeOccupiedPly(ply_->stream(), tree);
		if (ot_) writeOctree(ot_->stream(), tree, OctreeFormat::ot);
		if (bt_) writeOctree(bt_->stream(), tree, OctreeFormat::bt);
		std::vector<AtomicFile*> files;
		if (scan_graph) files.push_back(&scan_graph->file());
		for (std::optional<AtomicFile>* file : {&ply_, &ot_, &bt_})
			if (*file) files.push_back(&**file);
		commitTogether(files);
		if (!no_grid.empty()) throw Error(no_grid);
		if (grid) saveMapServer(o.grid, *grid);
	}

	std::optional<ScanGraphLog> scan_graph;

   private:
	/** The tree has taken long, and is kept whatever heights were asked for. */
	template <class Tree>
	static std::optional<OccupancyImage> gridOf(const Tree& tree, const OctoMapRunOptions& o, std::string& why_not)
	{
		try
		{
			return projection(tree, o.grid_slice);
		}
		catch (const Error& e)
		{
			why_not = o.grid + ": not written: " + e.what() + "; set --grid-min-z and --grid-max-z. " + o.output + " is there";
			return std::nullopt;
		}
	}

	std::optional<AtomicFile> ot_, bt_, ply_;
};

/** When the sources were recorded, for the message that no pose fits. */
struct Span
{
	int64_t first_ns = std::numeric_limits<int64_t>::max(), last_ns = std::numeric_limits<int64_t>::min();

	void take(int64_t t_ns)
	{
		first_ns = std::min(first_ns, t_ns);
		last_ns = std::max(last_ns, t_ns);
	}
};

[[noreturn]] void failWithoutScans(const OctoMapRunOptions& o, const OctoMapRunResult& result, const Span& span,
                                   const Trajectory& trajectory, const RawlogCounts& counts)
{
	if (result.flagged > 0)
		throw Error(o.flags + ": all " + std::to_string(result.flagged) + " observations have poses that are flagged as bad");
	if (result.no_pose > 0)
		throw Error(o.trajectory + ": no pose at the time of any observation; the trajectory is of " +
		            formatSeconds(trajectory.poses().front().t_ns) + " to " + formatSeconds(trajectory.poses().back().t_ns) +
		            " s, the observations of " + formatSeconds(span.first_ns) + " to " + formatSeconds(span.last_ns) + " s");
	if (result.no_time > 0)
		throw Error(o.rawlog + ": none of the " + std::to_string(result.no_time) +
		            " observations has a stamp that fits the others; record them with their times");
	if (result.empty > 0) throw Error(o.rawlog + ": none of the " + std::to_string(result.empty) + " observations has a return");
	throw Error(o.rawlog + ": nothing to map: there are no planar scans, depth images or point clouds among the sources; it holds " +
	            counts.describe());
}

/** External files of depth images and clouds are looked for where MRPT's own programs look. */
void findExternalFiles(const std::string& rawlog)
{
	for (fs::path base(rawlog); base.extension() == ".gz" || base.extension() == ".rawlog";)
	{
		const std::string folder = base.replace_extension().string() + "_Images";
		if (fs::is_directory(folder)) return mrpt::img::CImage::setImagesPathBase(folder);
	}
}

template <class Tree>
class MapBuild
{
   public:
	MapBuild(const OctoMapRunOptions& options, const OctoMapRunHooks& hooks)
	    : options_(options),
	      hooks_(hooks),
	      outputs_(options),
	      trajectory_(Trajectory::loadTum(options.trajectory)),
	      builder_(options.resolution_m, options.model, options.casting, options.threads)
	{
		if (!options.flags.empty()) flags_ = PoseFlags::load(options.flags, trajectory_, options.bad_flags);
	}

	OctoMapRunResult run()
	{
		insertRawlog();
		if (!options_.landmarks_dir.empty())
			for (RayScan& scan :
			     landmarkRays(options_.landmarks_dir, trajectory_, options_.rays.max_gap_s, options_.max_landmark_deviation))
				insert(std::move(scan));
		if (result_.used == 0) failWithoutScans(options_, result_, span_, trajectory_, counts_);
		builder_.finish();
		result_.unusable_rays = builder_.unusableRays();
		colour(builder_.tree());
		for (auto leaf = builder_.tree().begin_leafs(), end = builder_.tree().end_leafs(); leaf != end; ++leaf)
			++(builder_.tree().isNodeOccupied(*leaf) ? result_.occupied : result_.free);
		if (result_.occupied + result_.free == 0)
			throw Error(options_.rawlog + ": no ray could be used: all are beyond the octree; use a coarser --resolution");
		if (!options_.grid.empty()) countScansOffGrid();
		progress(0.99, "writing");
		outputs_.write(builder_.tree(), options_);
		return result_;
	}

   private:
	void insertRawlog()
	{
		RawlogReaderOptions reading;
		reading.allow_truncated = options_.allow_truncated;
		reading.skip_missing_images = true;
		findExternalFiles(options_.rawlog);
		RawlogReader reader(options_.rawlog, reading);
		const ObservationRays rays(trajectory_, options_.rays);
		while (const auto observation = reader.next())
		{
			progress(0.98 * reader.progress(), std::to_string(result_.used) + " observations");
			if (!rays.isSource(*observation)) continue;
			const int64_t t_ns = nanosecondsOf(observation->timestamp);
			span_.take(t_ns);
			if (flags_.isBad(t_ns, trajectory_))
			{
				++result_.flagged;
				continue;
			}
			RayScan scan;
			switch (rays.convert(observation, scan))
			{
				case ObservationRays::Outcome::used:
					if (dynamic_cast<const mrpt::obs::CObservation2DRangeScan*>(observation.get()) && !scan.hits.empty())
						++planar_scans_at_[std::floor(scan.hits.front().origin.z() / kHeightStep_m)];
					insert(std::move(scan));
					break;
				case ObservationRays::Outcome::no_pose:
					++result_.no_pose;
					break;
				case ObservationRays::Outcome::empty:
					++result_.empty;
					break;
				case ObservationRays::Outcome::not_a_source:
					break;
			}
		}
		counts_ = reader.counts();
		for (const auto& [sensor, counts] : counts_.sensors)
			if (rays.isSourceClass(sensor.second)) result_.no_time += counts.unstamped + counts.late + counts.stamp_jumps;
	}

	void countScansOffGrid()
	{
		const auto shown = heightsShown(builder_.tree(), options_.grid_slice);
		for (const auto& [step, scans] : planar_scans_at_)
			if (!shown((step + 0.5) * kHeightStep_m)) result_.scans_off_grid += scans;
	}

	void insert(RayScan scan)
	{
		++result_.used;
		result_.rays += scan.hits.size() + scan.clearing.size();
		if (outputs_.scan_graph) outputs_.scan_graph->add(scan);
		builder_.add(std::move(scan));
	}

	void progress(double fraction, const std::string& note)
	{
		if (hooks_.interrupted && hooks_.interrupted()) throw Error("interrupted; nothing was written");
		if (hooks_.progress) hooks_.progress(fraction, note);
	}

	void colour(octomap::OcTree&) {}
	void colour(octomap::ColorOcTree& tree)
	{
		if (options_.colours == VoxelColours::height) colourByHeight(tree);
	}

	static constexpr double kHeightStep_m = 0.01;

	const OctoMapRunOptions& options_;
	const OctoMapRunHooks& hooks_;
	MapOutputs outputs_;
	const Trajectory trajectory_;
	PoseFlags flags_;
	OctreeBuilder<Tree> builder_;
	OctoMapRunResult result_;
	std::map<double, size_t> planar_scans_at_;  //!< height of the sensor, in steps
	RawlogCounts counts_;
	Span span_;
};
}  // namespace

OctoMapRunResult runOctoMap(const OctoMapRunOptions& given, const OctoMapRunHooks& hooks)
{
	const auto start = std::chrono::steady_clock::now();
	OctoMapRunOptions options = given;
	options.rays.colours = options.colours == VoxelColours::sensor;
	OctoMapRunResult result = options.colours == VoxelColours::none ? MapBuild<octomap::OcTree>(options, hooks).run()
	                                                                : MapBuild<octomap::ColorOcTree>(options, hooks).run();
	result.wall_time_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
	return result;
}
}  // namespace viwo
