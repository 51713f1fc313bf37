#include "ObservationSource.h"

#include <mrpt/maps/registerAllClasses.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <viwo/core/Error.h>

#include <cctype>
#include <filesystem>

namespace fs = std::filesystem;
using mrpt::obs::CObservation;

namespace viwo
{
namespace
{
/** Is what follows the head of a serialised object: a length (7 bits) and a class name? */
enum class Head
{
	object,
	cut_short,
	something_else
};

Head headAt(GzipArchiveReader& archive)
{
	const std::string first = archive.peek(1);
	if (first.empty()) return Head::cut_short;
	const size_t length = static_cast<unsigned char>(first[0]) & 0x7Fu;
	const std::string name = archive.peek(1 + length).substr(1);
	for (char c : name)
		if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_' && c != ':') return Head::something_else;
	if (length < 2) return Head::something_else;
	return name.size() < length ? Head::cut_short : Head::object;
}

std::string entryCount(uint64_t n)
{
	return std::to_string(n) + (n == 1 ? " entry" : " entries");
}

/** The class in MRPT's "Stored object has class 'X' which is not registered!"; also of an object inside of a sensory frame. */
std::string unregisteredClass(const std::string& mrpt_message)
{
	const std::string before = "has class '", after = "' which is not registered";
	const size_t end = mrpt_message.find(after);
	const size_t begin = end == std::string::npos ? end : mrpt_message.rfind(before, end);
	if (begin == std::string::npos) return {};
	return mrpt_message.substr(begin + before.size(), end - begin - before.size());
}

const std::string kBagMark = "#ROSBAG V";

/** Of the ways to pack a file, rawlogs know gzip alone. */
void refuseOtherCompression(const std::string& path, const std::string& first_bytes)
{
	if (first_bytes == "\x28\xB5\x2F\xFD")
		throw Error(path + ": compressed by zstd, which is not read here; unpack it first: zstd -d < " + path + " > plain.rawlog");
	if (first_bytes == "PK\x03\x04")
		throw Error(path + ": a zip archive, not a rawlog; unpack it first (unzip " + path + ") and give the rawlog inside");
}
}  // namespace

std::string shortClassName(const CObservation& observation)
{
	const std::string name = observation.GetRuntimeClass()->className;
	const size_t colon = name.rfind(':');
	return colon == std::string::npos ? name : name.substr(colon + 1);
}

ObservationSource::ObservationSource(const std::string& path, const ActionOdometry& action_odometry)
    : path_(path), archive_(path), action_odometry_(action_odometry)
{
	// Point clouds and rotating scans are stock observations that live in mrpt-maps.
	static const bool registered = (mrpt::maps::registerAllClasses_mrpt_maps(), true);
	(void)registered;
	std::error_code ignored;
	file_bytes_ = fs::file_size(path, ignored);
	if (ignored) file_bytes_ = 0;
	refuseOtherCompression(path, archive_.peek(4));
	if (archive_.atEnd()) throw Error(path + ": no entries in this rawlog; record or copy it again");
	if (archive_.peek(kBagMark.size()) == kBagMark)
		throw Error(path + ": a ROS bag, not a rawlog; make one of it first: viwo-import rosbag " + path + " -o " +
		            fs::path(path).stem().string() + ".rawlog");
	if (headAt(archive_) == Head::something_else) throw Error(path + ": not a rawlog (it does not start with an MRPT object)");
}

double ObservationSource::progress() const
{
	return file_bytes_ == 0 ? 0 : std::min(1.0, static_cast<double>(archive_.position()) / static_cast<double>(file_bytes_));
}

void ObservationSource::failOnObject(const std::string& mrpt_message) const
{
	const std::string where = "after " + entryCount(entries_);
	if (truncated())
		throw Error(path_ + ": truncated: the file ends within an entry, " + where +
		            "; copy it again, or accept it with --allow-truncated");
	const std::string class_name = unregisteredClass(mrpt_message);
	if (!class_name.empty())
		throw Error(path_ + ": unknown class " + class_name + " " + where +
		            ": nothing behind it can be read; write the rawlog again without it, with the program that made it");
	throw Error(path_ + ": damaged " + where + ": nothing behind can be read; copy it again");
}

mrpt::serialization::CSerializable::Ptr ObservationSource::readObject()
{
	if (headAt(archive_) == Head::something_else && archive_.state() == GzipArchiveReader::State::good) failOnObject("");
	std::string message;
	try
	{
		return archive_.ReadObject();
	}
	catch (const std::exception& e)
	{
		message = e.what();
	}
	failOnObject(message);
}

bool ObservationSource::readEntry(std::vector<CObservation::Ptr>& observations)
{
	observations.clear();
	if (archive_.atEnd())
	{
		observations.swap(waiting_);
		return !observations.empty();
	}
	const auto object = readObject();
	if (!object) failOnObject("");
	addEntry(object, observations);
	return true;
}

void ObservationSource::addEntry(const mrpt::serialization::CSerializable::Ptr& object, std::vector<CObservation::Ptr>& observations)
{
	if (const auto rawlog = std::dynamic_pointer_cast<mrpt::obs::CRawlog>(object))
	{
		for (const auto& entry : *rawlog) addEntry(entry, observations);
		return;
	}
	entries_++;
	if (const auto comment = std::dynamic_pointer_cast<mrpt::obs::CObservationComment>(object))
		comment_ += comment->text;
	else if (const auto observation = std::dynamic_pointer_cast<CObservation>(object))
		observations.push_back(observation);
	else if (const auto actions = std::dynamic_pointer_cast<mrpt::obs::CActionCollection>(object))
	{
		for (size_t i = 0; i < actions->size(); i++)
		{
			const auto movement = std::dynamic_pointer_cast<mrpt::obs::CActionRobotMovement2D>(actions->get(i));
			if (!movement || movement->estimationMethod != mrpt::obs::CActionRobotMovement2D::emOdometry) continue;
			const auto odometry = action_odometry_.add(*movement);
			(odometry->timestamp == INVALID_TIMESTAMP ? waiting_ : observations).push_back(odometry);
		}
	}
	else if (const auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object))
	{
		auto stamp = INVALID_TIMESTAMP;
		for (const auto& o : *frame)
			if (stamp == INVALID_TIMESTAMP) stamp = o->timestamp;
		const auto stamped = [&](const CObservation::Ptr& o)
		{
			if (o->timestamp == INVALID_TIMESTAMP) o->timestamp = stamp;
			return o;
		};
		if (stamp != INVALID_TIMESTAMP)
		{
			for (const auto& o : waiting_) observations.push_back(stamped(o));
			waiting_.clear();
		}
		for (const auto& o : *frame) observations.push_back(stamped(o));
	}
	else if (entries_ == 1)
		throw Error(path_ + ": not a rawlog: it holds an object of class " + object->GetRuntimeClass()->className);
}
}  // namespace viwo
