#include "AllTypesBag.h"
#include "BagFixture.h"
#include "ExpectError.h"

#include <cmath>
#include <functional>
#include <limits>
#include <random>

using namespace viwo;
using namespace viwo::testing;

namespace
{
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr char kWheels[] =
    "[ODOMETRY]\ntopic = /joint_states\nleft_joints = fl rl\nright_joints = fr rr\nwheel_radius_m = 0.1\ntrack_m = 0.5\n";

Pose3 planar(double x_m, double y_m, double yaw_rad)
{
	return {Eigen::Quaterniond(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ())), {x_m, y_m, 0}};
}

class RosBagOdometry : public RosBag
{
   protected:
	/** Twenty messages of a frame `child` that drives at v and w along the arc from the origin; tf puts it into base_link. */
	void writeArc(const std::string& child, const std::optional<Pose3>& T_base_child, double v_m_s, double w_rad_s)
	{
		rosbag::Bag bag(path("x.bag"), rosbag::bagmode::Write);
		tf2_msgs::TFMessage frames;
		frames.transforms = {transform("base_link", "imu_link", {})};
		if (T_base_child) frames.transforms.push_back(transform("base_link", child, *T_base_child));
		bag.write("/tf_static", bagTime(0), frames);
		for (int i = 0; i < 20; ++i)
		{
			const double yaw_rad = 0.05 * i * w_rad_s, radius_m = v_m_s / w_rad_s;
			auto odometry = odometryMessage(50 * i, v_m_s, w_rad_s, radius_m * std::sin(yaw_rad), yaw_rad);
			odometry.pose.pose.position.y = radius_m * (1 - std::cos(yaw_rad));
			odometry.child_frame_id = child;
			bag.write("/odom", bagTime(50 * i), odometry);
			auto twist = stamped<geometry_msgs::TwistStamped>(50 * i, child);
			twist.twist = odometry.twist.twist;
			bag.write("/twist", bagTime(50 * i), twist);
		}
		bag.close();
	}

	/** Wheels that turn at kWheelRates_rad_s, 20 Hz. */
	void writeWheels(const std::function<void(int, sensor_msgs::JointState&)>& edit, int messages = 100)
	{
		rosbag::Bag bag(path("x.bag"), rosbag::bagmode::Write);
		for (int i = 0; i < messages; ++i)
		{
			auto state = wheelsMessage(50 * i);
			edit(i, state);
			bag.write("/joint_states", bagTime(50 * i), state);
		}
		bag.close();
	}

	/** Imports them; all samples must have the wheels' speeds. */
	ImportResult importWheels(size_t samples)
	{
		const ImportResult result = import(writeMap(kWheels));
		const RawlogContent content(path("x.rawlog"));
		EXPECT_EQ(content.odometry.size(), samples);
		EXPECT_EQ(result.odometry_samples, samples);
		for (const auto& odometry : content.odometry)
		{
			EXPECT_NEAR(odometry->velocityLocal.vx, 0.5, 1e-9) << stampOf(*odometry) - kBagStart_ns;
			EXPECT_NEAR(odometry->velocityLocal.omega, 0.8, 1e-9) << stampOf(*odometry) - kBagStart_ns;
		}
		return result;
	}
};
}  // namespace

// The rear axle, 1.5 m behind O and looking backwards, drives at -0.3 m/s; a turn moves O sideways.
TEST_F(RosBagOdometry, MotionOfAnotherFrameIsMovedToTheBaseFrame)
{
	const Pose3 T_OA = planar(-1.5, 0, M_PI);
	writeArc("rear_axle", T_OA, -0.3, 0.2);
	for (const char* topic : {"/odom", "/twist"})
	{
		const ImportResult result = import(writeMap(std::string("[general]\nbase_frame = base_link\n[ODOMETRY]\ntopic = ") + topic + "\n"));
		EXPECT_TRUE(isNote(result, "are those of 'rear_axle', moved to 'base_link' by tf"));
		EXPECT_TRUE(isNote(result, "O moves sideways, by 0.300 m/s where it moves forward by 0.300 m/s"));
		EXPECT_TRUE(isNote(result, "set base_frame = rear_axle"));
		for (const auto& odometry : RawlogContent(path("x.rawlog")).odometry)
		{
			EXPECT_NEAR(odometry->velocityLocal.vx, 0.3, 1e-12);
			EXPECT_NEAR(odometry->velocityLocal.vy, 0.2 * 1.5, 1e-12);
			EXPECT_NEAR(odometry->velocityLocal.omega, 0.2, 1e-12);
		}
	}
}

