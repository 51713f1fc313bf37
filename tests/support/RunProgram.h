#pragma once

#include "TempFolder.h"

#include <sys/wait.h>

#include <cstdlib>
#include <string>
#include <vector>

namespace viwo::testing
{
struct ProgramResult
{
	int status = -1;  //!< exit status; 128 + signal when killed
	std::string out, err;

	/** Lines of stderr. */
	size_t errorLines() const
	{
		size_t n = 0;
		for (const char c : err) n += c == '\n';
		return n;
	}
};

inline std::string quoted(const std::string& word)
{
	std::string text = "'";
	for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
	return text + "'";
}

/** Writes a file below the folder, making the folders that it needs; @return its full path. */
inline std::string write(const TempFolder& folder, const std::string& name, const std::string& content)
{
	std::filesystem::create_directories(std::filesystem::path(folder.file(name)).parent_path());
	writeFile(folder.file(name), content);
	return folder.file(name);
}

/** A shell's command without a terminal, whose outputs go to the folder. */
inline std::string commandLine(const std::string& program, const std::vector<std::string>& arguments, const TempFolder& folder)
{
	std::string command = quoted(program);
	for (const auto& argument : arguments) command += " " + quoted(argument);
	return command + " </dev/null >" + quoted(folder.file("out")) + " 2>" + quoted(folder.file("err"));
}

/** @param raw what std::system() returned. */
inline ProgramResult resultOf(int raw, const TempFolder& folder)
{
	ProgramResult result;
	result.status = WIFEXITED(raw) ? WEXITSTATUS(raw) : 128 + WTERMSIG(raw);
	result.out = readFile(folder.file("out"));
	result.err = readFile(folder.file("err"));
	return result;
}

/** Runs a program, without a terminal, and sends it a signal once a file is there and, after that, some time has passed. */
inline ProgramResult runAndSignal(const std::string& program, const std::vector<std::string>& arguments, int signal,
                                  const std::string& file, double after_s)
{
	const TempFolder folder;
	const std::string command = commandLine(program, arguments, folder);
	// At most a minute until the file is there.
	const std::string script = command + " & p=$!; for i in $(seq 600); do [ -e " + quoted(file) + " ] && break; sleep 0.1; done; sleep " +
	                           std::to_string(after_s) + "; kill -" + std::to_string(signal) + " $p; wait $p";
	return resultOf(std::system(script.c_str()), folder);
}

/** Runs a program to its end, without a terminal. @param environment e.g. "VIWO_SHARE=/x", put before the command. */
inline ProgramResult runProgram(const std::string& program, const std::vector<std::string>& arguments, const std::string& environment = {})
{
	const TempFolder folder;
	const std::string command = environment + " " + commandLine(program, arguments, folder);
	return resultOf(std::system(command.c_str()), folder);
}
}  // namespace viwo::testing
