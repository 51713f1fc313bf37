#include "calibration/RigPriors.h"

#include "residuals/BlockAlgebra.h"
#include "residuals/StatePrior.h"

#include <viwo/core/Scalars.h>

#include <memory>

namespace viwo
{
namespace
{
/** The height of the IMU over the floor moves no sensor on a plane: it is what the start says. */
constexpr double kGivenHeight_m = 1e-5;
/** Of its deviation: what is left to a parameter that is held. */
constexpr double kHeldShare = 1e-3;

class Collector
{
   public:
	std::vector<BatchFactor> result;

	/** @param J from the block's tangent to the parameters whose variances these are. */
	void addPose(const Pose3& start, const Eigen::Matrix<double, 6, 6>& J, const Eigen::Matrix<double, 6, 1>& variances, double* block)
	{
		std::array<double, 7> x{};
		poseToBlock(start, x.data());
		const Eigen::Matrix<double, 6, 6> toBlock = J.inverse();
		const Eigen::Matrix<double, 6, 6> covariance = toBlock * variances.asDiagonal() * toBlock.transpose();
		add(StatePrior::fromCovariance(BlockShape::pose(), x.data(), covariance), block);
	}
	void addEuclidean(const Eigen::VectorXd& start, const Eigen::VectorXd& sigmas, double* block)
	{
		add(std::make_shared<StatePrior>(BlockShape::euclidean(static_cast<int>(start.size())), start.data(), sigmas), block);
	}

   private:
	void add(std::shared_ptr<LocalCost> cost, double* block) { result.push_back({{std::move(cost), nullptr, {block}}, BatchGroup::prior}); }
};
}  // namespace

RigVector priorDeviations(const BatchCalibrationOptions& o, const SensorRig& start)
{
	const double turn = o.rotation_deg * kDegree;
	RigVector sigmas;
	sigmas << o.wheel_scale, o.wheel_scale, o.track_relative * start.wheels.track_m, Eigen::Vector3d(o.lever_m, o.lever_m, 0),
	    Eigen::Vector3d::Constant(turn), Eigen::Vector3d::Constant(o.lever_m), Eigen::Vector3d::Constant(turn), o.time_offset_s,
	    o.time_offset_s;
	return sigmas;
}

std::vector<BatchFactor> rigPriors(const SensorRig& start, const BatchCalibrationOptions& options, const RigFlags& held, BatchStates& s)
{
	RigVector sigmas = priorDeviations(options, start);
	for (int i = 0; i < RigOrder::size; ++i)
		if (held[i]) sigmas[i] *= kHeldShare;
	sigmas[RigOrder::imu_lever + 2] = kGivenHeight_m;
	const RigVector variances = sigmas.cwiseAbs2();
	// A turn of the IMU moves the camera's lever arm as well, but less than it is known.
	const RigJacobian J = rigJacobian(start);
	constexpr int imu = RigOrder::imu_lever, camera = RigOrder::camera_lever;
	const WheelIntrinsics& k = start.wheels;

	Collector c;
	c.addPose(start.T_BO, J.block<6, 6>(imu, imu), variances.segment<6>(imu), s.T_BO.data());
	c.addPose(start.T_BC, J.block<6, 6>(camera, camera), variances.segment<6>(camera), s.T_BC.data());
	c.addEuclidean(Eigen::Vector3d(k.k_left, k.k_right, k.track_m), sigmas.head<3>(), s.wheels.data());
	c.addEuclidean(Eigen::VectorXd::Constant(1, start.camera_offset_s), sigmas.segment<1>(RigOrder::camera_offset),
	               s.camera_offset_s.data());
	c.addEuclidean(Eigen::VectorXd::Constant(1, start.wheel_offset_s), sigmas.segment<1>(RigOrder::wheel_offset), s.wheel_offset_s.data());
	return std::move(c.result);
}
}  // namespace viwo