// The twists that were moved are the derivatives of the poses that were moved, for any pose of the frame.
TEST_F(RosBagOdometry, MovedTwistsAndPosesAgree)
{
	writeArc("wheel", planar(0.3, -0.4, 0.7), 0.5, 0.6);
	import(writeMap("[general]\nbase_frame = base_link\n[ODOMETRY]\ntopic = /odom\n"));
	const RawlogContent content(path("x.rawlog"));
	ASSERT_EQ(content.odometry.size(), 20u);
	double largest_m_s = 0;
	for (size_t i = 1; i + 1 < content.odometry.size(); ++i)
	{
		const auto before = content.odometry[i - 1]->odometry, after = content.odometry[i + 1]->odometry,
		           now = content.odometry[i]->odometry;
		const Eigen::Vector2d v_W = Eigen::Vector2d(after.x() - before.x(), after.y() - before.y()) / 0.1;
		const Eigen::Vector2d v_O = Eigen::Rotation2Dd(-now.phi()) * v_W;
		const auto& twist = content.odometry[i]->velocityLocal;
		largest_m_s = std::max(largest_m_s, (v_O - Eigen::Vector2d(twist.vx, twist.vy)).norm());
	}
	std::cout << "[measured] twist against the poses' differences: " << largest_m_s << " m/s\n";
	EXPECT_LT(largest_m_s, 1e-4);
}

TEST_F(RosBagOdometry, AFrameOnTheAxleHasNoSidewaysMotion)
{
	writeArc("left_wheel", planar(0, 0.25, 0), 0.5, 0.4);
	const ImportResult result = import(writeMap("[general]\nbase_frame = base_link\n[ODOMETRY]\ntopic = /odom\n"));
	EXPECT_FALSE(isNote(result, "sideways"));
	for (const auto& odometry : RawlogContent(path("x.rawlog")).odometry) EXPECT_NEAR(odometry->velocityLocal.vx, 0.5 + 0.4 * 0.25, 1e-12);
}

TEST_F(RosBagOdometry, WithoutABaseFrameTheOdometrysOwnIsTaken)
{
	writeArc("rear_axle", planar(-1.5, 0, M_PI), 0.3, 0.2);
	for (const auto& [topic, v_m_s] : {std::pair("/odom", 0.3), std::pair("/twist", -0.3)})
	{
		const ImportResult result = import(writeMap(std::string("[ODOMETRY]\ntopic = ") + topic + "\n"));
		// A twist's header does not say which frame is the vehicle's.
		EXPECT_EQ(isNote(result, "moved to 'base_link'"), v_m_s < 0);
		EXPECT_NEAR(RawlogContent(path("x.rawlog")).odometry[4]->velocityLocal.vx, v_m_s, 1e-12);
	}
}

