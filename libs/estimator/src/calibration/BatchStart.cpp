#include "calibration/BatchStart.h"

#include "ImuPreintegration.h"
#include "WheelPreintegration.h"

#include <mrpt/core/format.h>
#include <viwo/core/So3.h>
#include <viwo/core/Time.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace viwo
{
namespace
{
/** Ends of the streams that offsets of the clocks may need. */
constexpr double kMargin_s = 0.25;
/** A robot whose wheels are silent for this long on both sides stands, whatever the clocks. */
constexpr double kQuietSide_s = 0.15;
constexpr double kLeastDuration_s = 20;
constexpr double kLeastTravel_m = 2, kLeastTurn_rad = 2;

bool stands(const BatchSamples& samples, const EstimatorOptions& options, int64_t t_ns)
{
	const int64_t side_ns = nanoseconds(kQuietSide_s);
	const auto segments = samples.wheels.segments(t_ns - side_ns, t_ns + side_ns, options.window.max_wheel_gap_s);
	return segments &&
	       std::all_of(segments->begin(), segments->end(), [](const WheelSegment& s) { return s.v_left_m_s == 0 && s.v_right_m_s == 0; });
}

/** What the streams lack; empty when they reach over the same time. */
std::string checkStreams(const BatchCalibrationInput& in)
{
	if (in.frames.empty()) return "there are no images to calibrate with; record camera, IMU and wheel odometry";
	if (in.imu.empty()) return "there are no IMU samples to calibrate with; record camera, IMU and wheel odometry";
	if (in.wheels.empty()) return "there is no wheel odometry to calibrate with; record camera, IMU and wheel odometry";
	const int64_t begin_ns = std::max({in.frames.front().t_ns, in.imu.front().t_ns, in.wheels.front().t_ns});
	const int64_t end_ns = std::min({in.frames.back().t_ns, in.imu.back().t_ns, in.wheels.back().t_ns});
	const double common_s = secondsBetween(begin_ns, end_ns);
	if (common_s < kLeastDuration_s)
		return mrpt::format("camera, IMU and wheels overlap for %.1f s only, a calibration needs %.0f s, better 120 s",
		                    std::max(0.0, common_s), kLeastDuration_s);
	return {};
}

/** Of the gyroscope, from where the robot stands; without any such place from the wheels' turning. */
Eigen::Vector3d gyroBias(const BatchCalibrationInput& in, const EstimatorOptions& options, const BatchSamples& samples)
{
	Eigen::Vector3d standing = Eigen::Vector3d::Zero(), all = Eigen::Vector3d::Zero();
	int quiet = 0;
	for (const ImuSample& s : in.imu)
	{
		all += s.gyro_rad_s;
		if (!stands(samples, options, s.t_ns - nanoseconds(in.start.wheel_offset_s))) continue;
		standing += s.gyro_rad_s;
		++quiet;
	}
	constexpr int kEnough = 50;
	if (quiet >= kEnough) return standing / quiet;
	double turned_rad = 0;
	for (size_t i = 1; i < in.wheels.size(); ++i)
		turned_rad += twistOf(in.wheels[i], in.start.wheels).w_rad_s * secondsBetween(in.wheels[i - 1].t_ns, in.wheels[i].t_ns);
	const double duration_s = std::max(1e-3, secondsBetween(in.wheels.front().t_ns, in.wheels.back().t_ns));
	return all / static_cast<double>(in.imu.size()) - in.start.T_BO.R * Eigen::Vector3d(0, 0, turned_rad / duration_s);
}

/** Where the robot is on level ground, carried on from key frame to key frame. */
class DeadReckoning
{
   public:
	DeadReckoning(const BatchSamples& samples, const EstimatorOptions& options, const SensorRig& rig, const Eigen::Vector3d& b_g)
	    : samples_(samples), options_(options), rig_(rig), T_OB_(rig.T_BO.inverse()), b_g_(b_g)
	{
	}

	/** From one frame to the next. @return false in a hole of the IMU. */
	bool advance(int64_t imu_from_ns, int64_t imu_to_ns)
	{
		const auto span = samples_.imu.span(imu_from_ns, imu_to_ns, options_.window.max_imu_gap_s);
		if (!span) return false;
		ImuPreintegration imu(options_.noise.imu, Eigen::Vector3d::Zero(), b_g_);
		imu.integrate(*span);
		const double turn_rad = so3::log(Eigen::Quaterniond(T_OB_.R * imu.delta().gamma * T_OB_.R.conjugate())).z();
		const int64_t offset_ns = nanoseconds(rig_.wheel_offset_s);
		const auto segments = samples_.wheels.segments(imu_from_ns - offset_ns, imu_to_ns - offset_ns, options_.window.max_wheel_gap_s);
		double way_m = twist_.v_m_s * secondsBetween(imu_from_ns, imu_to_ns);
		if (segments)
		{
			way_m = 0;
			for (const WheelSegment& s : *segments)
			{
				twist_ = twistOf({0, s.v_left_m_s, s.v_right_m_s}, rig_.wheels);
				way_m += twist_.v_m_s * s.dt_s;
			}
		}
		twist_.w_rad_s = (T_OB_.R * (span->back().gyro_rad_s - b_g_)).z();
		const Eigen::Vector3d chord = so3::leftJacobian({0, 0, turn_rad}) * Eigen::Vector3d(way_m, 0, 0);
		T_WO_ = T_WO_ * Pose3(so3::expQuaternion({0, 0, turn_rad}), chord);
		travel_m_ += std::abs(way_m);
		turned_rad_ += std::abs(turn_rad);
		return true;
	}

	NavState state() const
	{
		NavState s;
		s.T_WB = T_WO_ * T_OB_;
		s.v_WB = T_WO_.R * (Eigen::Vector3d(twist_.v_m_s, 0, 0) + Eigen::Vector3d(0, 0, twist_.w_rad_s).cross(T_OB_.p));
		s.b_g = b_g_;
		return s;
	}
	double travel_m() const { return travel_m_; }
	double turned_rad() const { return turned_rad_; }

   private:
	const BatchSamples& samples_;
	const EstimatorOptions& options_;
	SensorRig rig_;
	Pose3 T_OB_, T_WO_;
	Eigen::Vector3d b_g_;
	WheelTwist twist_;
	double travel_m_ = 0, turned_rad_ = 0;
};
}  // namespace

BatchSamples::BatchSamples(const BatchCalibrationInput& input)
{
	for (const ImuSample& s : input.imu) imu.add(s);
	for (const WheelSample& s : input.wheels) wheels.add(s);
}

std::string startBatch(const BatchCalibrationInput& in, const BatchCalibrationOptions& options, const EstimatorOptions& estimator,
                       const BatchSamples& samples, BatchStates& states)
{
	if (const std::string problem = checkStreams(in); !problem.empty()) return problem;
	states.setRig(in.start);
	states.frames.clear();
	const int64_t margin_ns = nanoseconds(kMargin_s);
	const auto covered = [&](const Frame& f)
	{
		const int64_t imu_ns = states.imuTime_ns(f), wheels_ns = states.wheelTime_ns(f);
		return samples.imu.covers(imu_ns - margin_ns) && samples.imu.covers(imu_ns + margin_ns) &&
		       samples.wheels.covers(wheels_ns - margin_ns) && samples.wheels.covers(wheels_ns + margin_ns);
	};
	DeadReckoning reckoning(samples, estimator, in.start, gyroBias(in, estimator, samples));
	for (const FeatureFrame& features : in.frames)
	{
		Frame frame;
		frame.id = static_cast<int64_t>(states.frames.size());
		frame.t_ns = features.t_ns;
		if (!covered(frame)) continue;
		frame.standing = stands(samples, estimator, states.wheelTime_ns(frame));
		if (!states.frames.empty())
		{
			const Frame& before = states.frames.back();
			constexpr double kJitter_s = 0.01;  // of stamps
			const bool both_stand = frame.standing && before.standing;
			const double period_s = both_stand ? options.standing_period_s : options.keyframe_period_s;
			if (secondsBetween(before.t_ns, frame.t_ns) < period_s - kJitter_s) continue;
			if (!reckoning.advance(states.imuTime_ns(before), states.imuTime_ns(frame)))
				return mrpt::format(
				    "the IMU has a hole of more than %.2f s, %.1f s after the log's begin; take a log without, or one part of it",
				    estimator.window.max_imu_gap_s, secondsBetween(in.imu.front().t_ns, states.imuTime_ns(before)));
		}
		NavState state = reckoning.state();
		state.t_ns = frame.t_ns;
		frame.setState(state);
		frame.features = features;
		states.frames.push_back(std::move(frame));
	}
	if (reckoning.travel_m() < kLeastTravel_m && reckoning.turned_rad() < kLeastTurn_rad)
		return mrpt::format(
		    "the robot moves by %.2f m and turns by %.0f deg only; drive it: starts and stops, turns to both sides, figures of "
		    "eight, for two minutes",
		    reckoning.travel_m(), reckoning.turned_rad() * 180 / M_PI);
	return {};
}
}  // namespace viwo
