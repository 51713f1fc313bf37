#include <mrpt/img/CImage.h>
#include <viwo/core/Time.h>
#include <viwo/frontend/FeatureTracker.h>
#include <viwo/odometry/Odometry.h>

#include <deque>
#include <opencv2/core.hpp>
#include <optional>

namespace viwo
{
/** Brings the streams together: images wait until IMU and wheels reach up to them, then the front-end and the estimator run. What happens depends
 *  on the order and the stamps of the observations alone, never on how fast they come.
 */
struct Odometry::Impl
{
	Odometry& owner;
	OdometryOptions options;
	std::optional<Calibration> calibration;
	ObservationAdapter adapter;
	mrpt::obs::CObservationImage::Ptr first_image;
	mrpt::obs::CObservationIMU::Ptr first_imu;

	std::unique_ptr<Estimator> estimator;
	std::unique_ptr<FeatureTracker> tracker;
	std::vector<ImuSample> early_imu;  //!< before the calibration was complete
	std::vector<WheelSample> early_wheels;
	std::deque<ImageRef> images;  //!< not yet processed
	int64_t stream_ns = 0;	//!< newest stamp of all
	int64_t latest_imu_ns = 0, latest_wheels_ns = 0;
	std::optional<int64_t> last_frame_ns, last_image_ns, first_sample_ns, first_frame_ns;

	FrameEstimate latest;
	Trajectory trajectory;
	std::function<void(const FrameEstimate&)> on_frame;
	std::function<void(const NavState&)> on_imu_rate;
	StageTimes times;
	size_t reported_changes = 0;

	Impl(Odometry& o, const OdometryOptions& opt) : owner(o), options(opt), adapter(opt.rawlog) {}

