#pragma once

#include "RosLayout.h"

#include <rosbag/message_instance.h>
#include <viwo/core/Error.h>

#include <string>

namespace viwo
{
/** The message as a type. @throws Error where the bag's definition of it differs (its MD5 sum), or its lengths are damaged. */
template <class Message>
boost::shared_ptr<Message> instance(const rosbag::MessageInstance& message)
{
	if (!message.isType<Message>())
		throw Error(message.getTopic() + ": " + message.getDataType() + " with MD5 sum " + message.getMD5Sum() +
		            " is another definition than this program's; leave the topic out by a --map");
	requireSoundLengths(message);
	return message.instantiate<Message>();
}

template <class Stamp>
int64_t stamp_ns(const Stamp& stamp)
{
	return static_cast<int64_t>(stamp.toNSec());
}
}  // namespace viwo
