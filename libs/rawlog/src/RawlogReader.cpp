#include <mrpt/core/format.h>
#include <mrpt/obs/CObservationImage.h>
#include <viwo/core/Error.h>
#include <viwo/core/Joined.h>
#include <viwo/core/Time.h>
#include <viwo/rawlog/MrptTime.h>
#include <viwo/rawlog/RawlogReader.h>
#include <viwo/rawlog/RigFile.h>
#include <viwo/rawlog/StampGate.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "ImageFolder.h"
#include "RawlogSequence.h"

using mrpt::obs::CObservation;

namespace viwo
{
std::string RawlogCounts::describe() const
{
	std::string text;
	for (const auto& [key, sensor] : sensors)
		text += (text.empty() ? "" : ", ") + (key.first.empty() ? "(empty)" : key.first) + " (" + std::to_string(sensor.read) + " " +
		        key.second + ")";
	return text.empty() ? "none" : text;
}

std::string rawlogNames(const std::vector<std::string>& paths)
{
	return joined(paths);
}

struct RawlogReader::Impl
{
	/** An observation that waits for its turn, or the message to give at its turn. */
	struct Queued
	{
		CObservation::Ptr observation;
		std::string error;
	};

	Impl(const std::vector<std::string>& paths, const RawlogReaderOptions& options)
	    : options(options),
	      source(paths, options.action_odometry_label, options.allow_truncated),
	      images(source.path()),
	      gate(options.max_stamp_jump_s, false),
	      window_ns(nanoseconds(options.reorder_window_s))
	{
	}

	CObservation::Ptr next();
	void readEntry();
	bool readEntry(std::vector<CObservation::Ptr>& observations);
	void requireOrder(const std::vector<CObservation::Ptr>& observations) const;
	void accept(const CObservation::Ptr& observation);
	void judged(const StampGate::Verdict& verdict);
	void enqueue(const CObservation::Ptr& observation);
	RawlogCounts::Sensor& sensorOf(const CObservation& o) { return counts.sensors[{o.sensorLabel, shortClassName(o)}]; }
	bool resolveImage(const CObservation::Ptr& observation, std::string& error);
	bool wanted(const std::string& label) const
	{
		return options.labels.empty() || std::find(options.labels.begin(), options.labels.end(), label) != options.labels.end();
	}

