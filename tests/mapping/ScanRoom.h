#pragma once

#include "TempFolder.h"

#include <viwo/core/Trajectory.h>
#include <viwo/rawlog/MrptTime.h>
#include <viwo/rawlog/RawlogWriter.h>

#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <vector>

namespace viwo::testing
{
/** An upright box on the floor, seen from above; m. */
struct FloorBox
{
	double min_x, min_y, max_x, max_y;
};

/** A robot drives through a rectangular room and records planar scans; exact trajectory. */
struct ScanRoom
{
	static constexpr int64_t kStart_ns = 1'700'000'000'000'000'000, kPeriod_ns = 100'000'000;
	static constexpr int kBeams = 361;

	FloorBox room{-4, -3, 4, 3};
	int scans = 40;
	double noise_m = 0;
	double speed_m_s = 0.3, yaw_rate_rad_s = 0.2;
	double sweep_s = 0;  //!< from the first to the last beam; the stamp is that of the first
	std::function<std::optional<FloorBox>(double t_s)> box = [](double) { return std::nullopt; };
	Pose3 T_OL = Pose3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.1, 0, 0.2));

	Pose3 T_WO(double t_s) const
	{
		const double yaw = yaw_rate_rad_s * t_s, r = yaw_rate_rad_s != 0 ? speed_m_s / yaw_rate_rad_s : 0;
		const Eigen::Vector3d p = yaw_rate_rad_s != 0 ? Eigen::Vector3d(r * std::sin(yaw), r * (1 - std::cos(yaw)) - 1, 0)
		                                              : Eigen::Vector3d(speed_m_s * t_s, -1, 0);
		return Pose3(Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ())), p);
	}

	double range_m(const Eigen::Vector2d& p, const Eigen::Vector2d& d, double t_s) const
	{
		double best = slabs(room, p, d).second;
		if (const auto b = box(t_s))
		{
			const auto [in, out] = slabs(*b, p, d);
			if (in > 0 && in < out) best = std::min(best, in);
		}
		return best;
	}

	/** X.rawlog and X.tum; poses every 20 ms, a little beyond the scans. */
	void write(const std::string& rawlog, const std::string& tum) const
	{
		std::mt19937_64 random(1);
		std::normal_distribution<double> normal;
		RawlogWriter writer(rawlog);
		for (int i = 0; i < scans; ++i)
		{
			std::vector<float> ranges;
			for (int k = 0; k < kBeams; ++k)
			{
				const double along = static_cast<double>(k) / (kBeams - 1), t_s = 0.1 * i + sweep_s * along,
				             angle = (along - 0.5) * 1.5 * M_PI;
				const Pose3 T_WL = T_WO(t_s) * T_OL;
				const Eigen::Vector3d d = T_WL.R * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0);
				ranges.push_back(static_cast<float>(range_m(T_WL.p.head<2>(), d.head<2>(), t_s) + noise_m * normal(random)));
			}
			writer.write(makeScan(kStart_ns + i * kPeriod_ns, ranges, 1.5 * M_PI, 30, T_OL, "LIDAR"));
		}
		writer.close();
		trajectory().saveTum(tum);
	}

	Trajectory trajectory() const
	{
		Trajectory trajectory;
		for (int i = 0; i < 5 * scans + 5; ++i) trajectory.push_back({kStart_ns + i * kPeriod_ns / 5, T_WO(0.02 * i)});
		return trajectory;
	}

   private:
	/** Where the ray enters and leaves the box. */
	static std::pair<double, double> slabs(const FloorBox& b, const Eigen::Vector2d& p, const Eigen::Vector2d& d)
	{
		double in = -std::numeric_limits<double>::infinity(), out = std::numeric_limits<double>::infinity();
		const double low[] = {b.min_x, b.min_y}, high[] = {b.max_x, b.max_y};
		for (int i = 0; i < 2; ++i)
		{
			if (std::abs(d[i]) < 1e-12) continue;
			const double t1 = (low[i] - p[i]) / d[i], t2 = (high[i] - p[i]) / d[i];
			in = std::max(in, std::min(t1, t2));
			out = std::min(out, std::max(t1, t2));
		}
		return {in, out};
	}
};

/** The room's files in a folder of their own, and what is made of them. */
struct ScanRoomFiles
{
	explicit ScanRoomFiles(const ScanRoom& room = {}) { room.write(rawlog, tum); }

	TempFolder folder;
	std::string rawlog = folder.file("x.rawlog"), tum = folder.file("x.tum");
};
}  // namespace viwo::testing
