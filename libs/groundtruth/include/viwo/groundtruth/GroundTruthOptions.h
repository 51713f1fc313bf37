#pragma once

#include <viwo/core/Options.h>

namespace viwo::gt
{
/** Section [scan]: which beams are used. */
struct ScanOptions : Options<ScanOptions>
{
	double min_range_m = 0.1;
	double max_range_m = 40;
	double first_angle_deg = -180;
	double last_angle_deg = 180;
	double scan_duration_s = 0;
	double stamp_position = 0;
	double range_noise_m = 0;

	template <class Visitor>
	void visit(Visitor& v)
	{
		v("min_range_m", min_range_m, "nearer returns are not used (the robot itself)", 0.0, 100.0);
		v("max_range_m", max_range_m, "farther returns are not used", 0.1, 1000.0);
		v("first_angle_deg", first_angle_deg, "beams to the right of this angle in the sensor are not used", -180.0, 180.0);
		v("last_angle_deg", last_angle_deg, "beams to the left of this angle in the sensor are not used", -180.0, 180.0);
		v("scan_duration_s", scan_duration_s, "from the first to the last beam; 0: all at once", 0.0, 1.0);
		v("stamp_position", stamp_position, "where in the sweep the stamp lies: 0 first beam, 1 last", 0.0, 1.0);
		v("range_noise_m", range_noise_m, "standard deviation of a range; 0: estimated from the scans", 0.0, 10.0);
	}
};

/** Section [matching]: registration of scans, key scans. */
struct MatchingOptions : Options<MatchingOptions>
{
	double key_distance_m = 0.25;
	double key_angle_deg = 12;
	int local_map_keys = 40;
	double local_map_way_m = 30;
	double min_inlier_ratio = 0.55;
	double min_weakest = 0.05;
	double search_distance_m = 0.8;
	double search_angle_deg = 40;

	template <class Visitor>
	void visit(Visitor& v)
	{
		v("key_distance_m", key_distance_m, "a scan becomes a key scan after this way", 0.01, 10.0);
		v("key_angle_deg", key_angle_deg, "or after this turn", 0.5, 180.0);
		v("local_map_keys", local_map_keys, "key scans in the local map", 1, 1000);
		v("local_map_way_m", local_map_way_m, "the local map holds key scans of this last part of the way, the nearest first", 0.1, 1000.0);
		v("min_inlier_ratio", min_inlier_ratio, "matched fraction of a scan below which its registration is not trusted", 0.0, 1.0);
		v("min_weakest", min_weakest, "information in the weakest direction, 0 to 0.5: below it a registration is degenerate", 0.0, 0.5);
		v("search_distance_m", search_distance_m, "half width of the search where the guess from odometry is poor", 0.0, 10.0);
		v("search_angle_deg", search_angle_deg, "half width of that search", 0.0, 180.0);
	}
};

/** Section [odometry]: how far a motion between two scans is trusted. */
struct MotionNoiseOptions : Options<MotionNoiseOptions>
{
	double distance_per_m = 0.1;
	double distance_per_rad = 0.03;
	double angle_per_rad = 0.1;
	double angle_deg_per_m = 2;
	double gyro_deg_per_sqrt_s = 0.038;
	double gyro_bias_walk_deg_s = 1e-3;
	bool use_imu = true;

