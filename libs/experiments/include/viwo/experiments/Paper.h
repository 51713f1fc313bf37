#pragma once

#include <string>
#include <vector>

/** Figures that Niu et al. print (Sec. 7), to stand beside ours. NaN where they print a dash. @file */
namespace viwo::experiments
{
/** RMSE of the ATE, m (Table 1). */
struct PaperAte
{
	double xy_m, z_m, xyz_m;
};

/** A row of Table 2 or 3 and its printed average. */
struct PaperRow
{
	std::vector<double> values;
	double average;
};

/** What the paper prints about one of its sequences. */
struct PaperSequence
{
	std::string name;
	double length_m;
	std::string motion;
	PaperAte vio, wheel, viwo;         //!< Table 1: VINS-Mono, Wheel encoder, Our system
	std::vector<double> starts_s;      //!< columns of Tables 2 and 3
	PaperRow vins_time_s, own_time_s;  //!< Table 2
	PaperRow vins_rmse_m, own_rmse_m;  //!< Table 3
};

/** seq01 to seq06. */
const std::vector<PaperSequence>& paperSequences();

/** @throws Error that lists the names there are. */
const PaperSequence& paperSequence(const std::string& name);
}  // namespace viwo::experiments
