#pragma once

#include <viwo/core/Error.h>
#include <viwo/core/SharedFiles.h>

#include <CLI/CLI.hpp>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

/** What every program of viwo does alike: arguments, one-line errors on stderr, exit status 0 done / 1 failed / 2 bad usage. */
namespace viwo::app
{
/** Arguments that parse one by one but make no sense together: reported as any bad usage, exit status 2. */
class UsageError : public Error
{
   public:
	using Error::Error;
};

/** Runs `body` after parsing; --help, --version and --quiet are added. Any exception becomes one line "<program>: error: ..." and status 1,
 *  a usage error one line and status 2; that an output (--output, --json and the like) is one of the inputs, or named twice, is such an
 * error. Outputs that are files (by the option's type name) are tried before `body` is entered. The program's name is the one given to
 * CLI::App, or that of the executable.
 */
int run(CLI::App& cli, int argc, char** argv, const std::function<int()>& body);

/** @name Checks of an option's value that CLI11 lacks: its ranges let "nan" pass, and name the largest double in 300 digits. @{ */
CLI::Validator nonNegative();  //!< a finite number, not below 0
CLI::Validator positive();     //!< a finite number above 0
CLI::Validator finite();
CLI::Validator between(double least, double most);  //!< a number, the limits included
CLI::Validator inside(double low, double high);     //!< a number, the limits excluded
CLI::Validator seed();                              //!< a whole number of at most 18 digits
CLI::Validator notEmpty();
/** @} */

/** Set by SIGINT and SIGTERM once run() has started; long loops look at it and finish what they have in good order.
 *  A second signal ends the program at once.
 */
bool interrupted();

/** For files whose names are not themselves arguments, but made of them.
 *  @throws UsageError when an output exists and is one of the inputs, or two outputs are the same file.
 */
void requireInputsAreKept(const std::vector<std::string>& inputs, const std::vector<std::string>& outputs);

/** Whether --quiet was given: results and errors only, no progress and no remarks. */
bool quiet();

/** What a result leaves in doubt, a line "<program>: note: ..." on stderr for each; nothing when quiet. */
void tellNotes(const std::vector<std::string>& notes);

/** Version of viwo, "0.1.0". */
std::string version();

using viwo::findShare;

/** "[####......]  42%  00:12 left  <note>" on a terminal's stderr, at most ten times a second; nothing in a pipe or when quiet. */
class ProgressBar
{
   public:
	explicit ProgressBar(bool enabled = true);
	~ProgressBar();
	ProgressBar(const ProgressBar&) = delete;
	ProgressBar& operator=(const ProgressBar&) = delete;

	/** @param fraction done, 0 to 1. */
	void update(double fraction, const std::string& note = {});
	/** Removes the bar, so that a log line can be printed. */
	void clear();

	/** The text of the bar, without the terminal's control characters. @param left_s seconds left, negative when not yet known. */
	static std::string render(double fraction, double left_s, const std::string& note);

   private:
	bool enabled_;
	bool visible_ = false;
	int64_t start_ms_ = 0, last_ms_ = 0;
};
}  // namespace viwo::app
