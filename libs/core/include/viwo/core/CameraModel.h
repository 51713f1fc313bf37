#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

namespace viwo
{
/** Central camera: pinhole with the lens distortion of OpenCV's plumb_bob (k1 k2 p1 p2 k3) or kannala_brandt (k1 k2 k3 k4).
 *  Pixel centres are at integer coordinates, as in OpenCV and MRPT.
 */
class CameraModel
{
   public:
	enum class Distortion
	{
		none,
		plumb_bob,
		kannala_brandt
	};

	CameraModel() = default;
	CameraModel(int width_px, int height_px, double fx_px, double fy_px, double cx_px, double cy_px,
	            Distortion distortion = Distortion::none, const std::array<double, 5>& coefficients = {});

	/** Pixel of a point P_C (metres, optical frame); nothing where it lies behind the camera, or beyond the angle at which the
	 *  polynomial turns back on itself. The pixel may be outside of the image: see contains().
	 */
	std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& P_C) const;

	/** Unit ray of a pixel, by Newton iterations to 1e-12 on the normalised plane. For a pixel farther out than the lens polynomial
	 * reaches, the ray at its turning point.
	 */
	Eigen::Vector3d unproject(const Eigen::Vector2d& pixel) const;

	bool contains(const Eigen::Vector2d& pixel, double border_px = 0) const;

	int width_px() const { return width_px_; }
	int height_px() const { return height_px_; }
	double fx_px() const { return fx_px_; }
	double fy_px() const { return fy_px_; }
	double cx_px() const { return cx_px_; }
	double cy_px() const { return cy_px_; }
	double meanFocal_px() const { return 0.5 * (fx_px_ + fy_px_); }
	Distortion distortion() const { return distortion_; }
	const std::array<double, 5>& coefficients() const { return coefficients_; }

   private:
	Eigen::Vector2d distort(const Eigen::Vector2d& normalised) const;
	void findTurningPoint();

	int width_px_ = 0, height_px_ = 0;
	double fx_px_ = 0, fy_px_ = 0, cx_px_ = 0, cy_px_ = 0;
	Distortion distortion_ = Distortion::none;
	std::array<double, 5> coefficients_{};
	double max_radius_ = 0;  //!< of the undistorted normalised plane, up to which r_d(r) increases
};
}  // namespace viwo
