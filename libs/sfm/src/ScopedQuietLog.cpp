#include <glog/logging.h>
#include <viwo/sfm/ScopedQuietLog.h>

namespace viwo
{
ScopedQuietLog::ScopedQuietLog() : previous_level_(FLAGS_minloglevel)
{
	FLAGS_minloglevel = google::GLOG_ERROR;
}

ScopedQuietLog::~ScopedQuietLog()
{
	FLAGS_minloglevel = previous_level_;
}
}  // namespace viwo