	const EstimatorOptions& est() const { return options.estimator; }
	void take(const ImuSample& s);
	void take(const WheelSample& s);
	bool makeEstimator(bool at_end);
	void drain(bool at_end);
	bool covered(int64_t t_ns) const;
	std::optional<int64_t> blindFrameDue() const;
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
	void stage(const std::string& name, bool begin)
	{
		if (begin)
		{
			owner.profiler.enter("odometry." + name);
			times.begin(name);
		}
		else
		{
			times.end(name);
			owner.profiler.leave("odometry." + name);
		}
	}
};

void Odometry::Impl::take(const ImuSample& s)
{
	latest_imu_ns = s.t_ns;
	if (!first_sample_ns) first_sample_ns = s.t_ns;
	if (estimator)
		estimator->addImu(s);
	else
		early_imu.push_back(s);
}

void Odometry::Impl::take(const WheelSample& s)
{
	latest_wheels_ns = s.t_ns;
	if (!first_sample_ns) first_sample_ns = s.t_ns;
	if (estimator)
		estimator->addWheels(s);
	else
		early_wheels.push_back(s);
}

bool Odometry::Impl::makeEstimator(bool at_end)
{
	if (estimator) return true;
	const bool has_image = first_image != nullptr, has_imu = first_imu != nullptr;
	if (!calibration)
	{
		if ((est().useCamera() && !has_image) || (est().useImu() && !has_imu)) return false;
		if (est().mode == Mode::wheel && !at_end && !has_imu && images.empty() && early_wheels.size() < 20) return false;
		calibration = calibrationFrom(adapter.options(), est().useCamera() ? first_image.get() : nullptr, has_imu ? first_imu.get() : nullptr);
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
	const bool imu = !est().useImu() || latest_imu_ns >= t_ns;
	const bool wheels = !est().useWheels() || latest_wheels_ns >= t_ns;
	return (imu && wheels) || secondsBetween(t_ns, stream_ns) > OdometryOptions::max_wait_s;
}

std::optional<int64_t> Odometry::Impl::blindFrameDue() const
{
	if (!images.empty()) return std::nullopt;
	const std::optional<int64_t> since = last_frame_ns ? last_frame_ns : est().useCamera() ? std::nullopt : first_sample_ns;
	if (!since) return std::nullopt;
	const bool camera_is_there = last_image_ns && secondsBetween(*last_image_ns, stream_ns) <= OdometryOptions::blind_after_s;
	if (camera_is_there || secondsBetween(*since, stream_ns) <= OdometryOptions::blind_after_s) return std::nullopt;
	return *since + nanoseconds(OdometryOptions::blind_period_s);
}

void Odometry::Impl::drain(bool at_end)
{
	if (!makeEstimator(at_end)) return;
	while (true)
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
	emitImuRate(t_ns);
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
	if (latest.has_pose) trajectory.push_back({t_ns, latest.T_WO});
	logStatus();
	if (on_frame) on_frame(latest);
}

void Odometry::Impl::emitImuRate(int64_t t_until_ns)
{
	if (!on_imu_rate || !last_frame_ns) return;
	for (const NavState& state : estimator->propagate(*last_frame_ns, t_until_ns)) on_imu_rate(state);
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

Odometry::Odometry(const OdometryOptions& options) : COutputLogger("viwo::Odometry"), profiler(true, "viwo::Odometry"), impl_(std::make_unique<Impl>(*this, options)) {}

Odometry::Odometry(const OdometryOptions& options, const Calibration& calibration) : Odometry(options) { impl_->calibration = calibration; }

Odometry::~Odometry()
{
	profiler.clear(true);  // or it prints its statistics
}

void Odometry::processObservation(const mrpt::obs::CObservation::Ptr& observation)
{
	Impl& i = *impl_;
	const AdaptedObservation adapted = i.adapter.convert(observation);
	if (const auto* imu = std::get_if<ImuSample>(&adapted.sample))
	{
		if (!i.first_imu) i.first_imu = std::dynamic_pointer_cast<mrpt::obs::CObservationIMU>(observation);
		i.take(*imu);
		i.stream_ns = std::max(i.stream_ns, imu->t_ns);
	}
	else if (const auto* wheels = std::get_if<WheelSample>(&adapted.sample))
	{
		i.take(*wheels);
		i.stream_ns = std::max(i.stream_ns, wheels->t_ns);
	}
	else if (const auto* image = std::get_if<ImageRef>(&adapted.sample))
	{
		if (!i.first_image) i.first_image = image->observation();
		i.images.push_back(*image);
		i.last_image_ns = image->t_ns;
		i.stream_ns = std::max(i.stream_ns, image->t_ns);
	}
	else
		return;
	i.drain(false);
}

void Odometry::finish()
{
	impl_->drain(true);
	// Nothing follows that the last images could wait for.
	if (impl_->estimator && impl_->last_frame_ns) impl_->emitImuRate(impl_->stream_ns);
}

const FrameEstimate& Odometry::latest() const { return impl_->latest; }
const Trajectory& Odometry::trajectory() const { return impl_->trajectory; }
std::vector<LandmarkPoint> Odometry::landmarks() const { return impl_->estimator ? impl_->estimator->landmarks() : std::vector<LandmarkPoint>(); }
Status Odometry::status() const { return impl_->estimator ? impl_->estimator->status() : Status::waiting; }
std::vector<StatusChange> Odometry::statusChanges() const { return impl_->estimator ? impl_->estimator->statusChanges() : std::vector<StatusChange>(); }
EstimatorCounters Odometry::counters() const { return impl_->estimator ? impl_->estimator->counters() : EstimatorCounters(); }
CalibrationEstimate Odometry::calibrationEstimate() const { return impl_->estimator ? impl_->estimator->calibration() : CalibrationEstimate(); }
const Calibration* Odometry::calibration() const { return impl_->calibration ? &*impl_->calibration : nullptr; }
const std::map<std::string, RejectionCounts>& Odometry::observationCounts() const { return impl_->adapter.counts(); }
int64_t Odometry::firstFrame_ns() const { return impl_->first_frame_ns.value_or(0); }
void Odometry::onFrame(std::function<void(const FrameEstimate&)> callback) { impl_->on_frame = std::move(callback); }
void Odometry::onImuRate(std::function<void(const NavState&)> callback) { impl_->on_imu_rate = std::move(callback); }
const StageTimes& Odometry::stageTimes() const { return impl_->times; }
}  // namespace viwo
