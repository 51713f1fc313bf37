#include "Provenance.h"

#include <link.h>
#include <unistd.h>
#include <viwo/core/Error.h>
#include <viwo/odometry/OdometryOptions.h>

#include <algorithm>
#include <ctime>
#include <filesystem>

#include "TextFiles.h"

namespace viwo::experiments
{
namespace
{
namespace fs = std::filesystem;

/** For dl_iterate_phdr: viwo's own libraries, which the programs share with this one. */
int collectLibrary(dl_phdr_info* info, size_t, void* list)
{
	if (fs::path(info->dlpi_name).filename().string().rfind("libviwo_", 0) == 0)
		static_cast<std::vector<std::string>*>(list)->push_back(info->dlpi_name);
	return 0;
}

std::string buildOf(const std::string& programs)
{
	std::vector<std::string> files;
	dl_iterate_phdr(collectLibrary, &files);
	// This library only judges: the runs do not depend on it.
	files.erase(std::remove_if(files.begin(), files.end(),
	                           [](const std::string& file)
	                           {
		                           return file.find("libviwo_experiments") != std::string::npos ||
		                                  file.find("libviwo_evaluation") != std::string::npos ||
		                                  file.find("libviwo_sim") != std::string::npos;
	                           }),
	            files.end());
	std::sort(files.begin(), files.end());
	std::string hashes = hashOf(readFile(programs + "/viwo-odometry"));
	for (const std::string& file : files) hashes += " " + hashOf(readFile(file));
	return hashOf(hashes);
}

/** The ground truth's library is not one of this program's: it is looked for where a build and an installation have it. */
std::string truthBuildOf(const std::string& programs, const std::string& build)
{
	const std::string program = programs + "/viwo-groundtruth";
	if (!fs::exists(program) || !fs::is_directory(programs + "/../lib")) return {};
	std::string hashes;
	for (const auto& entry : fs::recursive_directory_iterator(programs + "/../lib", fs::directory_options::skip_permission_denied))
		if (entry.path().filename() == "libviwo_groundtruth.so.0") hashes += " " + hashOf(readFile(entry.path().string()));
	return hashes.empty() ? "" : hashOf(build + hashOf(readFile(program)) + hashes);
}

std::string now()
{
	const std::time_t time = std::time(nullptr);
	std::tm utc{};
	gmtime_r(&time, &utc);
	char text[32];
	std::strftime(text, sizeof text, "%Y-%m-%d %H:%M UTC", &utc);
	return text;
}

/** All options of the estimator as viwo-odometry takes them without a configuration file. */
std::string defaultConfiguration()
{
	const fs::path path = fs::temp_directory_path() / ("viwo-experiments-" + std::to_string(getpid()) + ".ini");
	OdometryOptions options;
	saveOptions(path.string(), options.sections());
	const std::string text = readFile(path.string());
	fs::remove(path);
	return text;
}
}  // namespace

Provenance provenanceOf(const Request& request, const std::string& programs)
{
	for (const char* program : {"viwo-sim", "viwo-odometry"})
		if (!fs::exists(programs + "/" + program))
			throw Error(programs + "/" + program + ": not there; build it, or name its folder with --programs");
	Provenance provenance;
	provenance.version = VIWO_VERSION;
	provenance.build = buildOf(programs);
	provenance.truth_build = truthBuildOf(programs, provenance.build);
	provenance.has_truth = fs::exists(programs + "/viwo-groundtruth");
	provenance.date = now();
	provenance.request = request;
	provenance.configuration = defaultConfiguration();
	return provenance;
}

Json toJson(const Provenance& provenance)
{
	Json json;
	json["program"] = "viwo-experiments " + provenance.version;
	json["build"] = provenance.build;
	json["date"] = provenance.date;
	json["complete"] = provenance.interruption.empty();
	json["sequences"] = provenance.request.sequences;
	json["seeds"] = provenance.request.seeds;
	json["configuration"] = provenance.configuration;
	return json;
}
}  // namespace viwo::experiments
