#include "VisionStart.h"
namespace viwo
{
bool startFromVision(Window&, IntervalFactory&, const Pose3&) { return false; }
}
