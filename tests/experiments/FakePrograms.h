#pragma once

#include <viwo/core/Trajectory.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "TempFolder.h"

namespace viwo::testing
{
/** Stand-ins for viwo-sim and viwo-odometry: they write what is asked for in milliseconds, and a line for each call to calls.txt. The truth
 * is a quarter of a circle in 300 s; each estimate is the truth with x scaled by a factor.
 */
class FakePrograms
{
   public:
	explicit FakePrograms(double factor = 1.02)
	{
		Trajectory truth, estimate;
		for (int i = 0; i <= 750; ++i)
		{
			const double angle = 0.5 * M_PI * i / 750;
			StampedPose pose;
			pose.t_ns = 1'700'000'000'000'000'000 + i * int64_t{400'000'000};
			pose.T.p = {30 * std::sin(angle), 30 * (1 - std::cos(angle)), 0};
			truth.push_back(pose);
			pose.T.p.x() *= factor;
			estimate.push_back(pose);
		}
		truth.saveTum(folder_.file("truth.tum"));
		estimate.saveTum(folder_.file("estimate.tum"));
		const std::string output = "for a; do [ \"$previous\" = -o ] && out=\"$a\"; previous=\"$a\"; done\n";
		script("viwo-sim", output + "echo \"sim $*\" >> " + calls() + "\necho log > \"$out\"\ncp " + folder_.file("truth.tum") +
		                       " \"${out%.rawlog}_ground_truth.tum\"\n");
		script("viwo-odometry",
		       output + "echo \"odometry $*\" >> " + calls() + "\n[ -e " + folder_.file("slow") + " ] && sleep 0.3\nif [ -e " +
		           folder_.file("fail") + " ]; then echo 'viwo-odometry: error: told to fail' >&2; exit 1; fi\nif [ -e " +
		           folder_.file("never") + " ] && case \"$*\" in *\"--mode $(cat " + folder_.file("never") +
		           ")\"*) true;; *) false;; esac; then echo '{\"status\": \"initialising\", \"frames\": 751, \"first_pose_s\": null, "
		           "\"initialization_time_s\": null}' > \"$out/summary.json\"; echo 'viwo-odometry: error: no pose' >&2; exit 1; fi\ncp " +
		           folder_.file("estimate.tum") +
		           " \"$out/trajectory.tum\"\necho '{\"first_pose_s\": 0.5, \"initialization_time_s\": 2.0, \"stages_ms\": {\"frame\": "
		           "{\"median\": 20}}}' > \"$out/summary.json\"\n");
	}

	std::string folder() const { return folder_.path(); }
	std::string calls() const { return folder_.file("calls.txt"); }
	/** Calls whose line contains this. */
	int count(const std::string& part) const
	{
		if (!std::filesystem::exists(calls())) return 0;
		std::ifstream file(calls());
		int n = 0;
		for (std::string line; std::getline(file, line);) n += line.find(part) != std::string::npos;
		return n;
	}
	/** Adds a viwo-groundtruth, whose trajectory is the truth and whose map is two bytes. */
	void addGroundTruth()
	{
		script("viwo-groundtruth", "for a; do [ \"$previous\" = -o ] && out=\"$a\"; previous=\"$a\"; done\necho \"groundtruth $*\" >> " +
		                               calls() + "\ncp " + folder_.file("truth.tum") +
		                               " \"$out/trajectory.tum\"\nprintf 'M!' > \"$out/map.png\"\n");
	}
	/** From now on no run of this mode finds a pose. */
	void neverStart(const std::string& mode) { std::ofstream(folder_.file("never")) << mode; }
	/** From now on a run takes a good part of a second. */
	void takeTime() { std::ofstream(folder_.file("slow")) << "x"; }
	/** From now on no log can be made. */
	void failToSimulate() { script("viwo-sim", "echo 'viwo-sim: error: no space' >&2; exit 1\n"); }
	/** From now on (or no longer) every run fails. */
	void fail(bool yes)
	{
		if (yes)
			std::ofstream(folder_.file("fail")) << "x";
		else
			std::filesystem::remove(folder_.file("fail"));
	}

   private:
	void script(const std::string& name, const std::string& body)
	{
		std::ofstream(folder_.file(name)) << "#!/bin/sh\n" << body;
		std::filesystem::permissions(folder_.file(name), std::filesystem::perms::owner_all);
	}

	TempFolder folder_;
};
}  // namespace viwo::testing