// A driver that names the world where it should name the vehicle: tf's way there is the drive itself.
TEST_F(RosBagOdometry, MotionOfAFrameThatTfMovesIsTakenAsItIs)
{
	for (const double speed_m_s : {0.3, 0.0})
	{
		{
			rosbag::Bag bag(path("x.bag"), rosbag::bagmode::Write);
			for (int i = 0; i < 100; ++i)
			{
				const double t_s = 0.05 * i;
				// It stands at first, elsewhere than the world's origin.
				tf2_msgs::TFMessage frames;
				frames.transforms = {transform("odom", "base_link", planar(2 + speed_m_s * std::max(0.0, t_s - 3), 3, 0.5)),
				                     transform("base_link", "imu_link", planar(0.1, 0, 0))};
				bag.write("/tf", bagTime(50 * i), frames);
				bag.write("/imu", bagTime(50 * i), imuMessage(50 * i, {0, 0, 9.81}, {0, 0, 0}));
				auto odometry = odometryMessage(50 * i, t_s < 3 ? 0 : speed_m_s, speed_m_s);
				odometry.child_frame_id = "odom";
				bag.write("/odom", bagTime(50 * i), odometry);
				auto twist = stamped<geometry_msgs::TwistStamped>(50 * i, "/odom");
				twist.twist = odometry.twist.twist;
				bag.write("/twist", bagTime(50 * i), twist);
			}
			bag.close();
		}
		for (const char* topic : {"/odom", "/twist"})
		{
			const ImportResult result = import(
			    writeMap(std::string("[general]\nbase_frame = base_link\n[IMU]\ntopic = /imu\n[ODOMETRY]\ntopic = ") + topic + "\n"));
			EXPECT_EQ(isNote(result, "are those of 'odom', which tf moves against 'base_link', by 0.585 m and 0.00 deg"), speed_m_s > 0);
			EXPECT_EQ(isNote(result, "moved to 'base_link' by tf"), speed_m_s == 0);
			EXPECT_FALSE(isNote(result, "set base_frame = odom"));
			EXPECT_TRUE(isNote(result, "IMU: by tf from base_link to imu_link"));
			const RawlogContent content(path("x.rawlog"));
			ASSERT_EQ(content.odometry.size(), 100u);
			EXPECT_NEAR(content.odometry[80]->velocityLocal.vx, speed_m_s, 1e-12) << topic;
			EXPECT_NEAR(content.odometry[80]->velocityLocal.vy, 0, 1e-12) << topic;
		}
	}
}

// A frame on the vehicle that tf repeats in every message, behind another one: fixed all the same.
TEST_F(RosBagOdometry, AFixedFrameOfTheMovingTransformsIsMoved)
{
	writeArc("rear_axle", {}, 0.3, 0.2);
	{
		rosbag::Bag bag(path("x.bag"), rosbag::bagmode::Append);
		for (int i = 0; i < 20; ++i)
		{
			tf2_msgs::TFMessage frames;
			frames.transforms = {transform("odom", "base_footprint", planar(0.3 * i, 0, 0)),
			                     transform("base_footprint", "base_link", planar(0.5, 0, 0)),
			                     transform("base_footprint", "rear_axle", planar(-1, 0, 0))};
			bag.write("/tf", bagTime(50 * i), frames);
		}
		bag.close();
	}
	const ImportResult result = import(writeMap("[general]\nbase_frame = base_link\n[ODOMETRY]\ntopic = /twist\n"));
	EXPECT_TRUE(isNote(result, "are those of 'rear_axle', moved to 'base_link' by tf"));
	EXPECT_NEAR(RawlogContent(path("x.rawlog")).odometry[4]->velocityLocal.vy, 0.2 * 1.5, 1e-12);
}

TEST_F(RosBagOdometry, AFrameThatTfDoesNotKnowIsSaid)
{
	writeArc("hat", {}, 0.3, 0.2);
	const ImportResult result = import(writeMap("[general]\nbase_frame = base_link\n[ODOMETRY]\ntopic = /odom\n"));
	EXPECT_TRUE(isNote(result, "ODOMETRY: its twists and poses are those of 'hat', and tf has no way from there to 'base_link'"));
	EXPECT_NEAR(RawlogContent(path("x.rawlog")).odometry[4]->velocityLocal.vx, 0.3, 1e-12);
}

TEST_F(RosBagOdometry, AFrameOfTheWorldIsNotRecommendedForTheVehicle)
{
	writeArc("odom", {}, 0.3, 0.2);
	const ImportResult result = import(writeMap("[general]\nbase_frame = base_link\n[ODOMETRY]\ntopic = /twist\n"));
	EXPECT_TRUE(
	    isNote(result, "ODOMETRY: its twists are those of 'odom', and tf has no way from there to 'base_link'; taken for those of O"));
	EXPECT_FALSE(isNote(result, "set base_frame"));
}

