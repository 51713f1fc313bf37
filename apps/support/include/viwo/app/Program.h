#pragma once

#include <CLI/CLI.hpp>

#include <cstdint>
#include <functional>
#include <string>

/** What every program of viwo does alike: arguments, one-line errors on stderr, exit status 0 done / 1 failed / 2 bad usage. */
namespace viwo::app
{
/** Runs `body` after parsing; --help, --version and --quiet are added. Any exception becomes one line "<program>: error: ..." and status 1,
 *  a usage error one line and status 2.
 */
int run(CLI::App& cli, int argc, char** argv, const std::function<int()>& body);

/** Set by SIGINT and SIGTERM; long loops look at it and finish what they have in good order. */
bool interrupted();

/** "[####......]  42%  00:12 left  <note>" on a terminal's stderr, at most ten times a second; nothing in a pipe or when quiet. */
class ProgressBar
{
   public:
	explicit ProgressBar(bool enabled);
	~ProgressBar();
	void update(double fraction, const std::string& note = {});
	/** Removes the bar, so that a log line can be printed. */
	void clear();

   private:
	bool enabled_;
	int64_t start_ms_ = 0, last_ms_ = 0;
};
}  // namespace viwo::app
