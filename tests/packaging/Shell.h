#pragma once

#include <sstream>
#include <string>
#include <vector>

#include "Programs.h"
#include "RunProgram.h"
#include "TempFolder.h"

namespace viwo::testing
{
/** Runs a script with bash, in the C.UTF-8 locale. */
inline ProgramResult bash(const std::string& script, const std::vector<std::string>& arguments = {})
{
	std::vector<std::string> all{"--norc", "--noprofile", "-c", script, "bash"};
	all.insert(all.end(), arguments.begin(), arguments.end());
	return runProgram("/bin/bash", all, "LC_ALL=C.UTF-8");
}

inline std::vector<std::string> lines(const std::string& text)
{
	std::vector<std::string> all;
	std::istringstream stream(text);
	for (std::string line; std::getline(stream, line);) all.push_back(line);
	return all;
}
}  // namespace viwo::testing
