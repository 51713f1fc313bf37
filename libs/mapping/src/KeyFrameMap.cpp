#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationVelodyneScan.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <viwo/core/Error.h>
#include <viwo/core/MrptPose.h>
#include <viwo/core/Time.h>
#include <viwo/mapping/RawlogWithPoses.h>
#include <viwo/rawlog/MrptTime.h>
#include <viwo/rawlog/ObjectFile.h>
#include <viwo/rawlog/RawlogReader.h>

#include <algorithm>
#include <cstdlib>
#include <map>

namespace viwo
{
namespace
{
using namespace mrpt::obs;

bool showsPlaces(const CObservation& o)
{
	return dynamic_cast<const CObservationImage*>(&o) || dynamic_cast<const CObservation2DRangeScan*>(&o) ||
	       dynamic_cast<const CObservation3DRangeScan*>(&o) || dynamic_cast<const CObservationPointCloud*>(&o) ||
	       dynamic_cast<const CObservationVelodyneScan*>(&o);
}

/** The nearest stamp of a rising list that is not empty. */
int64_t nearest(const std::vector<int64_t>& stamps, int64_t t_ns)
{
	const auto after = std::lower_bound(stamps.begin(), stamps.end(), t_ns);
	if (after == stamps.begin()) return stamps.front();
	if (after == stamps.end()) return stamps.back();
	return *after - t_ns < t_ns - *(after - 1) ? *after : *(after - 1);
}

using KeyFrames = std::map<int64_t, std::map<std::string, CObservation::Ptr>>;

KeyFrames gather(const KeyFrameMapOptions& options)
{
	RawlogReaderOptions reading;
	reading.labels = options.labels;
	reading.allow_truncated = options.allow_truncated;
	RawlogReader reader(options.rawlog, reading);
	KeyFrames frames;
	while (const auto observation = reader.next())
	{
		if (!showsPlaces(*observation)) continue;
		const int64_t t_ns = nanosecondsOf(observation->timestamp), key_ns = nearest(options.key_frames_ns, t_ns);
		const auto offset_ns = [&](int64_t stamp_ns) { return std::abs(stamp_ns - key_ns); };
		if (static_cast<double>(offset_ns(t_ns)) > options.max_offset_s * kNanosecondsPerSecond) continue;
		CObservation::Ptr& best = frames[key_ns][observation->sensorLabel];
		if (!best || offset_ns(t_ns) < offset_ns(nanosecondsOf(best->timestamp))) best = observation;
	}
	return frames;
}
}  // namespace

size_t writeKeyFrameMap(const KeyFrameMapOptions& options, const Trajectory& trajectory)
{
	if (options.key_frames_ns.empty()) throw Error(options.rawlog + ": no key frame was given");
	mrpt::maps::CSimpleMap map;
	for (const auto& [key_ns, observations] : gather(options))
	{
		const std::optional<Pose3> T_WO = trajectory.at(key_ns, options.max_gap_s);
		if (!T_WO) continue;
		auto frame = CSensoryFrame::Create();
		for (const auto& [label, observation] : observations) frame->insert(observation);
		map.insert(mrpt::poses::CPose3DPDFGaussian::Create(toMrpt(*T_WO)), frame);
	}
	if (map.empty())
		throw Error(options.rawlog + ": no key frame has both a pose and an observation; do trajectory and rawlog belong together?");
	saveObject(options.output, map);
	return map.size();
}

std::vector<int64_t> keyFramesAlong(const Trajectory& trajectory, double distance_m, double angle_rad)
{
	std::vector<int64_t> stamps;
	const StampedPose* last = nullptr;
	for (const StampedPose& pose : trajectory.poses())
	{
		if (last && (pose.T.p - last->T.p).norm() < distance_m && last->T.R.angularDistance(pose.T.R) < angle_rad) continue;
		stamps.push_back(pose.t_ns);
		last = &pose;
	}
	return stamps;
}
}  // namespace viwo
