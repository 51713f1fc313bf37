#include <viwo/core/Error.h>
#include <viwo/sim/LidarModel.h>
#include <viwo/sim/Mounting.h>
#include <viwo/sim/RandomSource.h>

#include <algorithm>
#include <cmath>

namespace viwo::sim
{
namespace
{
/** The pose is evaluated this often in a sweep (about every half millisecond) and interpolated: nanometres. */
constexpr int kBeamsPerPose = 10;
constexpr double kSystematicPeriod_m = 5;
}  // namespace

LidarOptions LidarOptions::perfect()
{
	LidarOptions o;
	o.noise_mm = o.systematic_error_mm = o.resolution_mm = o.beam_width_deg = o.glass_dropout = o.dark_range_m = 0;
	return o;
}

LidarModel::LidarModel(const Motion& motion, const World& world, const LidarOptions& options, uint64_t seed)
    : motion_(motion),
      world_(world),
      options_(options),
      noise_generator_(randomSource(seed, "lidar noise")),
      echo_generator_(randomSource(seed, "lidar echoes"))
{
	const Mounting mounting(options.pose, options.pose_error, "lidar");
	T_OL_ = mounting.nominal;
	T_OL_actual_ = mounting.actual;
	if (1e-3 * options.sweep_ms > 1 / options.rate_hz)
		throw Error("[lidar] sweep_ms: a sweep must not last longer than the interval of scans");
	std::mt19937_64 generator = randomSource(seed, "lidar systematic error");
	std::uniform_real_distribution<double> phase(0, 2 * M_PI);
	for (double& p : systematic_phase_rad_) p = phase(generator);
}

int64_t LidarModel::count() const
{
	const double room_s = motion_.duration_s() - 1e-3 * (options_.phase_ms + options_.sweep_ms);
	return room_s < 0 ? 0 : static_cast<int64_t>(std::floor(room_s * options_.rate_hz + 1e-9)) + 1;
}

double LidarModel::beamAngle_rad(int beam) const
{
	return options_.aperture_deg * M_PI / 180 * (static_cast<double>(beam) / (options_.beams - 1) - 0.5);
}

std::vector<Pose3> LidarModel::beamPoses(double begin_s) const
{
	const double beam_s = 1e-3 * options_.sweep_ms / (options_.beams - 1);
	std::vector<Pose3> poses;
	poses.reserve(static_cast<size_t>(options_.beams));
	Pose3 from, to = motion_.at(begin_s).T_WO * T_OL_actual_;
	for (int beam = 0; beam < options_.beams; ++beam)
	{
		const int step = beam % kBeamsPerPose;
		if (step == 0)
		{
			from = to;
			to = motion_.at(begin_s + (beam + kBeamsPerPose) * beam_s).T_WO * T_OL_actual_;
		}
		const double f = static_cast<double>(step) / kBeamsPerPose;
		poses.emplace_back(from.R.slerp(f, to.R), (1 - f) * from.p + f * to.p);
	}
	return poses;
}

LidarScan LidarModel::scan(int64_t i)
{
	const double begin_s = time_s(i);
	const std::vector<Pose3> T_WL = beamPoses(begin_s);
	std::vector<std::optional<Hit>> hits(T_WL.size());
	for (size_t beam = 0; beam < T_WL.size(); ++beam)
	{
		const double angle_rad = beamAngle_rad(static_cast<int>(beam));
		const Eigen::Vector3d direction_W = T_WL[beam].R * Eigen::Vector3d(std::cos(angle_rad), std::sin(angle_rad), 0);
		hits[beam] = world_.castRay(T_WL[beam].p, direction_W.normalized(), options_.max_range_m);
	}
	LidarScan scan;
	scan.t_ns = motion_.stamp_ns(begin_s);
	for (size_t beam = 0; beam < hits.size(); ++beam)
	{
		const double noise_m = 1e-3 * options_.noise_mm * normal_(noise_generator_);
		double range_m = echo_m(hits, beam);
		if (range_m > 0)
		{
			range_m += noise_m + systematicError_m(*hits[beam]);
			const double step_m = 1e-3 * options_.resolution_mm;
			if (step_m > 0) range_m = step_m * std::round(range_m / step_m);
		}
		scan.ranges_m.push_back(range_m > 0 && range_m <= options_.max_range_m ? static_cast<float>(range_m) : 0.0F);
	}
	return scan;
}

double LidarModel::echo_m(const std::vector<std::optional<Hit>>& hits, size_t beam)
{
	// Every beam draws the same number of times, so that one effect does not shift the draws of another.
	std::uniform_real_distribution<double> uniform;
	const double glass_draw = uniform(echo_generator_), side_draw = uniform(echo_generator_), weight = uniform(echo_generator_);
	const auto& hit = hits[beam];
	if (!hit || (hit->glass && glass_draw < options_.glass_dropout)) return 0;
	if (options_.dark_range_m > 0 && !hit->glass)
	{
		// Echo energy falls with the square of the range and with the cosine of the incidence.
		const double seen_m = options_.dark_range_m * std::sqrt(hit->reflectivity * hit->cos_incidence / 0.1);
		if (hit->distance_m > seen_m) return 0;
	}
	// An edge between this beam and a neighbour lies within the beam with the share of the spacing that half its width covers.
	const double spacing_deg = options_.aperture_deg / (options_.beams - 1);
	const double overlap = std::min(1.0, 0.5 * options_.beam_width_deg / spacing_deg);
	const bool left = side_draw < 0.5;
	const size_t neighbour = left ? beam + 1 : beam - 1;
	if (neighbour >= hits.size() || !hits[neighbour] || hits[neighbour]->surface == hit->surface) return hit->distance_m;
	const double within = left ? 2 * side_draw : 2 * side_draw - 1;
	if (within >= overlap) return hit->distance_m;
	return hit->distance_m + 0.5 * weight * (hits[neighbour]->distance_m - hit->distance_m);
}

double LidarModel::systematicError_m(const Hit& hit) const
{
	const double by_range = std::sin(2 * M_PI * hit.distance_m / kSystematicPeriod_m + systematic_phase_rad_[0]);
	const double by_incidence = std::sin(2 * std::acos(std::min(1.0, hit.cos_incidence)) + systematic_phase_rad_[1]);
	return 1e-3 * options_.systematic_error_mm * (0.6 * by_range + 0.4 * by_incidence);
}
}  // namespace viwo::sim
