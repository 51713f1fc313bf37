#pragma once

#include "Frame.h"
#include "LandmarkMap.h"

#include <viwo/estimator/BatchCalibration.h>

#include <array>
#include <deque>

namespace viwo
{
/** Small errors of the IMU's axes: what is measured is (I + S) times the truth. Row by row, accelerometer first. */
struct ImuSensitivity
{
	static constexpr int size = 18;
	std::array<double, size> entries{};

	/** The sample as a faultless sensor would give it, to first order. */
	ImuSample corrected(const ImuSample& measured) const;
};

using RigJacobian = Eigen::Matrix<double, RigOrder::size, RigOrder::size>;

/** d(T_OB.p, turn) / d(tangent of T_BO): how the IMU's place on the robot follows from the solver's block. */
Eigen::Matrix<double, 6, 6> imuMountingJacobian(const Pose3& T_BO);

/** d rigDifference(., rig) / d(tangents of wheels, T_BO, T_BC and both offsets, one after the other), at the rig. */
RigJacobian rigJacobian(const SensorRig& rig);

/** All that a batch calibration estimates, as blocks of the solver. */
struct BatchStates
{
	std::deque<Frame> frames;  //!< key frames in order of time; their stamps are the camera's
	std::array<double, 7> T_BC{}, T_BO{};
	std::array<double, 3> wheels{};  //!< k_left, k_right, track_m
	std::array<double, 1> camera_offset_s{}, wheel_offset_s{};
	std::array<double, 3> plane{};
	ImuSensitivity sensitivity;
	std::array<double, 7> T_RW{};  //!< R: the reference's frame
	std::array<double, 1> reference_offset_s{};

	SensorRig rig() const;
	void setRig(const SensorRig& rig);

	/** Stamp of a frame in the IMU's and in the wheels' clock. */
	int64_t imuTime_ns(const Frame& frame) const;
	int64_t wheelTime_ns(const Frame& frame) const;
};
}  // namespace viwo
