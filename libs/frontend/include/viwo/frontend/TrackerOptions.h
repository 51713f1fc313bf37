#pragma once

#include <viwo/core/Options.h>

#include <string>

namespace viwo
{
/** How corners are found and followed. Lengths are pixels of the full image. */
struct TrackerOptions : Options<TrackerOptions>
{
	int max_features = 150;
	double min_distance_px = 18;
	double quality = 0.003;
	double min_response = 4e-5;
	int grid_columns = 8;
	int grid_rows = 6;
	int border_px = 8;

	int pyramid_levels = 3;
	int window_px = 21;
	int max_iterations = 30;
	double epsilon_px = 0.01;
	double min_eigenvalue = 1e-4;
	double forward_backward_px = 0.5;

	int reference_px = 21;
	double reference_correlation = 0.8;
	double reference_shift_px = 1.0;

	double ransac_px = 1.5;
	double rotation_tolerance_rad = 2e-3;
	int ransac_iterations = 100;
	int seed = 1;

	bool gain_compensation = true;
	bool clahe = false;
	double clahe_clip = 3;
	double dark_level = 12;
	double overexposed_share = 0.9;

	std::string mask_path;

	template <class Visitor>
	void visit(Visitor& v)
	{
		v("max_features", max_features, "corners followed at a time", 10, 2000);
		v("min_distance_px", min_distance_px, "smallest distance between two corners when they are chosen", 2.0, 200.0);
		v("quality", quality, "a corner's response over that of the best one in the image, at least", 0.0, 1.0);
		v("min_response", min_response,
		  "a corner's response, at least: smaller eigenvalue of (2 x gradient / 255)^2 on the half-size image", 0.0, 1.0);
		v("grid_columns", grid_columns, "cells over which the corners are spread, across", 1, 64);
		v("grid_rows", grid_rows, "cells over which the corners are spread, down", 1, 64);
		v("border_px", border_px, "strip along the image's edge without corners", 1, 200);
		v("pyramid_levels", pyramid_levels, "image halvings of the optical flow", 1, 6);
		v("window_px", window_px, "side of the optical flow's window", 5, 61);
		v("max_iterations", max_iterations, "optical flow iterations per level", 1, 200);
		v("epsilon_px", epsilon_px, "optical flow ends when a step is below this", 1e-4, 1.0);
		v("min_eigenvalue", min_eigenvalue, "a window with less texture than this is not followed (OpenCV's minEigThreshold)", 0.0, 1.0);
		v("forward_backward_px", forward_backward_px, "a corner followed there and back again must return to within this", 0.01, 20.0);
		v("reference_px", reference_px,
		  "side of the patch that is kept of a corner's first sight, odd; 0: corners are followed from image to image alone", 0, 61);
		v("reference_correlation", reference_correlation, "a corner that is less like its first sight than this is lost", 0.0, 1.0);
		v("reference_shift_px", reference_shift_px, "and so is one that optical flow and its first sight put this far apart", 0.05, 20.0);
		v("ransac_px", ransac_px, "largest distance from the epipolar line", 0.1, 50.0);
		v("rotation_tolerance_rad", rotation_tolerance_rad,
		  "error of the predicted rotation over one frame that the epipolar gate allows for", 0.0, 0.1);
		v("ransac_iterations", ransac_iterations, "hypotheses of the epipolar gate", 1, 10000);
		v("seed", seed, "of the epipolar gate's random generator", 0);
		v("gain_compensation", gain_compensation, "match the brightness of the previous image to the new one before following");
		v("clahe", clahe, "equalise the histogram locally (CLAHE) before anything else");
		v("clahe_clip", clahe_clip, "contrast limit of CLAHE", 0.1, 100.0);
		v("dark_level", dark_level, "an image whose 95th percentile is below this grey level is unusable", 0.0, 255.0);
		v("overexposed_share", overexposed_share, "an image with more than this share of saturated pixels is unusable", 0.0, 1.0);
		v("mask_path", mask_path, "image that is black where corners must not be (the robot's own parts); none when empty");
	}
};
}  // namespace viwo
