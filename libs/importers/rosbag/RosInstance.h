#pragma once

#include "RosLayout.h"

#include <rosbag/message_instance.h>
#include <viwo/core/Error.h>

#include <string>

namespace viwo
{
/** Nothing is damaged, but messages like this one cannot become observations. */
class UnusableTopic : public Error
{
   public:
	explicit UnusableTopic(const std::string& topic, const std::string& why, const std::string& remedy = "leave the topic out by a --map")
	    : Error(topic + ": " + why + "; " + remedy), why_(why)
	{
	}
	const std::string& why() const { return why_; }

   private:
	std::string why_;
};

/** The message as a type. @throws UnusableTopic where the bag's definition of it differs (its MD5 sum), Error where its lengths are
 *  damaged. */
template <class Message>
boost::shared_ptr<Message> instance(const rosbag::MessageInstance& message)
{
	if (!message.isType<Message>())
		throw UnusableTopic(message.getTopic(),
		                    message.getDataType() + " with MD5 sum " + message.getMD5Sum() + " is another definition than this program's");
	requireSoundLengths(message);
	return message.instantiate<Message>();
}

template <class Stamp>
int64_t stamp_ns(const Stamp& stamp)
{
	return static_cast<int64_t>(stamp.toNSec());
}
}  // namespace viwo
