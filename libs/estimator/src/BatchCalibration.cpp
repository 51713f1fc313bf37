#include <viwo/estimator/BatchCalibration.h>

#include "calibration/BatchInformation.h"
#include "calibration/BatchIntervals.h"
#include "calibration/BatchProblem.h"
#include "calibration/BatchQuality.h"
#include "calibration/BatchSolver.h"
#include "calibration/BatchStart.h"
#include "calibration/RigPriors.h"
#include "residuals/BlockAlgebra.h"

#include <mrpt/core/format.h>
#include <viwo/core/Scalars.h>
#include <viwo/core/Time.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace viwo
{
namespace
{
/** A parameter whose deviation stays above this share of what it was beforehand has not been observed, and is held where it was; below the
 * lesser share it is let go again. */
constexpr double kObservedShare = 0.5, kReleasedShare = 0.4;
/** From this round on the images are weighed as they deserve, and it can be told what is observed. */
constexpr int kFirstFineRound = 2;
/** Rounds end once nothing moves by more than this, in its own deviations, and the noise by no more than this share. */
constexpr double kSettled = 0.2, kSettledNoise = 0.05;
/** Of six rows in deviations: a wheel interval beyond this is not noise. Looked at from the first round on, before slip passes for noise.
 */
constexpr double kSlipSquare = 36;

bool isOfCamera(int parameter)
{
	return parameter >= RigOrder::camera_lever && parameter < RigOrder::camera_offset;
}

class BatchRun
{
   public:
	BatchRun(const BatchCalibrationInput& input, const BatchCalibrationOptions& options, const EstimatorOptions& estimator,
	         const std::function<bool(double, const std::string&)>& progress)
	    : in_(input), options_(options), estimator_(estimator), progress_(progress), samples_(input), landmarks_({})
	{
	}

	BatchCalibrationResult go()
	{
		result_.rig = in_.start;
		result_.problem = startBatch(in_, options_, estimator_, samples_, s_);
		if (result_.problem.empty()) alignReference();
		if (result_.problem.empty()) run();
		return result_;
	}

   private:
	void run()
	{
		slipping_.assign(s_.frames.size(), false);
		held_.setConstant(false);
		result_.prior_deviations = priorDeviations(options_, in_.start);
		result_.keyframes = static_cast<int>(s_.frames.size());
		trust_.pixel_sigma_px = kCoarseSigma_px;
		trust_.outlier_px = kCoarseOutlier_px;
		// The rig as it was given, all else at its best: what it costs to keep it, and a start from which all can move.
		if (!solve({s_.T_BC.data(), s_.T_BO.data(), s_.wheels.data(), s_.camera_offset_s.data(), s_.wheel_offset_s.data()}, 0)) return;
		landmarks_.assess(poseFromBlock(s_.T_BC.data()));
		result_.before = qualityOf(in_, s_, landmarks_);
		for (int round = 1; round <= options_.max_rounds; ++round)
		{
			trust_.outlier_px = round == 1 ? kCoarseOutlier_px : estimator_.window.outlier_px;
			if (round == kFirstFineRound) trust_.pixel_sigma_px = estimator_.noise.pixel_sigma_px;
			const SensorRig before = s_.rig();
			if (!solve({}, round)) return;
			result_.rounds = round;
			if (!assess()) return;
			const bool same_unknowns = round >= kFirstFineRound && !holdUnobserved();
			settled_ = round > kFirstFineRound && same_unknowns && settled(before);
			if (settled_) break;
		}
		judge();
	}

	/** Cuts the samples at the present offsets, triangulates, solves. */
	bool solve(const std::vector<const double*>& fixed, int round)
	{
		constexpr int kIterations = 20;
		if (progress_ && !progress_(static_cast<double>(round) / (options_.max_rounds + 1), "round " + std::to_string(round)))
		{
			result_.problem = "interrupted";
			return false;
		}
		cutIntervals(samples_, estimator_, wheel_noise_ratio_, s_);
		measurements_ = collectBatch(in_, options_, estimator_, trust_, slipping_, s_, landmarks_);
		if (!enoughImages()) return false;
		if (solveBatch(withRigPriors(held_), landmarks_, fixed, kIterations) && plausible()) return true;
		result_.problem =
		    "the calibration diverges: the start may be too far off (mountings within some degrees and centimetres, wheels within some "
		    "percent, clocks within some hundredths of a second), or image, IMU and wheels are not of the same drive";
		return false;
	}

	std::vector<BatchFactor> withRigPriors(const RigFlags& held)
	{
		std::vector<BatchFactor> all = measurements_;
		for (BatchFactor& f : rigPriors(in_.start, options_, held, s_)) all.push_back(std::move(f));
		return all;
	}

	bool enoughImages()
	{
		constexpr double kFewest = 10;  // sightings a key frame
		size_t sightings = 0;
		for (const BatchFactor& f : measurements_)
			if (f.group == BatchGroup::image) ++sightings;
		if (static_cast<double>(sightings) >= kFewest * static_cast<double>(s_.frames.size())) return true;
		result_.problem = mrpt::format(
		    "the images have %.1f usable tracks each, a calibration needs %.0f: drive where there is texture and light, and check the "
		    "camera's calibration and mounting",
		    static_cast<double>(sightings) / static_cast<double>(s_.frames.size()), kFewest);
		return false;
	}

	bool plausible() const
	{
		const RigVector moved = rigDifference(s_.rig(), in_.start);
		return moved.allFinite() && moved.cwiseAbs().maxCoeff() < 1 &&
		       std::all_of(s_.frames.begin(), s_.frames.end(), [](const Frame& f) { return poseFromBlock(f.pose.data()).p.allFinite(); });
	}

	/** Deviations, noise and slip at the present states. What is held is as uncertain as it was, and makes others so. */
	bool assess()
	{
		const std::vector<BatchFactor> factors = withRigPriors(RigFlags::Constant(false));
		BatchInformation information;
		if (!information.compute(factors))
		{
			result_.problem = "the equations are singular: the log has too little motion; drive starts, stops and turns to both sides";
			return false;
		}
		setDeviations(factors, information);
		const double images = information.varianceFactor(
		    BatchGroup::image, [](int) { return true; }, false);
		// Forward travel and yaw are the encoders' noise; the other rows are the floor's.
		const double wheels = information.varianceFactor(
		    BatchGroup::wheels, [](int row) { return row == 0 || row == 5; }, true);
		noise_change_ = std::max({std::abs(std::log(images * trust_.track_factor)), std::abs(std::log(wheels)),
		                          std::abs(std::log(track_factor_ / trust_.track_factor))});
		trust_.pixel_sigma_px =
		    std::clamp(trust_.pixel_sigma_px * std::sqrt(images * trust_.track_factor), kLeastSigma_px, kCoarseSigma_px);
		wheel_noise_ratio_ *= std::clamp(std::sqrt(wheels), 0.5, 2.0);
		trust_.track_factor = track_factor_;
		findSlip();
		return true;
	}

	void findSlip()
	{
		slip_changed_ = false;
		for (size_t i = 1; i < s_.frames.size(); ++i)
		{
			const Frame &a = s_.frames[i - 1], &b = s_.frames[i];
			if (!b.wheel_factor) continue;
			const double* x[] = {a.pose.data(),           b.pose.data(), s_.wheels.data(), s_.T_BO.data(), s_.camera_offset_s.data(),
			                     s_.wheel_offset_s.data()};
			Eigen::Matrix<double, 6, 1> r;
			b.wheel_factor->evaluateLocal(x, r.data(), nullptr);
			const bool slips = r.squaredNorm() > kSlipSquare;
			slip_changed_ = slip_changed_ || slips != slipping_[i];
			slipping_[i] = slips;
		}
	}

	/** @return whether other parameters are held than before. */
	bool holdUnobserved()
	{
		const RigFlags before = held_;
		for (int i = 0; i < RigOrder::size; ++i)
			held_[i] = !(result_.deviations[i] < (held_[i] ? kReleasedShare : kObservedShare) * result_.prior_deviations[i]);
		return held_ != before;
	}

	void setDeviations(const std::vector<BatchFactor>& factors, const BatchInformation& information)
	{
		const BatchInformation::Deviations found = information.deviations(
		    factors, trust_, {s_.wheels.data(), s_.T_BO.data(), s_.T_BC.data(), s_.camera_offset_s.data(), s_.wheel_offset_s.data()},
		    rigJacobian(s_.rig()), stretches(factors));
		result_.deviations = found.sigma;
		track_factor_ = std::clamp(found.track_factor, 1.0, kLargestTrackFactor);
	}

	/** In which stretch of time each factor's second frame lies. */
	std::vector<int> stretches(const std::vector<BatchFactor>& factors) const
	{
		constexpr double kStretch_s = 2;
		std::map<const double*, int> of_frame;
		for (const Frame& f : s_.frames)
			of_frame[f.pose.data()] = static_cast<int>(secondsBetween(s_.frames.front().t_ns, f.t_ns) / kStretch_s);
		std::vector<int> result;
		for (const BatchFactor& f : factors) result.push_back(f.group == BatchGroup::image ? of_frame.at(f.factor.blocks[1]) : 0);
		return result;
	}

	bool settled(const SensorRig& before) const
	{
		const RigVector moved = rigDifference(s_.rig(), before).cwiseQuotient(result_.deviations);
		return moved.cwiseAbs().maxCoeff() < kSettled && noise_change_ < kSettledNoise && !slip_changed_;
	}

	void alignReference()
	{
		poseToBlock(Pose3(), s_.T_RW.data());
		if (in_.reference.empty()) return;
		const int64_t begin_ns = in_.reference.poses().front().t_ns, end_ns = in_.reference.poses().back().t_ns;
		size_t covered = 0, within = 0;
		for (const Frame& frame : s_.frames)
		{
			const int64_t t_ns = s_.imuTime_ns(frame);
			if (t_ns >= begin_ns && t_ns <= end_ns) ++within;
			const auto T_RO = in_.reference.at(t_ns, 0.5);
			if (!T_RO) continue;
			if (covered++ == 0) poseToBlock(*T_RO * (poseFromBlock(frame.pose.data()) * in_.start.T_BO).inverse(), s_.T_RW.data());
		}
		if (2 * covered >= s_.frames.size()) return;
		result_.problem = "the reference trajectory covers " + std::to_string(100 * covered / s_.frames.size()) + " % of the log";
		result_.problem += 2 * within < s_.frames.size() ? "; it must have stamps of the same clock, and poses over most of the drive"
		                                                 : ": its poses are more than 0.5 s apart; give two a second or more";
	}

	void judge()
	{
		landmarks_.assess(poseFromBlock(s_.T_BC.data()));
		result_.after = qualityOf(in_, s_, landmarks_);
		result_.landmarks = static_cast<int>(landmarks_.all().size());
		result_.pixel_sigma_px = trust_.pixel_sigma_px;
		result_.wheel_noise_ratio = wheel_noise_ratio_;
		for (size_t i = 1; i < s_.frames.size(); ++i)
			if (slipping_[i]) result_.slip_s += secondsBetween(s_.frames[i - 1].t_ns, s_.frames[i].t_ns);
		keepUnobserved();
		addNotes();
		const double duration_s = secondsBetween(s_.frames.front().t_ns, s_.frames.back().t_ns);
		if (result_.slip_s <= options_.slip_share * duration_s) return;
		const auto first = static_cast<size_t>(std::find(slipping_.begin(), slipping_.end(), true) - slipping_.begin());
		result_.problem = mrpt::format(
		    "the wheels contradict camera and IMU for %.1f of %.1f s, first %.1f s after the first image: they slip, or the start is "
		    "too far off; drive more gently on firm ground, or measure the mountings",
		    result_.slip_s, duration_s, secondsBetween(s_.frames.front().t_ns, s_.frames[first].t_ns));
	}

	/** What was not observed stays what it was, to the last digit. */
	void keepUnobserved()
	{
		RigVector moved = rigDifference(s_.rig(), in_.start);
		for (int i = 0; i < RigOrder::size; ++i)
		{
			result_.observed[i] = !held_[i];
			if (held_[i]) moved[i] = 0;
		}
		result_.rig = rigPlus(in_.start, moved);
	}

	void addNotes()
	{
		std::vector<std::string>& notes = result_.notes;
		constexpr double kFar = 3;
		const RigVector moved = rigDifference(result_.rig, in_.start);
		for (int i = 0; i < RigOrder::size; ++i)
			if (result_.observed[i] && std::abs(moved[i]) > kFar * result_.prior_deviations[i])
				notes.push_back(mrpt::format("%s is %.1f times as far from the start as [calibration] expects: check it by hand%s",
				                             RigOrder::names()[static_cast<size_t>(i)].c_str(),
				                             std::abs(moved[i]) / result_.prior_deviations[i],
				                             isOfCamera(i) ? ", and the lens, whose errors it takes up" : ""));
		constexpr double kBlurred_px = 0.8;
		if (result_.pixel_sigma_px > kBlurred_px)
			notes.push_back(mrpt::format(
			    "corners are off by %.2f px, usual is 0.3 to 0.5: lens calibration, mounting of the camera or its resolution may be wrong",
			    result_.pixel_sigma_px));
		constexpr double kNoisy = 3;
		if (result_.wheel_noise_ratio > kNoisy)
			notes.push_back(mrpt::format(
			    "the wheels are %.1f times as noisy as [noise] says: they slip, or IMU and camera are mounted otherwise than was found",
			    result_.wheel_noise_ratio));
		if (!settled_)
			notes.push_back(
			    mrpt::format("it has not settled in %d rounds: the deviations may be too small; raise max_rounds", result_.rounds));
	}

	static constexpr double kCoarseSigma_px = 3, kCoarseOutlier_px = 30, kLeastSigma_px = 0.05, kLargestTrackFactor = 25;

	const BatchCalibrationInput& in_;
	const BatchCalibrationOptions& options_;
	const EstimatorOptions& estimator_;
	const std::function<bool(double, const std::string&)>& progress_;
	BatchSamples samples_;
	BatchStates s_;
	LandmarkMap landmarks_;
	std::vector<BatchFactor> measurements_;
	RigFlags held_ = RigFlags::Constant(false);
	bool settled_ = false, slip_changed_ = false;
	std::vector<bool> slipping_;
	BatchTrust trust_;
	double wheel_noise_ratio_ = 1, noise_change_ = 1, track_factor_ = 1;
	BatchCalibrationResult result_;
};
}  // namespace

BatchCalibrationResult calibrateInBatch(const BatchCalibrationInput& input, const BatchCalibrationOptions& options,
                                        const EstimatorOptions& estimator,
                                        const std::function<bool(double fraction, const std::string& note)>& progress)
{
	return BatchRun(input, options, estimator, progress).go();
}
}  // namespace viwo
