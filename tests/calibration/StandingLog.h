#pragma once

#include "NoiseSeries.h"

#include <viwo/calibration/EvenImu.h>
#include <viwo/core/Time.h>
#include <viwo/rawlog/RawlogWriter.h>

#include <functional>
#include <string>

namespace viwo::testing
{
constexpr int64_t kStandingStart_ns = 1'700'000'000'000'000'000;

/** An IMU at rest. */
struct StandingImu
{
	double rate_hz = 100, length_s = 120;
	NoiseDensities acc{0, 2e-3, 0, 0}, gyro{0, 2e-4, 0, 0};
	unsigned seed = 1;

	ImuRecord record() const
	{
		ImuRecord r;
		const auto count = static_cast<size_t>(length_s * rate_hz);
		for (size_t axis = 0; axis < kImuAxes; ++axis)
			r.axes[axis] = noiseSeries(axis < 3 ? acc : gyro, 1 / rate_hz, count, 10 * seed + static_cast<unsigned>(axis));
		for (double& x : r.axes[2]) x += 9.81;
		for (size_t i = 0; i < count; ++i) r.t_ns.push_back(kStandingStart_ns + nanoseconds(static_cast<double>(i) / rate_hz));
		return r;
	}
};

inline Pose3 standingPose()
{
	Pose3 T_OB;
	T_OB.p = {0.1, -0.2, 0.3};
	return T_OB;
}

/** @param beside called with each sample's index, to write other sensors. */
inline void writeStandingLog(const std::string& path, const ImuRecord& record,
                             const std::function<void(RawlogWriter&, size_t)>& beside = {})
{
	RawlogWriter writer(path);
	for (size_t i = 0; i < record.t_ns.size(); ++i)
	{
		ImuSample sample;
		sample.t_ns = record.t_ns[i];
		for (size_t k = 0; k < 3; ++k)
		{
			sample.acc_m_s2[static_cast<Eigen::Index>(k)] = record.axes[k][i];
			sample.gyro_rad_s[static_cast<Eigen::Index>(k)] = record.axes[k + 3][i];
		}
		writer.write(makeImu(sample, standingPose()));
		if (beside) beside(writer, i);
	}
	writer.close();
}
}  // namespace viwo::testing
