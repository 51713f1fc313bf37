#include <mrpt/img/CImage.h>
#include <viwo/core/Time.h>
#include <viwo/core/TimeText.h>
#include <viwo/frontend/FeatureTracker.h>
#include <viwo/odometry/Odometry.h>
#include <viwo/rawlog/StampGate.h>

#include <deque>
#include <opencv2/core.hpp>
#include <optional>

#include "StreamClock.h"

namespace viwo
{
namespace
{
/** For the distance that the wheels have travelled: a hole in their stream counts no longer than this. */
constexpr double kLongestWheelStep_s = 0.5;
}  // namespace

/** Brings the streams together: images wait until IMU and wheels reach up to them, then the front-end and the estimator run. What happens
 * depends on the order and the stamps of the observations alone, never on how fast they come.
 */
struct Odometry::Impl
{
	Odometry& owner;
	OdometryOptions options;
	std::optional<Calibration> calibration;
	ObservationAdapter adapter;
	StampGate gate{OdometryOptions::kMaxStampJump_s, true};
	mrpt::obs::CObservationImage::Ptr first_image;
	mrpt::obs::CObservationIMU::Ptr first_imu;

	std::unique_ptr<Estimator> estimator;
	std::unique_ptr<FeatureTracker> tracker;
	std::vector<ImuSample> early_imu;  //!< before the calibration was complete
	std::vector<WheelSample> early_wheels;
	std::deque<ImageRef> images;  //!< not yet processed
	StreamClock stream{OdometryOptions::kLongestBlind_s};
	int64_t latest_imu_ns = 0, latest_wheels_ns = 0;
	double wheel_travel_m = 0;  //!< since the first pose
	std::optional<int64_t> last_frame_ns, last_image_ns, first_sample_ns, first_frame_ns;

	FrameEstimate latest;
	Trajectory trajectory;
	std::function<void(const FrameEstimate&)> on_frame;
	std::function<void(const NavState&)> on_imu_rate;
	std::function<bool()> stop_asked;
	StageTimes times;
	size_t reported_changes = 0;

	Impl(Odometry& o, const OdometryOptions& opt) : owner(o), options(opt), adapter(opt.rawlog) {}

	const EstimatorOptions& est() const { return options.estimator; }
	bool uses(const std::string& label) const;
	void accept(const mrpt::obs::CObservation::Ptr& observation);
	void judged(const StampGate::Verdict& verdict);
	void take(const ImuSample& s);
	void take(const WheelSample& s);
	void take(const ImageRef& image);
	bool makeEstimator(bool at_end);
	void drain(bool at_end);
	bool covered(int64_t t_ns) const;
	std::optional<int64_t> blindFrameDue();
	void process(int64_t t_ns, const ImageRef* image);
	FeatureFrame track(int64_t t_ns, const ImageRef& image);
	void emitImuRate(int64_t t_until_ns);
	void logStatus();

