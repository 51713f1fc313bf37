#include <viwo/core/Error.h>
#include <viwo/core/TimeText.h>
#include <viwo/mapping/ObservationRays.h>
#include <viwo/rawlog/MrptTime.h>

#include <algorithm>
#include <exception>
#include <sstream>

#include "SensorReturns.h"

namespace viwo
{
namespace
{
using namespace mrpt::obs;

octomap::point3d toOctomap(const Eigen::Vector3d& p)
{
	return octomap::point3d(static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()));
}

/** Where the sensor was, beam by beam. */
class SensorPath
{
   public:
	SensorPath(const Trajectory& trajectory, double max_gap_s, const Pose3& T_WO_stamp, const Pose3& T_OS)
	    : trajectory_(trajectory), max_gap_s_(max_gap_s), T_OS_(T_OS), T_WS_stamp_(T_WO_stamp * T_OS)
	{
	}

	const Pose3& atStamp() const { return T_WS_stamp_; }

	/** The pose at the stamp where the trajectory does not reach so far. */
	const Pose3& at(int64_t t_ns)
	{
		if (t_ns == last_t_ns_) return T_WS_;
		last_t_ns_ = t_ns;
		const std::optional<Pose3> T_WO = trajectory_.at(t_ns, max_gap_s_);
		T_WS_ = T_WO ? *T_WO * T_OS_ : T_WS_stamp_;
		return T_WS_;
	}

   private:
	const Trajectory& trajectory_;
	double max_gap_s_;
	Pose3 T_OS_, T_WS_stamp_, T_WS_;
	int64_t last_t_ns_ = std::numeric_limits<int64_t>::min();
};

std::vector<bool> groundOf(const SensorReturns& returns, const GroundFilter& filter)
{
	std::vector<Eigen::Vector3d> points_O;
	points_O.reserve(returns.points_S.size());
	for (const Eigen::Vector3d& p_S : returns.points_S) points_O.push_back(returns.T_OS.R * p_S + returns.T_OS.p);
	return filter.onGround(points_O);
}

void place(const SensorReturns& returns, SensorPath& path, const RayOptions& options, const std::vector<bool>& ground, RayScan& rays)
{
	for (size_t i = 0; i < returns.points_S.size(); ++i)
	{
		const Pose3& T_WS = returns.t_ns.empty() ? path.atStamp() : path.at(returns.t_ns[i]);
		const Eigen::Vector3d p_W = T_WS.R * returns.points_S[i] + T_WS.p;
		if (p_W.z() < options.min_z_m || p_W.z() > options.max_z_m) continue;
		const Ray ray{toOctomap(T_WS.p), toOctomap(p_W)};
		if (!ground.empty() && ground[i])
		{
			rays.clearing.push_back(ray);
			continue;
		}
		rays.hits.push_back(ray);
		if (!returns.colours.empty()) rays.colours.push_back(returns.colours[i]);
	}
}

/** What MRPT's exceptions say before their backtrace: under "Message:", or, where that is empty, under "Location:". */
std::string messageOf(const std::exception& e)
{
	std::istringstream text(e.what());
	std::string message;
	for (std::string line; std::getline(text, line);)
		for (const std::string key : {"Message:", "Location:"})
			if (line.rfind(key, 0) == 0 && message.empty())
				message = line.substr(std::min(line.size(), line.find_first_not_of(' ', key.size())));
	return message.empty() ? std::string(e.what()).substr(0, std::string(e.what()).find('\n')) : message;
}

SensorReturns returnsOfAny(const CObservation::Ptr& observation, const RayOptions& options)
{
	if (const auto scan = std::dynamic_pointer_cast<CObservation2DRangeScan>(observation)) return returnsOf(*scan, options);
	if (const auto image = std::dynamic_pointer_cast<CObservation3DRangeScan>(observation)) return returnsOf(*image, options);
	if (const auto cloud = std::dynamic_pointer_cast<CObservationPointCloud>(observation)) return returnsOf(*cloud, options);
	return returnsOf(dynamic_cast<CObservationVelodyneScan&>(*observation), options);
}
}  // namespace

ObservationRays::ObservationRays(const Trajectory& trajectory, const RayOptions& options) : trajectory_(trajectory), options_(options) {}

bool ObservationRays::isSource(const CObservation& observation) const
{
	const std::string name = observation.GetRuntimeClass()->className;
	return isSourceClass(name.substr(name.rfind(':') + 1));
}

bool ObservationRays::isSourceClass(const std::string& name) const
{
	return (options_.scans && name == "CObservation2DRangeScan") || (options_.depth && name == "CObservation3DRangeScan") ||
	       (options_.clouds && (name == "CObservationPointCloud" || name == "CObservationVelodyneScan"));
}

ObservationRays::Outcome ObservationRays::convert(const CObservation::Ptr& observation, RayScan& rays) const
{
	if (!isSource(*observation)) return Outcome::not_a_source;
	const int64_t t_ns = nanosecondsOf(observation->timestamp);
	const std::optional<Pose3> T_WO = trajectory_.at(t_ns, options_.max_gap_s);
	if (!T_WO) return Outcome::no_pose;
	SensorReturns returns;
	try
	{
		returns = returnsOfAny(observation, options_);
	}
	catch (const std::exception& e)
	{
		throw Error("the observation '" + observation->sensorLabel + "' at " + formatSeconds(t_ns) + " s cannot be used (" + messageOf(e) +
		            "); if its data are in a file of their own, copy that into the rawlog's _Images folder");
	}
	SensorPath path(trajectory_, options_.max_gap_s, *T_WO, returns.T_OS);
	const bool is_planar = dynamic_cast<const CObservation2DRangeScan*>(observation.get()) != nullptr;
	const std::vector<bool> ground = options_.ground && !is_planar ? groundOf(returns, *options_.ground) : std::vector<bool>();
	place(returns, path, options_, ground, rays);
	return rays.hits.empty() && rays.clearing.empty() ? Outcome::empty : Outcome::used;
}
}  // namespace viwo
