#include <gtest/gtest.h>

#include <viwo/core/Error.h>
#include <viwo/sim/Rig.h>
#include <viwo/sim/Sequence.h>
#include <viwo/sim/World.h>

#include <fstream>
#include <ostream>

#include "SimFixtures.h"
#include "TempFolder.h"

namespace viwo::sim
{
namespace
{
const std::string kShare = std::string(VIWO_SOURCE_DIR) + "/share/viwo/";

/** The sequences of Niu et al.: driven length (Table 1) and last start (Table 2). */
struct Published
{
	const char* name;
	double length_m, last_start_s;
};

/** Names the parameter in the list of tests. */
std::ostream& operator<<(std::ostream& out, const Published& p)
{
	return out << p.name;
}

class Sequences : public ::testing::TestWithParam<Published>
{
   protected:
	Sequences() : sequence_(Sequence::load(kShare + "sequences/" + GetParam().name + ".ini"))
	{
		loadRun(kShare + "rigs/" + sequence_.rig + ".ini", kShare + "routes/" + sequence_.route + ".ini", {}, rig_, route_);
	}

	Sequence sequence_;
	Rig rig_;
	Route route_;
};

TEST_P(Sequences, AreAsLongAsPublished)
{
	const Motion motion(route_, rig_.floor, rig_.vibration, 1);
	const double length_m = motion.groundTruth(50).length_m();
	measured(std::string(GetParam().name) + ": duration", motion.duration_s(), "s");
	measured(std::string(GetParam().name) + ": length", length_m, "m");
	EXPECT_NEAR(length_m, GetParam().length_m, 0.01 * GetParam().length_m);
	EXPECT_GT(motion.duration_s(), GetParam().last_start_s + 40) << "the last start needs 30 s after its initialisation";
}

TEST_P(Sequences, AreDrivenAtTheSpeedsOfTheRobot)
{
	const Motion motion(route_);
	double fastest_m_s = 0, fastest_turn_rad_s = 0, longest_s = 0;
	for (double t = 0; t < motion.duration_s(); t += 0.1)
	{
		const MotionState state = motion.at(t);
		fastest_m_s = std::max(fastest_m_s, state.v_WO.norm());
		fastest_turn_rad_s = std::max(fastest_turn_rad_s, std::abs(state.w_O.z()));
		longest_s += state.v_WO.norm() > 0.1 ? 0.1 : 0;
	}
	const bool free = std::string(GetParam().name) == "seq06";
	EXPECT_NEAR(route_.speed_m_s, 0.15, 1e-12);
	EXPECT_LT(fastest_m_s, free ? 0.25 : 0.1501);
	EXPECT_LT(fastest_turn_rad_s, free ? 0.5 : 0.1501);
	EXPECT_GT(longest_s, 0.5 * motion.duration_s()) << "most of the time the robot drives";
}

TEST_P(Sequences, HaveAWorld)
{
	EXPECT_NO_THROW(World::load(kShare + "worlds/" + sequence_.world + ".ini"));
}

TEST_P(Sequences, ShareOneRig)
{
	EXPECT_EQ(sequence_.rig, "turtlebot2_slipping");
}

INSTANTIATE_TEST_SUITE_P(Paper, Sequences,
                         ::testing::Values(Published{"seq01", 37.22, 210}, Published{"seq02", 55.85, 210}, Published{"seq03", 16.62, 150},
                                           Published{"seq04", 28.21, 180}, Published{"seq05", 31.64, 180}, Published{"seq06", 19.48, 150}),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(SequenceFile, NamesWhatIsMissing)
{
	const testing::TempFolder folder;
	const std::string path = folder.file("x.ini");
	std::ofstream(path) << "[sequence]\nworld = lobby\nroute = sample\n";
	try
	{
		Sequence::load(path);
		FAIL() << "a sequence without a rig was accepted";
	}
	catch (const Error& e)
	{
		EXPECT_NE(std::string(e.what()).find("rig"), std::string::npos) << e.what();
	}
}

TEST(SlippingRig, IsTheRobotOfAllOtherDrivesButForItsTrackAndItsSlips)
{
	Rig slipping, plain;
	Route route;
	loadRun(kShare + "rigs/turtlebot2_slipping.ini", kShare + "routes/sample.ini", {}, slipping, route);
	loadRun(kShare + "rigs/turtlebot2.ini", kShare + "routes/sample.ini", {}, plain, route);
	EXPECT_GT(slipping.wheels.slips.size(), 4 * 10u);
	plain.wheels.slips = slipping.wheels.slips;
	plain.wheels.track_error = -plain.wheels.track_error;
	const testing::TempFolder folder;
	saveOptions(folder.file("slipping.ini"), slipping.sections());
	saveOptions(folder.file("plain.ini"), plain.sections());
	EXPECT_EQ(testing::readFile(folder.file("slipping.ini")), testing::readFile(folder.file("plain.ini")));
}
}  // namespace
}  // namespace viwo::sim