	struct Stage
	{
		Impl& impl;
		std::string name;
		Stage(Impl& i, std::string n) : impl(i), name(std::move(n)) { impl.stage(name, true); }
		~Stage() { impl.stage(name, false); }
	};
	void stage(const std::string& name, bool begin);
};

/** Stages end in destructors, the estimator's too: there nothing may be thrown, and a time that is lost matters less than the error on its
 * way. */
void Odometry::Impl::stage(const std::string& name, bool begin)
{
	if (begin)
	{
		owner.profiler.enter("odometry." + name);
		times.begin(name);
		return;
	}
	times.end(name);
	try
	{
		owner.profiler.leave("odometry." + name);
	}
	catch (const std::exception&)
	{
	}
}

bool Odometry::Impl::uses(const std::string& label) const
{
	const AdapterOptions& labels = adapter.options();
	return label == labels.cam_label || (est().useImu() && label == labels.imu_label) ||
	       (est().useWheels() && label == labels.odometry_label);
}

void Odometry::Impl::take(const ImuSample& s)
{
	latest_imu_ns = s.t_ns;
	stream.advance(s.t_ns);
	if (!first_sample_ns) first_sample_ns = s.t_ns;
	if (estimator)
		estimator->addImu(s);
	else
		early_imu.push_back(s);
}

void Odometry::Impl::take(const WheelSample& s)
{
	if (latest_wheels_ns > 0 && !trajectory.empty())
	{
		const double speed_m_s = 0.5 * std::abs(s.v_left_m_s + s.v_right_m_s);  // mean since the sample before
		wheel_travel_m += speed_m_s * std::min(secondsBetween(latest_wheels_ns, s.t_ns), kLongestWheelStep_s);
	}
	latest_wheels_ns = s.t_ns;
	stream.advance(s.t_ns);
	if (!first_sample_ns) first_sample_ns = s.t_ns;
	if (estimator)
		estimator->addWheels(s);
	else
		early_wheels.push_back(s);
}

void Odometry::Impl::take(const ImageRef& image)
{
	const mrpt::obs::CObservationImage& o = *image.observation();
	if (!first_image) first_image = image.observation();
	if (est().useCamera() && (o.cameraPose != first_image->cameraPose || o.cameraParams != first_image->cameraParams))
		throw Error("label " + o.sensorLabel + ": the image at " + formatSeconds(image.t_ns) + " s has another " +
		            (o.cameraPose != first_image->cameraPose ? "cameraPose" : "calibration") +
		            " than the first: two cameras under one label; give each its own and set cam_label to one");
	images.push_back(image);
	last_image_ns = image.t_ns;
	stream.advance(image.t_ns);
}

bool Odometry::Impl::makeEstimator(bool at_end)
{
	if (estimator) return true;
	const bool has_image = first_image != nullptr, has_imu = first_imu != nullptr;
	if (!calibration)
	{
		if ((est().useCamera() && !has_image) || (est().useImu() && early_imu.empty())) return false;
		if (est().mode == Mode::wheel && !at_end && !has_imu && images.empty() && early_wheels.size() < 20) return false;
		calibration =
		    calibrationFrom(adapter.options(), est().useCamera() ? first_image.get() : nullptr, has_imu ? first_imu.get() : nullptr);
	}
	estimator = std::make_unique<Estimator>(est(), *calibration);
	estimator->setStageHook([this](const char* name, bool begin) { stage(name, begin); });
	if (est().useCamera()) tracker = std::make_unique<FeatureTracker>(calibration->camera, options.tracker);
	for (const ImuSample& s : early_imu) estimator->addImu(s);
	for (const WheelSample& s : early_wheels) estimator->addWheels(s);
	early_imu.clear();
	early_wheels.clear();
	return true;
}

bool Odometry::Impl::covered(int64_t t_ns) const
{
	const bool imu = !est().useImu() || latest_imu_ns >= estimator->imuNeededFor(t_ns);
	const bool wheels = !est().useWheels() || latest_wheels_ns >= estimator->wheelsNeededFor(t_ns);
	return (imu && wheels) || secondsBetween(t_ns, stream.now_ns()) > OdometryOptions::kMaxWait_s;
}

std::optional<int64_t> Odometry::Impl::blindFrameDue()
{
	if (!images.empty()) return std::nullopt;
	const std::optional<int64_t> since = last_frame_ns ? last_frame_ns : est().useCamera() ? std::nullopt : first_sample_ns;
	if (!since) return std::nullopt;
	const bool camera_is_there = last_image_ns && secondsBetween(*last_image_ns, stream.now_ns()) <= OdometryOptions::kBlindAfter_s;
	if (camera_is_there || secondsBetween(*since, stream.now_ns()) <= OdometryOptions::kBlindAfter_s) return std::nullopt;
	return stream.pastHoles(*since + nanoseconds(OdometryOptions::kBlindPeriod_s));
}

void Odometry::Impl::drain(bool at_end)
{
	if (!makeEstimator(at_end)) return;
	while (!stop_asked || !stop_asked())
	{
		if (const auto t_ns = blindFrameDue(); t_ns && covered(*t_ns))
		{
			process(*t_ns, nullptr);
			continue;
		}
		if (images.empty() || (!covered(images.front().t_ns) && !at_end)) return;
		const ImageRef image = images.front();
		images.pop_front();
		process(image.t_ns, &image);
	}
}

FeatureFrame Odometry::Impl::track(int64_t t_ns, const ImageRef& image)
{
	mrpt::img::CImage grey;
	{
		Stage s(*this, "decode");
		grey = image.grey();
	}
	Stage s(*this, "track");
	std::optional<Eigen::Quaterniond> R_Cprev_Ccur;
	if (last_frame_ns) R_Cprev_Ccur = estimator->predictCameraRotation(*last_frame_ns, t_ns);
	return tracker->track(t_ns, grey.asCvMatRef(), R_Cprev_Ccur);
}

void Odometry::Impl::process(int64_t t_ns, const ImageRef* image)
{
	if (last_frame_ns && t_ns <= *last_frame_ns) return;
	Stage whole(*this, "frame");
	emitImuRate(estimator->imuTimeOf(t_ns));
	FeatureFrame features;
	features.t_ns = t_ns;
	if (image && est().useCamera()) features = track(t_ns, *image);
	if (!image && tracker) tracker->reset();
	if (!first_frame_ns) first_frame_ns = t_ns;
	last_frame_ns = t_ns;
	{
		Stage s(*this, "estimate");
		latest = estimator->addFrame(features);
	}
	if (latest.has_pose) trajectory.push_back({latest.t_ns, latest.T_WO});
	logStatus();
	if (on_frame) on_frame(latest);
}

void Odometry::Impl::emitImuRate(int64_t t_until_ns)
{
	if (!on_imu_rate || !last_frame_ns) return;
	for (const NavState& state : estimator->propagate(latest.t_ns, t_until_ns)) on_imu_rate(state);
}

void Odometry::Impl::logStatus()
{
	const auto& changes = estimator->statusChanges();
	for (; reported_changes < changes.size(); ++reported_changes)
	{
		const StatusChange& c = changes[reported_changes];
		const double t_s = secondsBetween(*first_frame_ns, c.t_ns);
		owner.logFmt(mrpt::system::LVL_INFO, "%.2f s: %s -> %s (%s)", t_s, toString(c.from), toString(c.to), c.cause.c_str());
	}
}

Odometry::Odometry(const OdometryOptions& options)
    : COutputLogger("viwo::Odometry"), profiler(true, "viwo::Odometry"), impl_(std::make_unique<Impl>(*this, options))
{
}

Odometry::Odometry(const OdometryOptions& options, const Calibration& calibration) : Odometry(options)
{
	impl_->calibration = calibration;
}

Odometry::~Odometry()
{
	profiler.clear(true);  // or it prints its statistics
}

void Odometry::Impl::accept(const mrpt::obs::CObservation::Ptr& observation)
{
	const AdaptedObservation adapted = adapter.convert(observation);
	if (const auto* imu = std::get_if<ImuSample>(&adapted.sample))
		take(*imu);
	else if (const auto* wheels = std::get_if<WheelSample>(&adapted.sample))
		take(*wheels);
	else if (const auto* image = std::get_if<ImageRef>(&adapted.sample))
		take(*image);
	else
		return;
	drain(false);
}

void Odometry::Impl::judged(const StampGate::Verdict& verdict)
{
	for (const auto& observation : verdict.rejected) adapter.reject(observation->sensorLabel, Rejection::stamp_jump);
	for (const auto& observation : verdict.passed) accept(observation);
}

void Odometry::processObservation(const mrpt::obs::CObservation::Ptr& observation)
{
	Impl& i = *impl_;
	// Without a use for its samples, the IMU still says where B is.
	if (!i.first_imu && observation->sensorLabel == i.adapter.options().imu_label)
		i.first_imu = std::dynamic_pointer_cast<mrpt::obs::CObservationIMU>(observation);
	if (i.uses(observation->sensorLabel)) i.judged(i.gate.push(observation));
}

void Odometry::finish()
{
	impl_->judged(impl_->gate.finish());
	impl_->drain(true);
	// Nothing follows that the last images could wait for.
	if (impl_->estimator && impl_->last_frame_ns) impl_->emitImuRate(impl_->stream.now_ns());
}

void Odometry::stopWhen(std::function<bool()> asked)
{
	impl_->stop_asked = std::move(asked);
}
const FrameEstimate& Odometry::latest() const
{
	return impl_->latest;
}
double Odometry::wheelTravel_m() const
{
	return impl_->wheel_travel_m;
}
const Trajectory& Odometry::trajectory() const
{
	return impl_->trajectory;
}
std::vector<LandmarkPoint> Odometry::landmarks() const
{
	return impl_->estimator ? impl_->estimator->landmarks() : std::vector<LandmarkPoint>();
}
std::vector<KeyFrameView> Odometry::keyFrames() const
{
	return impl_->estimator ? impl_->estimator->keyFrames() : std::vector<KeyFrameView>();
}
Status Odometry::status() const
{
	return impl_->estimator ? impl_->estimator->status() : Status::waiting;
}
std::vector<StatusChange> Odometry::statusChanges() const
{
	return impl_->estimator ? impl_->estimator->statusChanges() : std::vector<StatusChange>();
}
EstimatorCounters Odometry::counters() const
{
	return impl_->estimator ? impl_->estimator->counters() : EstimatorCounters();
}
CalibrationEstimate Odometry::calibrationEstimate() const
{
	return impl_->estimator ? impl_->estimator->calibration() : CalibrationEstimate();
}
CalibrationDeviations Odometry::calibrationDeviations() const
{
	return impl_->estimator ? impl_->estimator->calibrationDeviations() : CalibrationDeviations();
}
const Calibration* Odometry::calibration() const
{
	if (impl_->estimator) return &impl_->estimator->calibrationInUse();
	return impl_->calibration ? &*impl_->calibration : nullptr;
}
const std::map<std::string, RejectionCounts>& Odometry::observationCounts() const
{
	return impl_->adapter.counts();
}
int64_t Odometry::firstFrame_ns() const
{
	return impl_->first_frame_ns.value_or(0);
}
void Odometry::onFrame(std::function<void(const FrameEstimate&)> callback)
{
	impl_->on_frame = std::move(callback);
}
void Odometry::onImuRate(std::function<void(const NavState&)> callback)
{
	impl_->on_imu_rate = std::move(callback);
}
const StageTimes& Odometry::stageTimes() const
{
	return impl_->times;
}
}  // namespace viwo