TEST_F(RosBagOdometry, PosesAndTwistsThatAreNoneAreCounted)
{
	{
		rosbag::Bag bag(path("x.bag"), rosbag::bagmode::Write);
		for (int i = 0; i < 20; ++i)
		{
			auto odometry = odometryMessage(50 * i, i % 5 == 0 ? kNan : 0.3, 0.1, 0.015 * i);
			if (i % 2 == 0) odometry.pose.pose.orientation.w = 0;
			bag.write("/odom", bagTime(50 * i), odometry);
		}
		bag.close();
	}
	const ImportResult result = import();
	EXPECT_TRUE(isNote(result, "ODOMETRY: twists that are not finite: 4 of 20"));
	EXPECT_TRUE(isNote(result, "ODOMETRY: poses that are none"));
	EXPECT_TRUE(isNote(result, "10 of 20; they stand in the rawlog as NaN"));
	const RawlogContent content(path("x.rawlog"));
	ASSERT_EQ(content.odometry.size(), 20u);
	for (size_t i = 0; i < 20; ++i)
	{
		const auto& pose = content.odometry[i]->odometry;
		EXPECT_EQ(std::isnan(pose.x()) && std::isnan(pose.y()) && std::isnan(pose.phi()), i % 2 == 0);
		if (i % 2 == 0) continue;
		EXPECT_EQ(pose.x(), 0.015 * static_cast<double>(i));
	}
}

TEST_F(RosBagOdometry, WheelsOutOfOrderAreSorted)
{
	writeWheels([](int i, sensor_msgs::JointState& state)
	            { state = wheelsMessage(50 * (i % 10 == 9 ? i - 7 : i) + (i % 10 == 9 ? 7 : 0)); });
	const ImportResult result = importWheels(99);
	EXPECT_TRUE(isNote(result, "put in order: 10 observations"));
	EXPECT_FALSE(isNote(result, "out of order"));
}

TEST_F(RosBagOdometry, WheelMessagesOfOneStampAreCounted)
{
	writeWheels([](int i, sensor_msgs::JointState& state) { state = wheelsMessage(50 * (i == 40 ? 39 : i)); });
	EXPECT_TRUE(isNote(importWheels(98), "ODOMETRY: left out: 1 message with the stamp of another one"));
}

TEST_F(RosBagOdometry, AnglesWithinOneTurnAreUnwrapped)
{
	for (const double lowest_rad : {-M_PI, 0.0})
	{
		int jumps = 0;
		std::vector<double> last(4, 0);
		writeWheels(
		    [&](int, sensor_msgs::JointState& state)
		    {
			    for (size_t joint = 0; joint < state.position.size(); ++joint)
			    {
				    double& angle_rad = state.position[joint];
				    angle_rad -= 2 * M_PI * std::floor((angle_rad - lowest_rad) / (2 * M_PI));
				    jumps += std::abs(angle_rad - last[joint]) > M_PI;
				    last[joint] = angle_rad;
			    }
		    });
		EXPECT_GT(jumps, 10);
		EXPECT_TRUE(isNote(importWheels(99), std::to_string(jumps) + " jumps of a whole turn taken off")) << jumps;
	}
}

// +-3.1416 of a driver that writes four digits.
TEST_F(RosBagOdometry, RoundedAnglesWithinOneTurnAreUnwrapped)
{
	writeWheels(
	    [](int i, sensor_msgs::JointState& state)
	    {
		    for (double& angle_rad : state.position)
		    {
			    angle_rad = std::remainder(angle_rad, 2 * M_PI);
			    // Once each: the ends of the turn as they are rounded.
			    if (i == 0) angle_rad = -3.1416;
			    if (i == 99) angle_rad = 3.1416;
		    }
	    });
	const ImportResult result = import(writeMap(kWheels));
	EXPECT_TRUE(isNote(result, "jumps of a whole turn taken off"));
	const RawlogContent content(path("x.rawlog"));
	ASSERT_GT(content.odometry.size(), 95u);
	for (size_t i = 1; i + 2 < content.odometry.size(); ++i) EXPECT_NEAR(content.odometry[i]->velocityLocal.vx, 0.5, 1e-9) << i;
}

