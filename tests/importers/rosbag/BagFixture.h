#pragma once

#include "RawlogContent.h"
#include "TempFolder.h"
#include "TestBag.h"

#include <gtest/gtest.h>
#include <viwo/core/MrptPose.h>
#include <viwo/importers/RosBagImporter.h>
#include <viwo/rawlog/MrptTime.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

/** Imports a bag that the test wrote, and reads the rawlog. */
namespace viwo::testing
{
inline void expectSamePose(const mrpt::poses::CPose3D& actual, const Pose3& expected, const std::string& what)
{
	const Pose3 T = fromMrpt(actual);
	EXPECT_NEAR((T.p - expected.p).norm(), 0, 1e-9) << what;
	EXPECT_NEAR(T.R.angularDistance(expected.R), 0, 1e-7) << what;
}

inline int64_t stampOf(const mrpt::obs::CObservation& observation)
{
	return nanosecondsOf(observation.timestamp);
}

inline int64_t at_ns(int64_t t_ms)
{
	return kBagStart_ns + t_ms * 1000000;
}

inline bool isNote(const ImportResult& result, const std::string& part)
{
	for (const std::string& note : result.notes)
		if (note.find(part) != std::string::npos) return true;
	return false;
}

template <class Observation>
std::vector<std::shared_ptr<Observation>> observationsOf(const std::string& rawlog, const std::string& label)
{
	std::vector<std::shared_ptr<Observation>> found;
	RawlogReader reader(rawlog,
	                    [&]
	                    {
		                    RawlogReaderOptions options;
		                    options.labels = {label};
		                    return options;
	                    }());
	while (const auto observation = reader.next())
		if (auto wanted = std::dynamic_pointer_cast<Observation>(observation)) found.push_back(wanted);
	return found;
}

class RosBag : public ::testing::Test
{
   protected:
	void SetUp() override
	{
		if (!hasRosBagSupport()) GTEST_SKIP() << "built without ROS bags";
	}
	std::string path(const std::string& name) const { return folder_.file(name); }
	ImportResult import(const std::string& map = {}, bool record_time = false, const std::string& bag = "x.bag")
	{
		return importRosBags({"", path("x.rawlog")}, {{path(bag)}, map, record_time});
	}
	std::string writeMap(const std::string& text) const
	{
		writeFile(path("map.ini"), text);
		return path("map.ini");
	}
	/** Ten messages of odometry, and what the test adds. */
	void writeBag(const std::function<void(rosbag::Bag&)>& add) const
	{
		rosbag::Bag bag(path("x.bag"), rosbag::bagmode::Write);
		for (int i = 0; i < 10; ++i) bag.write("/odom", bagTime(50 * i), odometryMessage(50 * i, 0.1, 0));
		add(bag);
		bag.close();
	}

	TempFolder folder_;
};
}  // namespace viwo::testing
