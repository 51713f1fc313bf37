#pragma once

#include <viwo/core/CameraModel.h>
#include <viwo/core/Pose3.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <random>
#include <vector>

namespace viwo::test
{
/** An endless plane z = depth_m of the world, covered with smooth random blobs, seen by a camera: images whose every point is known. */
class TexturedPlane
{
   public:
	explicit TexturedPlane(double depth_m, uint64_t seed = 1) : depth_m_(depth_m), texture_(kSide, kSide, CV_32F, cv::Scalar(110))
	{
		std::mt19937_64 generator(seed);
		const auto pick = [&](int n) { return static_cast<int>(generator() % static_cast<uint64_t>(n)); };
		for (int i = 0; i < 1500; ++i)
		{
			const cv::Point corner(pick(kSide), pick(kSide)), size(8 + pick(90), 8 + pick(90));
			cv::rectangle(texture_, corner, corner + size, cv::Scalar(40 + pick(140)), cv::FILLED);
		}
		cv::GaussianBlur(texture_, texture_, cv::Size(), 2.5, 2.5, cv::BORDER_REFLECT);
	}

	/** Noise sigma is in grey levels. */
	cv::Mat render(const CameraModel& camera, const Pose3& T_WC, double gain = 1, double noise = 0, uint64_t noise_seed = 1) const
	{
		if (rays_.empty())
			for (int y = 0; y < camera.height_px(); ++y)
				for (int x = 0; x < camera.width_px(); ++x) rays_.push_back(camera.unproject({x, y}));
		std::mt19937_64 generator(noise_seed);
		std::normal_distribution<float> normal(0.f, static_cast<float>(noise));
		cv::Mat image(camera.height_px(), camera.width_px(), CV_8U);
		const Eigen::Matrix3d R_WC = T_WC.R.toRotationMatrix();
		size_t i = 0;
		for (int y = 0; y < image.rows; ++y)
			for (int x = 0; x < image.cols; ++x, ++i)
			{
				const Eigen::Vector3d hit = onPlane(R_WC * rays_[i], T_WC.p);
				float value = static_cast<float>(gain) * sample(hit.x(), hit.y());
				if (noise > 0) value += normal(generator);
				image.at<uint8_t>(y, x) = cv::saturate_cast<uint8_t>(value);
			}
		return image;
	}

	/** The point of the plane seen at a bearing. */
	Eigen::Vector3d pointAt(const Eigen::Vector3d& bearing_C, const Pose3& T_WC) const { return onPlane(T_WC.R * bearing_C, T_WC.p); }

   private:
	static constexpr int kSide = 2048;
	static constexpr double kTexelsPerMetre = 400;

	Eigen::Vector3d onPlane(const Eigen::Vector3d& ray_W, const Eigen::Vector3d& p_WC) const
	{
		return p_WC + ray_W * ((depth_m_ - p_WC.z()) / ray_W.z());
	}

	float sample(double x_m, double y_m) const
	{
		const double u = x_m * kTexelsPerMetre + 1000, v = y_m * kTexelsPerMetre + 1000;
		const double u0 = std::floor(u), v0 = std::floor(v);
		const auto fu = static_cast<float>(u - u0), fv = static_cast<float>(v - v0);
		const auto at = [&](double column, double row)
		{
			return texture_.at<float>(static_cast<int>(static_cast<int64_t>(row) & (kSide - 1)),
			                          static_cast<int>(static_cast<int64_t>(column) & (kSide - 1)));
		};
		return (1 - fv) * ((1 - fu) * at(u0, v0) + fu * at(u0 + 1, v0)) + fv * ((1 - fu) * at(u0, v0 + 1) + fu * at(u0 + 1, v0 + 1));
	}

	double depth_m_;
	cv::Mat texture_;
	mutable std::vector<Eigen::Vector3d> rays_;  //!< of the one camera that this plane is used with
};

inline double medianOf(std::vector<double> values)
{
	if (values.empty()) return std::nan("");
	std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
	return values[values.size() / 2];
}
}  // namespace viwo::test
