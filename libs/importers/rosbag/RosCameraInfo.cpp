#include "RosInstance.h"
#include "RosMessages.h"

#include <sensor_msgs/CameraInfo.h>

#include <algorithm>
#include <array>

namespace viwo
{
namespace
{
CameraModel::Distortion distortionOf(const sensor_msgs::CameraInfo& info, const std::string& topic)
{
	if (std::all_of(info.D.begin(), info.D.end(), [](double d) { return d == 0; })) return CameraModel::Distortion::none;
	const std::string& name = info.distortion_model;
	if ((name == "equidistant" || name == "fisheye") && info.D.size() == 4) return CameraModel::Distortion::kannala_brandt;
	const bool is_polynomial = name == "plumb_bob" || name == "radtan" || name == "rational_polynomial" || name.empty();
	const bool fits = std::all_of(info.D.begin() + static_cast<std::ptrdiff_t>(std::min<size_t>(5, info.D.size())), info.D.end(),
	                              [](double d) { return d == 0; });
	if (is_polynomial && fits) return CameraModel::Distortion::plumb_bob;
	throw UnusableTopic(topic, "lens model '" + name + "' with " + std::to_string(info.D.size()) + " coefficients is not supported",
	                    "calibrate with plumb_bob (5) or equidistant (4), or leave camera_info out of the --map");
}
}  // namespace

std::optional<CameraModel> readCameraInfo(const rosbag::MessageInstance& message, bool rectified)
{
	const auto info = instance<sensor_msgs::CameraInfo>(message);
	// P = [K' t] has a fourth column.
	const double fx = rectified ? info->P[0] : info->K[0], fy = rectified ? info->P[5] : info->K[4];
	const double cx = rectified ? info->P[2] : info->K[2], cy = rectified ? info->P[6] : info->K[5];
	if (!(fx > 0) || !(fy > 0)) return std::nullopt;

	const auto& roi = info->roi;
	const uint32_t bin_x = std::max(1u, info->binning_x), bin_y = std::max(1u, info->binning_y);
	const int width = static_cast<int>((roi.width > 0 ? roi.width : info->width) / bin_x);
	const int height = static_cast<int>((roi.height > 0 ? roi.height : info->height) / bin_y);
	// Pixel centres are at integers: the corner of the picture is at -0.5.
	const auto binned = [](double c, uint32_t offset, uint32_t bin) { return (c - offset + 0.5) / bin - 0.5; };
	const auto distortion = rectified ? CameraModel::Distortion::none : distortionOf(*info, message.getTopic());
	std::array<double, 5> coefficients{};
	if (distortion != CameraModel::Distortion::none)
		std::copy_n(info->D.begin(), std::min<size_t>(5, info->D.size()), coefficients.begin());
	return CameraModel(width, height, fx / bin_x, fy / bin_y, binned(cx, roi.x_offset, bin_x), binned(cy, roi.y_offset, bin_y), distortion,
	                   coefficients);
}
}  // namespace viwo
