#pragma once

#include <viwo/evaluation/Json.h>
#include <viwo/experiments/Request.h>

#include <string>

namespace viwo::experiments
{
/** Where figures come from. */
struct Provenance
{
	std::string version;  //!< of viwo
	std::string build;    //!< hash over the programs and libraries of viwo that ran
	/** The same of viwo-groundtruth; empty where its library cannot be found beside it. */
	std::string truth_build;
	bool has_truth = false;  //!< viwo-groundtruth is there
	std::string date;        //!< UTC
	Request request;
	std::string configuration;  //!< of the estimator: the one set for all sequences, as an INI file
	std::string interruption;   //!< ExperimentResult::interruption
};

/** @throws Error when a program is not there. */
Provenance provenanceOf(const Request& request, const std::string& programs);

Json toJson(const Provenance& provenance);
}  // namespace viwo::experiments
