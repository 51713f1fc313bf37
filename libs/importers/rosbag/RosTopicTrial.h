#pragma once

#include "RosBagFile.h"

namespace viwo
{
/** proposeTopicMap() of the bag's topics, without those whose first message cannot be converted: what a name cannot tell, an encoding of
 *  pictures or another definition of the type for example. @throws Error: a damaged message. */
RosTopicMap proposeTopicMap(const RosBagFile& bag);
}  // namespace viwo
