#pragma once

#include <ConstantTwist.h>
#include <NumericJacobian.h>

#include <Marginalizer.h>
#include <StateOrder.h>
#include <residuals/GaugePrior.h>
#include <residuals/ImuResidual.h>
#include <residuals/ReprojectionResidual.h>
#include <residuals/StatePrior.h>
#include <residuals/WheelResidual.h>

#include <deque>
#include <limits>
#include <memory>
#include <vector>

namespace viwo::test
{
/** A drive on an arc with camera, IMU and wheels: states near the truth, measurements with noise, and the factors that a sliding window
 *  would hold. Landmarks are anchored in the frame that sees them first and seen in the next `track_length` ones. */
class SyntheticWindow
{
   public:
	static constexpr double frame_s = 0.4, sigma_rad = 1.0 / 460;

	/** @param state_noise scale of the states' distance from the truth. */
	SyntheticWindow(int frames, int landmarks_per_frame, int track_length, unsigned seed, double state_noise = 1) : random_(seed)
	{
		motion_.T_BO = {so3::expQuaternion(Eigen::Vector3d(0.1, 0.2, -1)), Eigen::Vector3d(-0.2, 0.1, -0.3)};
		motion_.b_a = random_.vector3(0.05);
		motion_.b_g = random_.vector3(0.01);
		T_BC_truth_ = motion_.T_BO * Pose3(forwardOpticalAxes(), Eigen::Vector3d(0.1, 0, 0.2));
		T_BC = block(posePlus(T_BC_truth_, state_noise * random_.vector(6, 2e-3)));
		intrinsics = {1 + 0.005 * state_noise, 1 - 0.005 * state_noise, 0.23};
		for (int k = 0; k < frames; ++k) addFrame(k, state_noise);
		for (int k = 0; k + 1 < frames; ++k) addMotionFactors(k);
		for (int k = 0; k + 1 < frames; ++k)
			for (int l = 0; l < landmarks_per_frame; ++l) addLandmark(k, std::min(k + track_length, frames - 1), state_noise);
	}

	/** Everything that frame k takes with it when it is the oldest: factors on it and on the landmarks anchored in it. */
	std::vector<Factor> factorsOf(int k) const
	{
		std::vector<Factor> result;
		for (const Entry& entry : entries_)
			if (entry.frame == k) result.push_back(entry.factor);
		return result;
	}
	/** Factors of frame k and later ones. */
	std::vector<Factor> factorsFrom(int k) const
	{
		std::vector<Factor> result;
		for (const Entry& entry : entries_)
			if (entry.frame >= k) result.push_back(entry.factor);
		return result;
	}
	std::vector<double*> landmarksOf(int k)
	{
		std::vector<double*> result;
		for (Landmark& landmark : landmarks)
			if (landmark.frame == k) result.push_back(&landmark.lambda);
		return result;
	}

	Factor gaugePrior() const
	{
		const Pose3 T_WB0 = poseFromBlock(poses[0].data());
		return {std::make_shared<GaugePrior>(T_WB0, Eigen::Vector3d::Zero(), 1e-4, 1e-5), nullptr, {const_cast<double*>(poses[0].data())}};
	}
	/** On the biases of the first frame, T_BC and the wheel intrinsics, as at the start of a drive; none says anything about the gauge (one
	 * on the velocity would, as that is in W's axes). */
	std::vector<Factor> startPriors()
	{
		Eigen::VectorXd motion(9), extrinsics(6);
		motion << Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()), Eigen::Vector3d::Constant(0.1),
		    Eigen::Vector3d::Constant(0.01);
		extrinsics << Eigen::Vector3d::Constant(0.01), Eigen::Vector3d::Constant(0.017);
		const Eigen::Vector3d wheels(0.01, 0.01, 0.0023);
		return {{std::make_shared<StatePrior>(BlockShape::euclidean(9), motions[0].data(), motion), nullptr, {motions[0].data()}},
		        {std::make_shared<StatePrior>(BlockShape::pose(), T_BC.data(), extrinsics), nullptr, {T_BC.data()}},
		        {std::make_shared<StatePrior>(BlockShape::euclidean(3), intrinsics.data(), wheels), nullptr, {intrinsics.data()}}};
	}

