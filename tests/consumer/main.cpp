// Another project's program: it feeds observations to an installed viwo and reads the state. Five seconds at 0.2 m/s are one metre.
#include <mrpt/obs/CObservationOdometry.h>
#include <viwo/odometry/Odometry.h>

#include <chrono>
#include <cmath>
#include <cstdio>

int main()
{
	viwo::OdometryOptions options;
	options.estimator.mode = viwo::Mode::wheel;
	viwo::Odometry odometry(options);
	for (int i = 0; i <= 120; ++i)
	{
		auto observation = mrpt::obs::CObservationOdometry::Create();
		observation->sensorLabel = "ODOMETRY";
		observation->timestamp = mrpt::Clock::fromDouble(1.5e9) + std::chrono::milliseconds(50 * i);
		observation->hasVelocities = true;
		observation->velocityLocal = {0.2, 0, 0};
		odometry.processObservation(observation);
	}
	odometry.finish();
	const auto& poses = odometry.trajectory().poses();
	if (poses.size() < 2) return 1;
	const double duration_s = 1e-9 * static_cast<double>(poses.back().t_ns - poses.front().t_ns);
	const double length_m = (odometry.latest().T_WO.p - poses.front().T.p).norm();
	std::printf("%zu poses, %.3f m in %.2f s\n", poses.size(), length_m, duration_s);
	return duration_s > 5 && std::abs(length_m - 0.2 * duration_s) < 0.01 ? 0 : 1;
}
