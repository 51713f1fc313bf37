#include "Relations.h"

#include <viwo/app/Program.h>
#include <viwo/core/Scalars.h>
#include <viwo/evaluation/RelationErrors.h>
#include <viwo/evaluation/Table.h>

#include <cstdio>
#include <iostream>

namespace viwo
{
namespace
{
void addRow(Table& table, const std::string& frame, const RelationErrors& e)
{
	const RelationFigures &t = e.translation_m, &r = e.rotation_deg;
	table.addRow({frame, std::to_string(e.evaluated) + "/" + std::to_string(e.relations), fixed(t.mean, 4), fixed(t.deviation, 4),
	              fixed(t.max, 3), fixed(r.mean, 3), fixed(r.deviation, 3), fixed(r.max, 2)});
}
}  // namespace

CLI::App* declareRelations(CLI::App& cli, RelationArguments& a)
{
	CLI::App* relations =
	    cli.add_subcommand("relations", "Relation error (Kuemmerle et al.) of a trajectory against measured relative poses");
	relations->add_option("-r,--relations", a.relations, "Lines t1 t2 x y z roll pitch yaw: the pose at t2 seen from that at t1")
	    ->type_name("FILE")
	    ->required();
	relations->add_option("-e,--estimate", a.trajectory, "Estimated trajectory (TUM)")->type_name("FILE.tum")->required();
	relations
	    ->add_option("--stamps", a.stamps,
	                 "X_stamps.csv of the import: the relations have original stamps, the trajectory those of the rawlog")
	    ->type_name("FILE.csv");
	relations
	    ->add_option(
	        "--sensor", a.sensor,
	        "Evaluate a second frame beside O: x (m), y (m), yaw (deg) of a sensor on the robot, between whose poses the relations are")
	    ->expected(3)
	    ->check(app::finite());
	relations->add_option("--json", a.json, "Write the figures to this file too")->type_name("FILE.json");
	return relations;
}

int evaluateRelations(const RelationArguments& a)
{
	const std::vector<Relation> relations = loadRelations(a.relations);
	const Trajectory trajectory = Trajectory::loadTum(a.trajectory);
	RelationOptions options;
	if (!a.stamps.empty()) options.stamps = loadStampTable(a.stamps);
	const auto evaluated = [&]
	{
		try
		{
			return relationErrors(relations, trajectory, options);
		}
		catch (const Error& e)
		{
			throw Error(a.trajectory + " against " + a.relations + ": " + e.what());
		}
	};

	Table table(
	    {{"frame", "", true}, {"relations", ""}, {"trans", "m"}, {"+-", "m"}, {"max", "m"}, {"rot", "deg"}, {"+-", "deg"}, {"max", "deg"}});
	Json json = {{"relations_file", a.relations}, {"estimate", a.trajectory}};
	const RelationErrors in_O = evaluated();
	addRow(table, "O", in_O);
	json.update(toJson(in_O));
	if (!a.sensor.empty())
	{
		options.T_OS = Pose3(Eigen::Quaterniond(Eigen::AngleAxisd(a.sensor[2] * kDegree, Eigen::Vector3d::UnitZ())),
		                     Eigen::Vector3d(a.sensor[0], a.sensor[1], 0));
		const RelationErrors in_S = evaluated();
		addRow(table, "sensor", in_S);
		json["sensor"] = toJson(in_S);
		json["sensor"]["pose_m_m_deg"] = a.sensor;
	}
	std::cout << table.toText() << std::flush;
	if (in_O.evaluated < in_O.relations)
		std::fprintf(stderr,
		             "viwo-evaluate: warning: only %zu of %zu relations were evaluated: the others have no pose at their times in %s%s\n",
		             in_O.evaluated, in_O.relations, a.trajectory.c_str(),
		             a.stamps.empty() ? "; a log with repaired stamps needs its table (--stamps)" : "");
	if (!a.json.empty()) saveJson(a.json, json);
	return 0;
}
}  // namespace viwo