// A counter that starts from zero again, and one wrong value: those steps are left out, all others stay.
TEST_F(RosBagOdometry, WheelsThatJumpAreLeftOut)
{
	writeWheels(
	    [](int i, sensor_msgs::JointState& state)
	    {
		    for (double& angle_rad : state.position)
			    if (i >= 60) angle_rad = wheelsMessage(50 * (i - 60)).position[static_cast<size_t>(&angle_rad - state.position.data())];
		    if (i == 30) state.position[2] = 500;
	    });
	EXPECT_TRUE(isNote(importWheels(96), "ODOMETRY: left out: 3 samples for which a wheel would have jumped"));
}

// Hard acceleration, stops, and a pause in the recording are no jumps.
TEST_F(RosBagOdometry, WheelsThatStartAndStopAreKept)
{
	double angle_rad = 0;
	int64_t t_ms = 0;
	const ImportResult result = [&]
	{
		rosbag::Bag bag(path("x.bag"), rosbag::bagmode::Write);
		for (int i = 0; i < 200; ++i)
		{
			const double rate_rad_s = i / 20 % 2 == 0 ? 0 : 25;
			const int64_t step_ms = i == 130 ? 5000 : i % 7 == 0 ? 5 : 50;
			t_ms += step_ms, angle_rad += 1e-3 * static_cast<double>(step_ms) * rate_rad_s;
			auto state = wheelsMessage(t_ms);
			state.position.assign(4, angle_rad);
			bag.write("/joint_states", bagTime(t_ms), state);
		}
		bag.close();
		return import(writeMap(kWheels));
	}();
	EXPECT_EQ(result.odometry_samples, 199u);
	EXPECT_FALSE(isNote(result, "jumped"));
	double travel_m = 0;
	int64_t before_ns = at_ns(5);
	for (const auto& odometry : RawlogContent(path("x.rawlog")).odometry)
	{
		travel_m += odometry->velocityLocal.vx * 1e-9 * static_cast<double>(stampOf(*odometry) - before_ns);
		before_ns = stampOf(*odometry);
	}
	EXPECT_NEAR(travel_m, 0.1 * angle_rad, 1e-9);
}

TEST_F(RosBagOdometry, AJointOnBothSidesIsRefused)
{
	writeWheels([](int, sensor_msgs::JointState&) {}, 5);
	expectError(
	    [&]
	    {
		    import(writeMap(
		        "[ODOMETRY]\ntopic = /joint_states\nleft_joints = fl rl\nright_joints = fr rl\nwheel_radius_m = 0.1\ntrack_m = 0.5\n"));
	    },
	    {"map.ini: [ODOMETRY]", "left_joints and right_joints both name rl"});
}

// The wheels of a JointState tell which way an IMU looks that nobody places.
TEST_F(RosBagOdometry, WheelsOfJointsFindTheAxesOfTheImu)
{
	const Eigen::Quaterniond R_OB(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()));
	for (const bool has_wheels : {true, false})
	{
		{
			rosbag::Bag bag(path("x.bag"), rosbag::bagmode::Write);
			std::mt19937 generator(7);
			std::normal_distribution<double> noise(0, 0.1);
			for (int i = 0; i < 1000; ++i)
			{
				const double t_s = 0.02 * i;
				const Eigen::Vector3d force_O(0.4 * std::cos(t_s) + noise(generator), noise(generator), 9.81);
				bag.write("/imu", bagTime(20 * i), imuMessage(20 * i, R_OB.conjugate() * force_O, {0, 0, 0}));
				auto state = wheelsMessage(20 * i);
				state.position.assign(4, 4 - 4 * std::cos(t_s));
				bag.write("/joint_states", bagTime(20 * i), state);
			}
			bag.close();
		}
		const ImportResult result = import(writeMap(std::string("[IMU]\ntopic = /imu\n") + (has_wheels ? kWheels : "")));
		EXPECT_EQ(isNote(result, "forward by the odometry's accelerations"), has_wheels);
		EXPECT_EQ(isNote(result, "forward is a guess (no odometry)"), !has_wheels);
		const Pose3 T_OB = fromMrpt(RawlogContent(path("x.rawlog")).imu.at(0)->sensorPose);
		EXPECT_EQ(T_OB.R.angularDistance(R_OB) < 1e-7, has_wheels);
	}
}
