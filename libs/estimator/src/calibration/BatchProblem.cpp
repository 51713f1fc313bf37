#include "calibration/BatchProblem.h"

#include "WheelPreintegration.h"
#include "residuals/BlockAlgebra.h"
#include "residuals/GaugePrior.h"
#include "residuals/PlaneResidual.h"
#include "residuals/ReferenceResidual.h"
#include "residuals/ReprojectionResidual.h"
#include "residuals/StandstillResidual.h"
#include "residuals/StatePrior.h"

#include <viwo/core/Scalars.h>
#include <viwo/core/So3.h>
#include <viwo/core/Time.h>

#include <cmath>
#include <limits>
#include <memory>

namespace viwo
{
namespace
{
// Where the losses turn linear, in deviations of the measurement: beyond what noise alone does.
constexpr double kImageHuber = 3, kWheelHuber = 4.5, kFloorGate = 3, kReferenceHuber = 4.5;
constexpr double kGaugePosition_m = 1e-4, kGaugeYaw_rad = 1e-5;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

class Collector
{
   public:
	Collector(const BatchCalibrationInput& input, const BatchCalibrationOptions& options, const EstimatorOptions& estimator,
	          BatchStates& states)
	    : in_(input), options_(options), estimator_(estimator), s_(states)
	{
	}

	std::vector<BatchFactor> result;

	void addPriors()
	{
		const Frame& first = s_.frames.front();
		add(BatchGroup::prior,
		    std::make_shared<GaugePrior>(poseFromBlock(first.pose.data()), in_.start.T_BO.p, kGaugePosition_m, kGaugeYaw_rad),
		    {s_.frames.front().pose.data()});
		const PriorOptions& p = estimator_.priors;
		const std::array<double, 9> rest{};
		Eigen::VectorXd motion(9);
		motion << Eigen::Vector3d::Constant(kInfinite), Eigen::Vector3d::Constant(p.acc_bias_m_s2),
		    Eigen::Vector3d::Constant(p.gyro_bias_rad_s);
		addPrior(BlockShape::euclidean(9), rest.data(), motion, s_.frames.front().motion.data());
		const double tilt = p.plane_tilt_deg * kDegree;
		const std::array<double, 3> level{};
		addPrior(BlockShape::euclidean(3), level.data(), Eigen::Vector3d(tilt, tilt, options_.floor_height_m), s_.plane.data());
		addSensitivityPrior();
	}

	void addInertial()
	{
		for (size_t i = 1; i < s_.frames.size(); ++i)
		{
			Frame &a = s_.frames[i - 1], &b = s_.frames[i];
			if (!b.imu_factor) continue;
			add(BatchGroup::imu, b.imu_factor,
			    {a.pose.data(), a.motion.data(), b.pose.data(), b.motion.data(), s_.camera_offset_s.data(), s_.sensitivity.entries.data()});
		}
	}

	void addWheels(const std::vector<bool>& slipping)
	{
		static const auto loss = std::make_shared<ceres::HuberLoss>(kWheelHuber);
		for (size_t i = 1; i < s_.frames.size(); ++i)
		{
			Frame &a = s_.frames[i - 1], &b = s_.frames[i];
			if (!b.wheel_factor || slipping[i]) continue;
			add(BatchGroup::wheels, b.wheel_factor,
			    {a.pose.data(), b.pose.data(), s_.wheels.data(), s_.T_BO.data(), s_.camera_offset_s.data(), s_.wheel_offset_s.data()},
			    loss);
		}
	}

	/** The floor's unevenness is one error for a patch, however many frames stand on it; turning on the spot turns it in the robot's axes.
	 */
	void addFloor()
	{
		static const auto loss = std::make_shared<ceres::CauchyLoss>(kFloorGate);
		for (size_t i = 1; i < s_.frames.size(); ++i)
		{
			Frame& frame = s_.frames[i];
			if (frame.standing)
				add(BatchGroup::floor, std::make_shared<StandstillResidual>(estimator_.priors.standstill_velocity_m_s),
				    {frame.motion.data()}, loss);
			if (!frame.interval.wheels) continue;
			const double turn_rad = std::abs(so3::log(frame.interval.wheels->dR()).z());
			const double patches = frame.interval.wheels->distance_m() / options_.floor_patch_m + 0.5 * turn_rad;
			constexpr double kFewest = 1e-3;
			if (patches < kFewest) continue;
			const double inflation = 1 / std::sqrt(std::min(1.0, patches));
			add(BatchGroup::floor,
			    std::make_shared<PlaneResidual>(inflation * options_.floor_tilt_deg * kDegree, inflation * options_.floor_height_m),
			    {frame.pose.data(), s_.plane.data(), s_.T_BO.data()}, loss);
		}
	}

	void addLandmarks(LandmarkMap& landmarks, const BatchTrust& trust)
	{
		static const BlockShape scalar = BlockShape::euclidean(1);
		const double weighed_down = std::sqrt(trust.track_factor);
		const auto loss = std::make_shared<ceres::HuberLoss>(kImageHuber / weighed_down);
		const LandmarkMap::Settings& settings = landmarks.settings();
		const double sigma_rad = weighed_down * trust.pixel_sigma_px / std::max(1.0, in_.camera.meanFocal_px());
		for (auto& [id, landmark] : landmarks.all())
		{
			if (!landmark.in_use) continue;
			addPrior(scalar, &settings.prior_mean_1_m, Eigen::VectorXd::Constant(1, settings.prior_sigma_1_m), &landmark.inverse_depth_1_m);
			double* const anchor = landmark.anchor().pose.data();
			for (size_t i = 1; i < landmark.sightings.size(); ++i)
			{
				Sighting& s = landmark.sightings[i];
				s.factor = std::make_shared<ReprojectionResidual>(landmark.sightings.front().bearing_C, s.bearing_C, sigma_rad);
				if (!s.factor->valid(anchor, s.frame->pose.data(), s_.T_BC.data(), &landmark.inverse_depth_1_m)) continue;
				add(BatchGroup::image, s.factor, {anchor, s.frame->pose.data(), s_.T_BC.data(), &landmark.inverse_depth_1_m}, loss);
			}
		}
	}

