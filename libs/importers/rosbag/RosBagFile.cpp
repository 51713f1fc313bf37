#include "RosBagFile.h"

#include "RosBagHeader.h"
#include "RosBagRecords.h"

#include <console_bridge/console.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <viwo/core/Error.h>
#include <viwo/core/NumberText.h>

#include <algorithm>
#include <filesystem>
#include <map>

namespace viwo
{
namespace
{
/** The lower, the sooner it is that which is meant where a topic has two types. */
int rank(const std::string& type)
{
	if (isConvertible(type)) return 0;
	return isTransformType(type) || type == "sensor_msgs/CameraInfo" || type == "geometry_msgs/PoseStamped" ? 1 : 2;
}

bool isReadAs(const std::string& type, const RosTopic& read)
{
	return type == read.type || (isTransformType(type) && isTransformType(read.type));
}
}  // namespace

struct RosBagFile::Impl
{
	std::vector<std::unique_ptr<rosbag::Bag>> bags;
};

RosBagFile::RosBagFile(const std::vector<std::string>& paths) : impl_(std::make_unique<Impl>()), paths_(paths)
{
	if (paths.empty()) throw Error("no bag was given");
	// rosbag would say on stderr what becomes an Error here.
	console_bridge::noOutputHandler();
	std::map<std::pair<std::string, std::string>, size_t> counts;
	for (const std::string& path : paths)
	{
		requireReadableBag(path);
		std::error_code ignored;
		const auto same = [&](const std::string& other) { return std::filesystem::equivalent(path, other, ignored); };
		if (std::count_if(paths.begin(), paths.end(), same) > 1) throw Error(path + ": given twice; name each bag of a recording once");
		requireSoundRecords(path);
		try
		{
			impl_->bags.push_back(std::make_unique<rosbag::Bag>(path));
			rosbag::View view(*impl_->bags.back());
			// Messages by connection: a topic has one per publisher.
			for (const rosbag::ConnectionInfo* connection : view.getConnections()) counts[{connection->topic, connection->datatype}];
			for (auto& [topic, count] : counts)
			{
				const auto ofTopic = [&topic = topic](const rosbag::ConnectionInfo* c)
				{ return c->topic == topic.first && c->datatype == topic.second; };
				count += rosbag::View(*impl_->bags.back(), ofTopic).size();
			}
		}
		catch (const std::exception& e)
		{
			throw Error(path + ": damaged or truncated (rosbag: " + e.what() +
			            "); copy it again, or save what is there with `rosbag reindex`");
		}
	}
	for (const auto& [topic, count] : counts) topics_.push_back({topic.first, topic.second, count});
	std::stable_sort(topics_.begin(), topics_.end(),
	                 [](const RosTopic& a, const RosTopic& b)
	                 { return std::pair(a.name, rank(a.type)) < std::pair(b.name, rank(b.type)); });
}

RosBagFile::~RosBagFile() = default;

std::string RosBagFile::name() const
{
	return paths_.size() == 1 ? paths_.front() : paths_.front() + " and " + std::to_string(paths_.size() - 1) + " more";
}

std::vector<std::string> RosBagFile::notesOnTypes(const std::set<std::string>& topics) const
{
	std::vector<std::string> notes;
	for (const RosTopic& topic : topics_)
		if (const RosTopic* read = findTopic(topics_, topic.name); topics.count(topic.name) > 0 && !isReadAs(topic.type, *read))
			notes.push_back(topic.name + ": of two types, " + read->type + " and " + topic.type +
			                "; left out: " + counted(topic.messages, "message") + " of the latter");
	return notes;
}

void RosBagFile::visit(const std::set<std::string>& topics, const std::function<bool(const rosbag::MessageInstance&)>& visitor) const
{
	try
	{
		const auto wanted = [&](const rosbag::ConnectionInfo* connection)
		{
			const RosTopic* read = topics.count(connection->topic) > 0 ? findTopic(topics_, connection->topic) : nullptr;
			return read != nullptr && isReadAs(connection->datatype, *read);
		};
		rosbag::View view;
		for (const auto& bag : impl_->bags) view.addQuery(*bag, wanted);
		for (const rosbag::MessageInstance& message : view)
			if (!visitor(message)) return;
	}
	catch (const rosbag::BagException& e)
	{
		throw Error(name() + ": damaged (rosbag: " + e.what() + "); copy it again, or save what is there with `rosbag reindex`");
	}
	catch (const ros::serialization::StreamOverrunException& e)
	{
		throw Error(name() + ": a message is cut short or damaged (" + e.what() + "); copy the bag again");
	}
}

void RosBagFile::visitFirst(const std::string& topic, const std::function<void(const rosbag::MessageInstance&)>& visitor) const
{
	visit({topic}, [&](const rosbag::MessageInstance& message) { return visitor(message), false; });
}
}  // namespace viwo
