#pragma once

#include <viwo/groundtruth/Pose2.h>
#include <viwo/rawlog/MrptTime.h>
#include <viwo/rawlog/RawlogWriter.h>

#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

/** A drive through a made-up place, as a rawlog of scans and odometry, with the exact poses. */
namespace viwo::testing
{
struct Wall
{
	Eigen::Vector2d a, b;
};

/** A ring of corridors, 2 m wide around a block of 8 x 6 m, with niches and pillars that tell its sides apart. */
inline std::vector<Wall> ringOfCorridors()
{
	std::vector<Wall> walls;
	const auto box = [&](double x0, double y0, double x1, double y1)
	{
		const std::vector<Eigen::Vector2d> c{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
		for (size_t i = 0; i < 4; ++i) walls.push_back({c[i], c[(i + 1) % 4]});
	};
	box(0, 0, 8, 6);
	box(-2, -2, 10, 8);
	box(3, -1.99, 3.6, -1.6);
	box(6.5, -0.4, 6.9, -0.01);
	box(9.4, 2, 9.99, 2.5);
	box(8.01, 4.1, 8.3, 4.3);
	box(5, 7.5, 6.2, 7.99);
	box(2, 6.01, 2.3, 6.5);
	box(-1.99, 4, -1.7, 5);
	box(-0.4, 1.5, -0.01, 1.7);
	return walls;
}

struct RoomLog
{
	std::vector<Wall> walls = ringOfCorridors();
	int scans = 600;
	int beams = 181;
	double noise_m = 0.01;
	double distance_scale = 0.97;  //!< of odometry
	double turn_scale = 0.97;
	bool with_odometry = true;
	uint64_t seed = 1;
	/** Called for each scan before it is written; may change it, or the odometry that goes with it. */
	std::function<void(int, std::vector<float>&, gt::Pose2&)> disturb = [](int, std::vector<float>&, gt::Pose2&) {};
	/** What odometry's reading is written as. */
	std::function<gt::Pose2(int, const gt::Pose2&)> written = [](int, const gt::Pose2& odometry) { return odometry; };
	int odometry_stride = 1;                //!< scans for each reading of odometry
	std::optional<double> gyro_bias_rad_s;  //!< with an IMU at 100 Hz of this bias
	std::function<bool(int)> has_scan = [](int) { return true; };
	std::function<int64_t(int)> stamp_ns = [](int i) { return kStart_ns + i * kPeriod_ns; };
	double start_m = 0;   //!< along the way
	int second_from = 0;  //!< scans from this one on go to a second rawlog; 0: all to one
	std::string second_path;

	static constexpr int64_t kStart_ns = 1'600'000'000'000'000'000, kPeriod_ns = 100'000'000;
	std::map<int64_t, gt::Pose2> truth;  //!< of the scans written, by their stamps

	/** Twice around the block along a rectangle with rounded corners. */
	static gt::Pose2 poseAt(double s)
	{
		const double a = 10, b = 8, r = 0.8, straight_a = a - 2 * r, straight_b = b - 2 * r, quarter = 0.5 * M_PI * r;
		const double round = 2 * (straight_a + straight_b) + 4 * quarter;
		s = std::fmod(s, round);
		gt::Pose2 T(-1 + r, -1, 0);
		for (int side = 0;; ++side)
		{
			const double straight = side % 2 == 0 ? straight_a : straight_b;
			if (s <= straight) return T * gt::Pose2(s, 0, 0);
			T = T * gt::Pose2(straight, 0, 0);
			s -= straight;
			const double angle = std::min(s, quarter) / r;
			const gt::Pose2 arc(r * std::sin(angle), r * (1 - std::cos(angle)), angle);
			if (s <= quarter) return T * arc;
			T = T * arc;
			s -= quarter;
		}
	}

	/** Ten readings up to the next scan. */
	void writeImu(int64_t t_ns, int i, RawlogWriter& writer) const
	{
		const double rate_rad_s = gt::between(poseAt(start_m + 0.12 * i), poseAt(start_m + 0.12 * (i + 1))).yaw / (1e-9 * kPeriod_ns);
		for (int k = 0; k < 10; ++k)
		{
			ImuSample sample;
			sample.t_ns = t_ns + k * kPeriod_ns / 10;
			sample.gyro_rad_s.z() = rate_rad_s + *gyro_bias_rad_s;
			writer.write(makeImu(sample, Pose3()));
		}
	}

	float range(const gt::Pose2& T, double angle) const
	{
		const Eigen::Vector2d d(std::cos(T.yaw + angle), std::sin(T.yaw + angle));
		double best = std::numeric_limits<double>::infinity();
		for (const Wall& wall : walls)
		{
			const Eigen::Vector2d e = wall.b - wall.a, f = wall.a - T.p;
			const double det = d.x() * e.y() - d.y() * e.x();
			if (std::abs(det) < 1e-12) continue;
			const double t = (f.x() * e.y() - f.y() * e.x()) / det, u = (f.x() * d.y() - f.y() * d.x()) / det;
			if (t > 0 && u >= 0 && u <= 1 && t < best) best = t;
		}
		return static_cast<float>(best);
	}

	void write(const std::string& path)
	{
		truth.clear();
		std::mt19937_64 random(seed);
		std::normal_distribution<double> normal;
		auto writer = std::make_unique<RawlogWriter>(path);
		gt::Pose2 odometry;
		for (int i = 0; i < scans; ++i)
		{
			if (second_from > 0 && i == second_from)
			{
				writer->close();
				writer = std::make_unique<RawlogWriter>(second_path);
			}
			const gt::Pose2 T = poseAt(start_m + 0.12 * i), last = poseAt(start_m + 0.12 * std::max(0, i - 1));
			const gt::Pose2 step = between(last, T);
			odometry = odometry * gt::Pose2(step.p * distance_scale, step.yaw * turn_scale + 2e-4 * normal(random));
			std::vector<float> ranges;
			for (int k = 0; k < beams; ++k)
			{
				const double angle = beams > 1 ? -M_PI / 2 + M_PI * k / (beams - 1) : 0;
				ranges.push_back(range(T, angle) + static_cast<float>(noise_m * normal(random)));
			}
			disturb(i, ranges, odometry);
			const int64_t t_ns = stamp_ns(i);
			const gt::Pose2 reading = written(i, odometry);
			if (with_odometry && i % odometry_stride == 0)
				writer->write(makeOdometry(t_ns, {}, {}, reading.p.x(), reading.p.y(), reading.yaw));
			if (gyro_bias_rad_s) writeImu(t_ns, i, *writer);
			if (!has_scan(i)) continue;
			auto scan = makeScan(t_ns, ranges, M_PI, 30, Pose3(), "LIDAR");
			// As a driver writes them that does not look at its numbers.
			for (size_t k = 0; k < ranges.size(); ++k)
				if (std::isnan(ranges[k]))
				{
					scan.setScanRange(k, ranges[k]);
					scan.setScanRangeValidity(k, true);
				}
			writer->write(scan);
			truth.emplace(t_ns, T);
		}
		writer->close();
	}
};
}  // namespace viwo::testing
