#include "KittiCalibration.h"

#include "CsvFile.h"

#include <viwo/core/Error.h>
#include <viwo/core/NumberText.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <vector>

namespace viwo
{
namespace
{
namespace fs = std::filesystem;

/** "key: number number ..." a line. */
class KittiFile
{
   public:
	KittiFile(const std::string& folder, const std::string& name)
	{
		std::error_code ignored;
		fs::path path = fs::path(folder) / name;
		if (!fs::exists(path, ignored)) path = fs::absolute(fs::path(folder), ignored).lexically_normal() / ".." / name;
		path_ = path.lexically_normal().string();
		std::ifstream file(path);
		if (!file)
			throw Error((fs::path(folder) / name).string() + ": missing, here and in the folder above; it belongs to the drive's date");
		for (std::string line; std::getline(file, line);)
		{
			const size_t colon = line.find(':');
			if (colon != std::string::npos) values_[line.substr(0, colon)] = line.substr(colon + 1);
		}
	}

	bool has(const std::string& key) const { return values_.count(key) > 0; }

	std::vector<double> numbers(const std::string& key, size_t count) const
	{
		if (!has(key)) throw Error(path_ + ": " + key + ": missing");
		std::vector<double> numbers;
		for (const std::string& word : splitWords(values_.at(key))) numbers.push_back(parseNumber(word, path_ + ": " + key));
		if (numbers.size() != count)
			throw Error(path_ + ": " + key + ": " + counted(numbers.size(), "number") + " instead of " + std::to_string(count));
		return numbers;
	}

	Eigen::Matrix3d matrix(const std::string& key) const
	{
		const auto v = numbers(key, 9);
		Eigen::Matrix3d M;
		M << v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7], v[8];
		return M;
	}

	/** The files have seven digits, so rotations need normalising. */
	Eigen::Quaterniond rotation(const std::string& key) const
	{
		const Eigen::Matrix3d R = matrix(key);
		if ((R * R.transpose() - Eigen::Matrix3d::Identity()).norm() > 1e-3 || R.determinant() < 0)
			throw Error(path_ + ": " + key + ": not a rotation");
		return Eigen::Quaterniond(R).normalized();
	}

	Pose3 pose() const
	{
		const auto T = numbers("T", 3);
		return {rotation("R"), Eigen::Vector3d(T[0], T[1], T[2])};
	}

	std::pair<int, int> size(const std::string& key) const
	{
		const auto S = numbers(key, 2);
		return {static_cast<int>(std::lround(S[0])), static_cast<int>(std::lround(S[1]))};
	}

	const std::string& path() const { return path_; }

   private:
	std::string path_;
	std::map<std::string, std::string> values_;
};

CameraModel recordedCamera(const KittiFile& file, std::pair<int, int> size)
{
	const Eigen::Matrix3d K = file.matrix("K_00");
	const auto d = file.numbers("D_00", 5);
	return {
	    size.first, size.second, K(0, 0), K(1, 1), K(0, 2), K(1, 2), CameraModel::Distortion::plumb_bob, {d[0], d[1], d[2], d[3], d[4]}};
}

CameraModel rectifiedCamera(const KittiFile& file, std::pair<int, int> size)
{
	const auto P = file.numbers("P_rect_00", 12);
	return {size.first, size.second, P[0], P[5], P[2], P[6]};
}
}  // namespace

KittiCalibration readKittiCalibration(const std::string& folder, std::pair<int, int> image_size)
{
	const KittiFile cameras(folder, "calib_cam_to_cam.txt");
	const Pose3 T_CV = KittiFile(folder, "calib_velo_to_cam.txt").pose();
	const Pose3 T_VI = KittiFile(folder, "calib_imu_to_velo.txt").pose();
	KittiCalibration calibration;
	calibration.T_IC = (T_CV * T_VI).inverse();
	if (cameras.size("S_00") == image_size)
	{
		calibration.camera = recordedCamera(cameras, image_size);
		return calibration;
	}
	if (!cameras.has("S_rect_00") || cameras.size("S_rect_00") != image_size)
		throw Error(cameras.path() + ": S_00: the images are " + std::to_string(image_size.first) + "x" +
		            std::to_string(image_size.second) + " pixels, which is neither the recorded size nor S_rect_00");
	calibration.camera = rectifiedCamera(cameras, image_size);
	// A point in the rectified camera is R_rect_00 times the point in camera 0.
	const Pose3 T_rect_C(cameras.rotation("R_rect_00"), Eigen::Vector3d::Zero());
	calibration.T_IC = calibration.T_IC * T_rect_C.inverse();
	return calibration;
}
}  // namespace viwo