	/** Moves every state of frame k and later ones, as new measurements would. */
	void moveStates(int k, double scale)
	{
		const auto move = [&](const BlockShape& shape, double* x, double by)
		{
			const Eigen::VectorXd delta = random_.vector(shape.tangent, by * scale);
			blockPlus(shape, x, delta.data(), x);
		};
		for (size_t i = static_cast<size_t>(k); i < poses.size(); ++i)
		{
			move(BlockShape::pose(), poses[i].data(), 5e-3);
			move(BlockShape::euclidean(9), motions[i].data(), 2e-3);
		}
		for (Landmark& landmark : landmarks)
			if (landmark.frame >= k) move(BlockShape::euclidean(1), &landmark.lambda, 2e-3);
		move(BlockShape::pose(), T_BC.data(), 2e-3);
		move(BlockShape::euclidean(3), intrinsics.data(), 1e-3);
	}

	struct Landmark
	{
		int frame;
		double lambda;
	};
	// Blocks keep their addresses: deques only grow.
	std::deque<std::vector<double>> poses, motions;
	std::deque<Landmark> landmarks;
	std::vector<double> T_BC, intrinsics;
	/** For all reprojection factors; null for squared error. Set before the factors are taken. */
	void setLoss(const std::shared_ptr<ceres::LossFunction>& loss)
	{
		for (Entry& entry : entries_)
			if (entry.factor.cost->shapes().back().tangent == 1) entry.factor.loss = loss;
	}

   private:
	struct Entry
	{
		int frame;
		Factor factor;
	};

	void addFrame(int k, double state_noise)
	{
		const double t = k * frame_s;
		poses.push_back(block(posePlus(motion_.T_WB(t), state_noise * random_.vector(6, 3e-3))));
		motions.push_back(block(Eigen::VectorXd(motion_.motion(t) + state_noise * random_.vector(9, 2e-3))));
	}

	void addMotionFactors(int k)
	{
		const size_t i = static_cast<size_t>(k), j = i + 1;
		const double t = k * frame_s;
		const ImuPreintegration imu = motion_.imuBetween(t, t + frame_s, motion_.b_a, motion_.b_g);
		const WheelPreintegration wheels = motion_.wheelsBetween(t, t + frame_s, motion_.wheels);
		entries_.push_back({k,
		                    {std::make_shared<ImuResidual>(imu, gravity),
		                     nullptr,
		                     {poses[i].data(), motions[i].data(), poses[j].data(), motions[j].data()}}});
		entries_.push_back(
		    {k, {std::make_shared<WheelResidual>(wheels, motion_.T_BO), nullptr, {poses[i].data(), poses[j].data(), intrinsics.data()}}});
	}

	void addLandmark(int first, int last, double state_noise)
	{
		const Eigen::Vector3d b = Eigen::Vector3d(random_.uniform(-0.5, 0.5), random_.uniform(-0.4, 0.4), 1).normalized();
		const double lambda = 1 / random_.uniform(1.5, 8);
		landmarks.push_back({first, lambda * (1 + 0.05 * state_noise * random_.normal())});
		const Eigen::Vector3d x_W = motion_.T_WB(first * frame_s) * (T_BC_truth_ * (b / lambda));
		for (int j = first + 1; j <= last; ++j)
		{
			const Eigen::Vector3d seen = T_BC_truth_.inverse() * (motion_.T_WB(j * frame_s).inverse() * x_W);
			const Eigen::Vector3d noisy = so3::exp(random_.vector3(sigma_rad)) * seen;
			entries_.push_back({first,
			                    {std::make_shared<ReprojectionResidual>(b, noisy, sigma_rad),
			                     nullptr,
			                     {poses[static_cast<size_t>(first)].data(), poses[static_cast<size_t>(j)].data(), T_BC.data(),
			                      &landmarks.back().lambda}}});
		}
	}

	Random random_;
	ConstantTwist motion_;
	Pose3 T_BC_truth_;
	std::vector<Entry> entries_;
};
}  // namespace viwo::test