	void addReference()
	{
		if (in_.reference.empty()) return;
		const double p = 1 / options_.reference_position_m, phi = 1 / (options_.reference_rotation_deg * kDegree);
		const bool planar = isPlanar();
		Vector6d weights;
		weights << p, p, planar ? 0 : p, planar ? 0 : phi, planar ? 0 : phi, phi;
		static const auto loss = std::make_shared<ceres::HuberLoss>(kReferenceHuber);
		constexpr double kMaxGap_s = 0.5, kStep_s = 0.05;
		for (Frame& frame : s_.frames)
		{
			const int64_t t_ns = s_.imuTime_ns(frame), step_ns = nanoseconds(kStep_s);
			const auto here = in_.reference.at(t_ns, kMaxGap_s), before = in_.reference.at(t_ns - step_ns, kMaxGap_s),
			           after = in_.reference.at(t_ns + step_ns, kMaxGap_s);
			if (!here || !before || !after) continue;
			const Eigen::Vector3d v_O = here->R.conjugate() * (after->p - before->p) / (2 * kStep_s);
			const Eigen::Vector3d w_O = so3::log(Eigen::Quaterniond(before->R.conjugate() * after->R)) / (2 * kStep_s);
			add(BatchGroup::reference, std::make_shared<ReferenceResidual>(*here, v_O, w_O, weights),
			    {frame.pose.data(), s_.T_BO.data(), s_.T_RW.data(), s_.reference_offset_s.data()}, loss);
		}
		Vector6d wide;  // a planar reference says nothing of these, and W is level
		wide << Eigen::Vector3d::Constant(100), Eigen::Vector3d::Constant(10);
		addPrior(BlockShape::pose(), s_.T_RW.data(), wide, s_.T_RW.data());
		const double zero = 0;
		addPrior(BlockShape::euclidean(1), &zero, Eigen::VectorXd::Constant(1, options_.reference_time_s), s_.reference_offset_s.data());
	}

   private:
	void add(BatchGroup group, std::shared_ptr<LocalCost> cost, std::vector<double*> blocks,
	         std::shared_ptr<ceres::LossFunction> loss = nullptr)
	{
		result.push_back({{std::move(cost), std::move(loss), std::move(blocks)}, group});
	}
	void addPrior(const BlockShape& shape, const double* x0, const Eigen::VectorXd& sigmas, double* block)
	{
		add(BatchGroup::prior, std::make_shared<StatePrior>(shape, x0, sigmas), {block});
	}

	void addSensitivityPrior()
	{
		constexpr double kLeast = 1e-9;  // a tolerance of 0: none
		Eigen::VectorXd sigmas = Eigen::VectorXd::Constant(ImuSensitivity::size, std::max(kLeast, options_.imu_misalignment_deg * kDegree));
		for (int axis = 0; axis < 3; ++axis)
		{
			sigmas[4 * axis] = std::max(kLeast, options_.acc_scale);
			sigmas[9 + 4 * axis] = std::max(kLeast, options_.gyro_scale);
		}
		const std::array<double, ImuSensitivity::size> none{};
		addPrior(BlockShape::euclidean(ImuSensitivity::size), none.data(), sigmas, s_.sensitivity.entries.data());
	}

	bool isPlanar() const
	{
		constexpr double kFlat = 1e-9;
		const double z_m = in_.reference.poses().front().T.p.z();
		for (const StampedPose& pose : in_.reference.poses())
			if (std::abs(pose.T.p.z() - z_m) > kFlat || pose.T.R.vec().head<2>().norm() > kFlat) return false;
		return true;
	}

	const BatchCalibrationInput& in_;
	const BatchCalibrationOptions& options_;
	const EstimatorOptions& estimator_;
	BatchStates& s_;
};
}  // namespace

LandmarkMap::Settings batchLandmarkSettings(const BatchCalibrationInput& input, const EstimatorOptions& estimator, const BatchTrust& trust)
{
	const double f_px = std::max(1.0, input.camera.meanFocal_px());
	LandmarkMap::Settings settings;
	settings.sigma_rad = trust.pixel_sigma_px / f_px;
	settings.outlier_rad = trust.outlier_px / f_px;
	settings.prior_mean_1_m = estimator.priors.inverse_depth_mean_1_m;
	settings.prior_sigma_1_m = estimator.priors.inverse_depth_sigma_1_m;
	settings.known_deviation = estimator.window.tracking_depth_deviation;
	return settings;
}

std::vector<BatchFactor> collectBatch(const BatchCalibrationInput& input, const BatchCalibrationOptions& options,
                                      const EstimatorOptions& estimator, const BatchTrust& trust, const std::vector<bool>& slipping,
                                      BatchStates& states, LandmarkMap& landmarks)
{
	landmarks = LandmarkMap(batchLandmarkSettings(input, estimator, trust));
	for (Frame& frame : states.frames) landmarks.add(frame);
	const Pose3 T_BC = poseFromBlock(states.T_BC.data());
	landmarks.triangulate(T_BC);
	landmarks.assess(T_BC);

	Collector collector(input, options, estimator, states);
	collector.addPriors();
	collector.addInertial();
	collector.addWheels(slipping);
	collector.addFloor();
	collector.addReference();
	collector.addLandmarks(landmarks, trust);
	return std::move(collector.result);
}
}  // namespace viwo
