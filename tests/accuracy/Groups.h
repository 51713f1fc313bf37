#pragma once

#include "Group.h"

namespace viwo::accuracy
{
/** Logs that begin in mid-motion: straight, arc, rotation on the spot, standing. What is known at the first pose, and the ten seconds
 * after. */
std::unique_ptr<Group> starts(const Settings& settings);

/** Straight lines and a rotation on the spot: all three modes. */
std::unique_ptr<Group> corridor(const Settings& settings);

/** A constant arc, in motion from the first sample on: all three modes. */
std::unique_ptr<Group> lobby(const Settings& settings);

/** Camera and IMU alone, held in a hand: six degrees of freedom, all excited. */
std::unique_ptr<Group> handHeld(const Settings& settings);

/** One wheel turns 30 % too much for two seconds; each run is compared with that of the same seed without slip. */
std::unique_ptr<Group> slip(const Settings& settings);

/** Black images, silent wheels, jittered stamps, a step of the exposure; each run is compared with the clean one of the same seed. */
std::unique_ptr<Group> disturbances(const Settings& settings);

/** Ten minutes of standing between two drives. */
std::unique_ptr<Group> standing(const Settings& settings);

/** One part of the estimator off at a time. */
std::unique_ptr<Group> ablation(const Settings& settings);

/** Robots with other rates, mountings, lenses, labels and sizes, with configuration alone; three seeds at most. */
std::unique_ptr<Group> robots(const Settings& settings);

/** viwo-calibrate estimate from a wrong start, on the drive that is made for it. */
std::unique_ptr<Group> calibration(const Settings& settings);

/** The switches of calibration while driving against none of them, from a wrong start and from the right one, on the same drive. */
std::unique_ptr<Group> onlineCalibration(const Settings& settings);

/** Recordings of real cars and copters, where they are at hand. */
std::unique_ptr<Group> real(const Settings& settings);

/** Whether errors are as large as the covariances say, with wheels drawn from the estimator's priors. */
std::unique_ptr<Group> consistencyOfCovariance(const Settings& settings);

/** The same log three times, once beside a busy machine. */
std::unique_ptr<Group> determinism(const Settings& settings);

/** One program at a time on an idle machine; and ten minutes of driving. */
std::unique_ptr<Group> speedAndMemory(const Settings& settings);

/** All of them, in the order of the table. */
std::vector<std::unique_ptr<Group>> allGroups(const Settings& settings);
}  // namespace viwo::accuracy
