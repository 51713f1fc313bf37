#pragma once

#include "RosTopicMap.h"

#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace rosbag
{
class MessageInstance;
}

namespace viwo
{
/** One or several bags as one recording. */
class RosBagFile
{
   public:
	/** @throws Error in one line, see requireReadableBag(). */
	explicit RosBagFile(const std::vector<std::string>& paths);
	~RosBagFile();

	/** Sorted by name. A topic of two types stands once for each, first that which visit() reads. */
	const std::vector<RosTopic>& topics() const { return topics_; }

	/** One line for each of these topics that has messages of a second type, which are not read. */
	std::vector<std::string> notesOnTypes(const std::set<std::string>& topics) const;

	/** "a.bag", or "a.bag and 2 more". */
	std::string name() const;

	/** Messages of these topics in the order of recording; ends early when the visitor gives false. Of a topic of two types only those of
	 *  one are read: that which can become observations.
	 *  @throws Error: a damaged chunk. */
	void visit(const std::set<std::string>& topics, const std::function<bool(const rosbag::MessageInstance&)>& visitor) const;
	/** The first message of one topic, if there is one. */
	void visitFirst(const std::string& topic, const std::function<void(const rosbag::MessageInstance&)>& visitor) const;

   private:
	struct Impl;
	std::unique_ptr<Impl> impl_;
	std::vector<std::string> paths_;
	std::vector<RosTopic> topics_;
};
}  // namespace viwo
