#include <viwo/odometry/OdometryOptions.h>

namespace viwo
{
std::vector<OptionsSection> OdometryOptions::sections()
{
	return {
	    {"rawlog", &rawlog},           {"tracker", &tracker},         {"factors", &estimator.factors},        {"noise", &estimator.noise},
	    {"priors", &estimator.priors}, {"window", &estimator.window}, {"initializer", &estimator.initializer}};
}
}  // namespace viwo
