#pragma once

#include <viwo/core/Options.h>

#include <string>

namespace viwo::sim
{
/** A drive to repeat an experiment with: which world, route and rig belong together. */
struct Sequence : Options<Sequence>
{
	std::string world, route, rig;  //!< names of files of share/viwo, without ".ini"

	template <class Visitor>
	void visit(Visitor& v)
	{
		v("world", world, "a file of share/viwo/worlds");
		v("route", route, "a file of share/viwo/routes");
		v("rig", rig, "a file of share/viwo/rigs");
	}

	/** Section [sequence] of the file. @throws Error that names the file for a key that is unknown or missing. */
	static Sequence load(const std::string& ini_path);
};
}  // namespace viwo::sim
