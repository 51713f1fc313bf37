#include <viwo/core/Error.h>
#include <viwo/sim/Sequence.h>

namespace viwo::sim
{
Sequence Sequence::load(const std::string& ini_path)
{
	Sequence sequence;
	loadOptions(ini_path, {{"sequence", &sequence}});
	for (const auto& [key, value] :
	     {std::pair("world", &sequence.world), std::pair("route", &sequence.route), std::pair("rig", &sequence.rig)})
		if (value->empty())
			throw Error(ini_path + ": [sequence] " + key + " is missing; give the name of a file of share/viwo/" + key + "s");
	return sequence;
}
}  // namespace viwo::sim