	template <class Visitor>
	void visit(Visitor& v)
	{
		v("distance_per_m", distance_per_m, "standard deviation of the way, m per m", 1e-4, 10.0);
		v("distance_per_rad", distance_per_rad, "m per rad of turn", 0.0, 10.0);
		v("angle_per_rad", angle_per_rad, "standard deviation of the turn, rad per rad", 1e-4, 10.0);
		v("angle_deg_per_m", angle_deg_per_m, "deg per m of way", 0.0, 90.0);
		v("gyro_deg_per_sqrt_s", gyro_deg_per_sqrt_s, "of a turn measured by the gyroscope", 1e-4, 90.0);
		v("gyro_bias_walk_deg_s", gyro_bias_walk_deg_s, "of its bias, deg/s after a second, growing with the square root of time", 1e-7,
		  1.0);
		v("use_imu", use_imu, "take turns from the gyroscope where there is one");
	}
};

/** Section [loops]: loop closure. */
struct LoopOptions : Options<LoopOptions>
{
	bool enabled = true;
	double submap_m = 2.5;
	double query_reach_m = 1.5;
	double submap_reach_m = 6;
	double drift_per_m = 0.025;
	double drift_deg_per_m = 0.4;
	double max_search_m = 6;
	double max_search_deg = 35;
	double min_score = 0.65;
	double min_inlier_ratio = 0.7;
	int max_candidates = 4;

	template <class Visitor>
	void visit(Visitor& v)
	{
		v("enabled", enabled, "false: no loops are looked for");
		v("submap_m", submap_m, "way between submaps", 0.1, 100.0);
		v("query_reach_m", query_reach_m, "what is looked for holds the key scans this far before and behind", 0.0, 100.0);
		v("submap_reach_m", submap_reach_m, "a submap holds the key scans this far before and behind", 0.1, 100.0);
		v("drift_per_m", drift_per_m, "how fast a position becomes uncertain, m per m", 0.0, 1.0);
		v("drift_deg_per_m", drift_deg_per_m, "how fast a heading becomes uncertain", 0.0, 90.0);
		v("max_search_m", max_search_m, "largest half width of a search", 0.1, 100.0);
		v("max_search_deg", max_search_deg, "largest half width of a search", 1.0, 180.0);
		v("min_score", min_score, "correlation above which a match is looked at, 0 to 1", 0.0, 1.0);
		v("min_inlier_ratio", min_inlier_ratio, "matched fraction that a loop needs", 0.0, 1.0);
		v("max_candidates", max_candidates, "submaps tried for each submap", 1, 100);
	}
};

/** Section [graph]: joint optimisation. */
struct GraphOptions : Options<GraphOptions>
{
	int rounds = 4;
	int neighbours = 14;
	double neighbour_distance_m = 5;
	double inflation = 10;
	double odometry_weight = 0.01;
	double odometry_weight_degenerate = 1;
	bool odometry_edges = true;
	double good_deviation_m = 0.025;
	double good_deviation_per_m = 0.005;

	template <class Visitor>
	void visit(Visitor& v)
	{
		v("rounds", rounds, "of pairwise registration and optimisation of all key scans", 1, 50);
		v("neighbours", neighbours, "key scans that each key scan is registered with", 1, 200);
		v("neighbour_distance_m", neighbour_distance_m, "these lie at most this far away", 0.1, 100.0);
		v("inflation", inflation, "of the covariance of a registration: points of a scan are not independent", 1.0, 1e4);
		v("odometry_weight", odometry_weight, "factor on the information of odometry where scans hold the pose", 0.0, 100.0);
		v("odometry_weight_degenerate", odometry_weight_degenerate, "the same where they leave a direction open", 0.0, 100.0);
		v("odometry_edges", odometry_edges,
		  "false: the graph is of scans alone (where they say nothing, odometry still holds them, weakly)");
		v("good_deviation_m", good_deviation_m, "a pose is good if its reported standard deviation is at most this", 0.001, 1e6);
		v("good_deviation_per_m", good_deviation_per_m, "or this for each metre from the first pose", 0.0, 1.0);
	}
};

/** All sections. */
struct GroundTruthOptions
{
	ScanOptions scan;
	MatchingOptions matching;
	MotionNoiseOptions odometry;
	LoopOptions loops;
	GraphOptions graph;

	std::vector<OptionsSection> sections()
	{
		return {{"scan", &scan}, {"matching", &matching}, {"odometry", &odometry}, {"loops", &loops}, {"graph", &graph}};
	}
};
}  // namespace viwo::gt
