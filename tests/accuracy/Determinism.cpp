#include "Groups.h"

#include <fstream>
#include <iterator>

#include "Drives.h"

namespace viwo::accuracy
{
namespace
{
RunRecipe first()
{
	return runsOf(corridorDrive(), 1).front();
}
RunRecipe second()
{
	return runsOf(corridorDrive(), 1, "viwo", "again").front();
}
RunRecipe besideLoad()
{
	RunRecipe run = runsOf(corridorDrive(), 1, "viwo", "loaded").front();
	run.loaded = true;
	return run;
}

std::string contentOf(const std::string& path)
{
	std::ifstream file(path, std::ios::binary);
	if (!file) throw Error(path + ": cannot be read");
	return {std::istreambuf_iterator<char>(file), {}};
}

/** How many of the files differ between two runs. */
Row compare(const std::string& name, const Outcome& a, const Outcome& b)
{
	if (a.failed() || b.failed()) throw Error(a.error + b.error);
	double different = 0;
	std::string detail;
	for (const char* file : {"trajectory.tum", "trajectory_imu_rate.tum", "trajectory_covariance.csv", "landmarks.ply"})
	{
		const bool same = contentOf(a.file(file)) == contentOf(b.file(file));
		if (!same) ++different;
		detail += (detail.empty() ? "" : ", ") + std::string(file) + (same ? "" : " (differs)");
	}
	return atMost(name, different, 0, "", detail);
}

class Determinism : public Group
{
   public:
	using Group::Group;
	std::vector<std::string> bars() const override;
	void plan(Runner& runner) const override;
	std::vector<Row> judge(const Runner& runner) const override;
};

std::vector<std::string> Determinism::bars() const
{
	return {"same rawlog twice: files that differ", "same rawlog beside a busy machine: files that differ"};
}

void Determinism::plan(Runner& runner) const
{
	for (const RunRecipe& run : {first(), second(), besideLoad()}) runner.want(run);
}

std::vector<Row> Determinism::judge(const Runner& runner) const
{
	return {compare(bars()[0], runner.outcome(first()), runner.outcome(second())),
	        compare(bars()[1], runner.outcome(first()), runner.outcome(besideLoad()))};
}
}  // namespace

std::unique_ptr<Group> determinism(const Settings& settings)
{
	return std::make_unique<Determinism>(settings);
}
}  // namespace viwo::accuracy
