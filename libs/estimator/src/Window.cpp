#include "Window.h"

#include "ImuPreintegration.h"
#include "OnlineCalibration.h"
#include "TimeShift.h"
#include "WheelPreintegration.h"
#include "residuals/BlockAlgebra.h"
#include "residuals/ImuResidual.h"
#include "residuals/LinearPrior.h"
#include "residuals/PairPlaneResidual.h"
#include "residuals/PlaneResidual.h"
#include "residuals/ReprojectionResidual.h"
#include "residuals/StandstillResidual.h"
#include "residuals/StatePrior.h"
#include "residuals/WheelResidual.h"

#include <viwo/core/Scalars.h>

#include <ceres/loss_function.h>

#include <unordered_map>

namespace viwo
{
namespace
{
/** Where the plane and standstill factors give way, in sigma: a ramp or a bump, or a push, is not to bend the window. */
constexpr double kFloorGate = 3;

LandmarkMap::Settings landmarkSettings(const EstimatorOptions& o, const CameraModel& camera)
{
	const double f_px = camera.meanFocal_px() > 0 ? camera.meanFocal_px() : 1;
	LandmarkMap::Settings s;
	s.sigma_rad = o.noise.pixel_sigma_px / f_px;
	s.outlier_rad = o.window.outlier_px / f_px;
	s.prior_mean_1_m = o.priors.inverse_depth_mean_1_m;
	s.prior_sigma_1_m = o.priors.inverse_depth_sigma_1_m;
	s.known_deviation = o.window.tracking_depth_deviation;
	return s;
}

void addInertial(Window& w, std::vector<Factor>& factors)
{
	for (size_t i = 1; i < w.frames.size(); ++i)
	{
		Frame& a = *w.frames[i - 1];
		Frame& b = *w.frames[i];
		if (!b.interval.imu) continue;
		const double gravity_m_s2 = w.options.noise.gravity_m_s2;
		Factor factor{nullptr, nullptr, {a.pose.data(), a.motion.data(), b.pose.data(), b.motion.data()}};
		if (w.options.freeCameraOffset()) factor.blocks.push_back(&w.t_d_s);
		if (!b.imu_factor && w.options.freeCameraOffset())
			b.imu_factor = std::make_shared<ImuResidual>(*b.interval.imu, gravity_m_s2,
			                                             ImuTimeShift{significantShiftJacobian(*b.interval.imu), b.interval.cut_at.t_d_s});
		if (!b.imu_factor) b.imu_factor = std::make_shared<ImuResidual>(*b.interval.imu, gravity_m_s2);
		factor.cost = b.imu_factor;
		factors.push_back(factor);
	}
}

void addWheels(Window& w, std::vector<Factor>& factors)
{
	if (!w.options.useWheelFactor()) return;
	for (size_t i = 1; i < w.frames.size(); ++i)
	{
		Frame& a = *w.frames[i - 1];
		Frame& b = *w.frames[i];
		if (!b.interval.wheels) continue;
		const bool calibrates = w.options.calibratesWheels() && rolled(*b.interval.wheels);
		if (!b.wheel_factor && calibrates)
			b.wheel_factor = std::make_shared<WheelResidual>(
			    *b.interval.wheels, WheelTimeShift{significantWheelShift(a, b, w.calibration.T_OB), b.interval.cut_at.wheelShift_s()});
		if (!b.wheel_factor) b.wheel_factor = std::make_shared<WheelResidual>(*b.interval.wheels, w.calibration.T_BO());
		Factor factor{b.wheel_factor, nullptr, {a.pose.data(), b.pose.data(), w.wheels.data()}};
		if (calibrates) factor.blocks.insert(factor.blocks.end(), {w.T_BO.data(), &w.t_d_s, &w.t_w_s});
		factors.push_back(factor);
	}
}

void addFloor(Window& w, std::vector<Factor>& factors)
{
	static const auto loss = std::make_shared<ceres::CauchyLoss>(kFloorGate);
	const double sigma_tilt_rad = w.options.priors.plane_factor_tilt_deg * kDegree;
	const double sigma_height_m = w.options.priors.plane_factor_height_m;
	const bool pairwise = w.options.factors.plane_pairwise;
	for (auto& frame : w.frames)
	{
		if (frame->standing && w.options.factors.standstill_factor)
		{
			if (!frame->standstill_factor)
				frame->standstill_factor = std::make_shared<StandstillResidual>(w.options.priors.standstill_velocity_m_s);
			factors.push_back({frame->standstill_factor, loss, {frame->motion.data()}});
		}
		// What the floor has to say at one place it has said when the robot came to it.
		if (!w.options.usePlaneFactor() || frame->standing || (pairwise && frame == w.frames.front())) continue;
		if (!frame->plane_factor && pairwise)
			frame->plane_factor = std::make_shared<PairPlaneResidual>(w.calibration.T_BO(), sigma_tilt_rad, sigma_height_m);
		if (!frame->plane_factor && w.options.freeMounting())
			frame->plane_factor = std::make_shared<PlaneResidual>(sigma_tilt_rad, sigma_height_m);
		if (!frame->plane_factor)
			frame->plane_factor = std::make_shared<PlaneResidual>(w.calibration.T_BO(), sigma_tilt_rad, sigma_height_m);
		double* const reference = pairwise ? w.frames.front()->pose.data() : w.plane().data();
		if (pairwise)
			factors.push_back({frame->plane_factor, loss, {reference, frame->pose.data()}});
		else if (w.options.freeMounting())
			factors.push_back({frame->plane_factor, loss, {frame->pose.data(), reference, w.T_BO.data()}});
		else
			factors.push_back({frame->plane_factor, loss, {frame->pose.data(), reference}});
	}
}

void addLandmarks(Window& w, std::vector<Factor>& factors)
{
	const LandmarkMap::Settings& settings = w.landmarks.settings();
	static const BlockShape scalar = BlockShape::euclidean(1);
	const auto loss = std::make_shared<ceres::HuberLoss>(w.options.window.huber_px / w.options.noise.pixel_sigma_px);
	for (auto& [id, landmark] : w.landmarks.all())
	{
		if (!landmark.in_use) continue;
		if (!landmark.prior_factor)
			landmark.prior_factor =
			    std::make_shared<StatePrior>(scalar, &settings.prior_mean_1_m, Eigen::VectorXd::Constant(1, settings.prior_sigma_1_m));
		factors.push_back({landmark.prior_factor, nullptr, {&landmark.inverse_depth_1_m}});
		double* const anchor = landmark.anchor().pose.data();
		for (size_t i = 1; i < landmark.sightings.size(); ++i)
		{
			Sighting& s = landmark.sightings[i];
			if (!s.factor)
				s.factor = std::make_shared<ReprojectionResidual>(landmark.sightings.front().bearing_C, s.bearing_C, settings.sigma_rad);
			if (!s.factor->valid(anchor, s.frame->pose.data(), w.T_BC.data(), &landmark.inverse_depth_1_m)) continue;
			factors.push_back({s.factor, loss, {anchor, s.frame->pose.data(), w.T_BC.data(), &landmark.inverse_depth_1_m}});
		}
	}
}

void takeFirstEstimates(const Window& w, std::vector<Factor>& factors)
{
	std::unordered_map<const double*, const double*> x0;  // looked up only, never walked through
	for (size_t i = 0; i < w.prior_blocks.size(); ++i) x0[w.prior_blocks[i]] = w.prior->linearizationPoint(static_cast<int>(i));
	for (Factor& factor : factors)
		for (size_t i = 0; i < factor.blocks.size(); ++i)
		{
			const auto held = x0.find(factor.blocks[i]);
			factor.cost->freeze(static_cast<int>(i), held == x0.end() ? nullptr : held->second);
		}
}
}  // namespace

Window::Window(const EstimatorOptions& o, const Calibration& c) : options(o), calibration(c), landmarks(landmarkSettings(o, c.camera))
{
	clear(nominalBelief(o, c));
}

void Window::clear(const Belief& before)
{
	belief = before;
	frames.clear();
	landmarks.clear();
	poseToBlock(belief.T_BC, T_BC.data());
	wheels = {belief.wheels.k_left, belief.wheels.k_right, belief.wheels.track_m};
	poseToBlock(belief.T_BO, T_BO.data());
	t_d_s = belief.offsets.t_d_s;
	t_w_s = belief.offsets.t_w_s;
	excitation = belief.excitation;
	adoptMounting();
	planes = {};
	current_plane = 0;
	start_priors.clear();
	prior.reset();
	prior_blocks.clear();
}

Pose3 Window::T_BC_pose() const
{
	return poseFromBlock(T_BC.data());
}

Pose3 Window::T_BO_pose() const
{
	return poseFromBlock(T_BO.data());
}

WheelIntrinsics Window::wheelIntrinsics() const
{
	return {wheels[0], wheels[1], wheels[2]};
}

void Window::adoptMounting()
{
	if (!options.freeMounting()) return;
	calibration.T_OB = T_BO_pose().inverse();
	calibration.T_OC = calibration.T_OB * T_BC_pose();
}

std::vector<Factor> collectFactors(Window& window)
{
	std::vector<Factor> factors = window.start_priors;
	addInertial(window, factors);
	addWheels(window, factors);
	addFloor(window, factors);
	addLandmarks(window, factors);
	takeFirstEstimates(window, factors);
	if (window.prior) factors.push_back({window.prior, nullptr, window.prior_blocks});
	return factors;
}
}  // namespace viwo