	RawlogReaderOptions options;
	RawlogSequence source;
	ImageFolder images;
	StampGate gate;
	RawlogCounts counts;
	int64_t window_ns;
	std::map<const CObservation*, std::string> errors;  //!< of observations that are still at the gate
	std::multimap<int64_t, Queued> queue;               //!< by stamp; of equal stamps in the order of the file
	int64_t newest_ns = std::numeric_limits<int64_t>::min();
	std::optional<int64_t> last_delivered_ns;
	bool ended = false;
	std::string final_error;
};

bool RawlogReader::Impl::resolveImage(const CObservation::Ptr& observation, std::string& error)
{
	const auto image = std::dynamic_pointer_cast<mrpt::obs::CObservationImage>(observation);
	if (!image || !image->image.isExternallyStored()) return true;
	const std::string name = image->image.getExternalStorageFile();
	std::string reason;
	const std::string file = images.find(name, reason);
	if (file.empty())
	{
		error = source.path() + ": entry " + std::to_string(counts.entries) + ": image file " + name + " is missing: " + reason;
		return false;
	}
	image->image.setExternalStorage(file);
	return true;
}

void RawlogReader::Impl::accept(const CObservation::Ptr& observation)
{
	auto& sensor = sensorOf(*observation);
	sensor.read++;
	if (observation->timestamp == INVALID_TIMESTAMP)
	{
		sensor.unstamped++;
		return;
	}
	const int64_t t_ns = nanosecondsOf(observation->timestamp);
	const bool is_first = sensor.read == sensor.unstamped + 1;
	sensor.first_t_ns = is_first ? t_ns : std::min(sensor.first_t_ns, t_ns);
	sensor.last_t_ns = is_first ? t_ns : std::max(sensor.last_t_ns, t_ns);
	if (!wanted(observation->sensorLabel)) return;
	if (options.rig) options.rig->apply(*observation);
	std::string error;
	if (!resolveImage(observation, error))
	{
		sensor.missing_images++;
		if (options.skip_missing_images) return;
		errors[observation.get()] = error;
	}
	judged(gate.push(observation));
}

void RawlogReader::Impl::judged(const StampGate::Verdict& verdict)
{
	for (const auto& observation : verdict.passed) enqueue(observation);
	for (const auto& observation : verdict.rejected)
	{
		errors.erase(observation.get());
		sensorOf(*observation).stamp_jumps++;
	}
}

void RawlogReader::Impl::enqueue(const CObservation::Ptr& observation)
{
	const int64_t t_ns = nanosecondsOf(observation->timestamp);
	std::string error;
	if (const auto it = errors.find(observation.get()); it != errors.end())
	{
		error = std::move(it->second);
		errors.erase(it);
	}
	if (last_delivered_ns && t_ns < *last_delivered_ns)
	{
		sensorOf(*observation).late++;
		counts.late++;
		return;
	}
	newest_ns = std::max(newest_ns, t_ns);
	queue.emplace(t_ns, Queued{observation, error});
}

/** Rawlogs given in another order than that of their time would lose all of the later ones as late. */
void RawlogReader::Impl::requireOrder(const std::vector<CObservation::Ptr>& observations) const
{
	for (const auto& o : observations)
	{
		if (o->timestamp == INVALID_TIMESTAMP || !wanted(o->sensorLabel) || counts.entries == 0) continue;
		const int64_t t_ns = nanosecondsOf(o->timestamp);
		if (t_ns + window_ns >= newest_ns) continue;
		throw Error(source.path() + mrpt::format(": begins %.3f s before the end of ", secondsBetween(t_ns, newest_ns)) +
		            source.pathBefore() + "; give the rawlogs of one run in the order of their time");
	}
}

bool RawlogReader::Impl::readEntry(std::vector<CObservation::Ptr>& observations)
{
	const size_t file = source.file();
	const bool more = source.readEntry(observations);
	if (source.file() == file) return more;
	images = ImageFolder(source.path());
	requireOrder(observations);
	return more;
}

void RawlogReader::Impl::readEntry()
{
	std::vector<CObservation::Ptr> observations;
	try
	{
		ended = !readEntry(observations);
	}
	catch (const Error& e)
	{
		ended = true;
		final_error = e.what();
		observations.clear();
	}
	counts.entries = source.entries();
	for (const auto& observation : observations) accept(observation);
	if (ended) judged(gate.finish());
}

CObservation::Ptr RawlogReader::Impl::next()
{
	while (!ended && (queue.empty() || newest_ns - queue.begin()->first < window_ns)) readEntry();
	if (queue.empty())
	{
		if (final_error.empty()) return nullptr;
		const Error error(final_error);
		final_error.clear();
		throw error;
	}
	const auto front = queue.begin();
	last_delivered_ns = front->first;
	const Queued queued = std::move(front->second);
	queue.erase(front);
	if (!queued.error.empty()) throw Error(queued.error);
	return queued.observation;
}

RawlogReader::RawlogReader(const std::string& path, const RawlogReaderOptions& options)
    : RawlogReader(std::vector<std::string>{path}, options)
{
}
RawlogReader::RawlogReader(const std::vector<std::string>& paths, const RawlogReaderOptions& options)
    : impl_(std::make_unique<Impl>(paths, options))
{
}
RawlogReader::~RawlogReader() = default;
RawlogReader::RawlogReader(RawlogReader&&) noexcept = default;

CObservation::Ptr RawlogReader::next()
{
	return impl_->next();
}
bool RawlogReader::truncated() const
{
	return impl_->source.truncated();
}
const RawlogCounts& RawlogReader::counts() const
{
	return impl_->counts;
}
std::string RawlogReader::comment() const
{
	return impl_->source.comment();
}
const std::string& RawlogReader::imagesFolder() const
{
	return impl_->images.path();
}
double RawlogReader::progress() const
{
	return impl_->source.progress();
}
const std::string& RawlogReader::path() const
{
	return impl_->source.path();
}
}  // namespace viwo
