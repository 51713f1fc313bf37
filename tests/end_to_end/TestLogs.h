#pragma once

#include <string>
#include <vector>

#include <viwo/experiments/Recipes.h>

/** The simulated logs of the end-to-end tests: one seed each, as short as they may be. */
namespace viwo::testing
{
/** 24 s: straight on, two turns on the spot, straight on. */
experiments::SimulatedDrive corridorTestDrive();
/** 20 s of a constant arc, in motion from the first sample on. */
experiments::SimulatedDrive lobbyTestDrive();

/** 10 s of free motion; a small colour camera looks left, the IMU lies on its side, other labels and rates. */
experiments::SimulatedDrive sidewaysRobotDrive();
/** 10 s of free motion; a fisheye at 5 Hz looks backwards, the IMU has 50 Hz, the wheels 5 Hz. */
experiments::SimulatedDrive backwardsRobotDrive();

/** Recipes of all. */
std::vector<experiments::LogRecipe> testLogRecipes();

/** Folder in which they are kept. */
std::string testLogFolder();

struct TestLog
{
	std::string rawlog, ground_truth;
};
/** @throws Error when it has not been made: viwo_test_logs does. */
TestLog testLog(const experiments::SimulatedDrive& drive);
}  // namespace viwo::testing
