#pragma once

#include <functional>
#include <string>
#include <vector>

namespace viwo::accuracy
{
/** A program to run. */
struct Job
{
	std::string label;
	std::vector<size_t> after;  //!< jobs of the pool that must have succeeded
	/** Called right before the program starts. @return false when there is nothing to do. */
	std::function<bool()> prepare;
	std::vector<std::string> command;  //!< program and arguments
	std::string log_stem;              //!< its output goes to <log_stem>.out and .err
	/** Called when the program has ended with status 0. */
	std::function<void()> succeeded;
	bool alone = false;   //!< nothing else runs beside it
	bool loaded = false;  //!< alone, while every other core is kept busy
};

/** Runs programs side by side, each as soon as those it waits for are done; the order of what is equally due is that of adding. */
class JobPool
{
   public:
	/** @return the job's index. */
	size_t add(Job job);

	/** Runs all jobs, at most `parallel` at a time, one line on stderr for each that ends. A job that fails fails those after it too.
	 *  @throws Error when interrupted; programs that run are ended first.
	 */
	void run(size_t parallel);

	/** Why a job failed, one line; empty for one that succeeded. */
	const std::string& error(size_t index) const { return entries_[index].error; }

   private:
	enum class State
	{
		waiting,
		running,
		done
	};
	struct Entry
	{
		Job job;
		State state = State::waiting;
		std::string error;
		int pid = 0;
		double begin_s = 0;
	};

	void startDue(size_t parallel);
	void start(Entry& entry);
	void collect();
	void end(Entry& entry, const std::string& error);
	bool due(Entry& entry);
	size_t running() const;
	bool allDone() const;
	void stopAll();
	void report(const Entry& entry);

	std::vector<Entry> entries_;
	std::vector<int> load_;  //!< processes that keep the other cores busy
	size_t reported_ = 0;
	double begin_s_ = 0;
};

/** Last line of what a program wrote to stderr; empty when it wrote nothing. */
std::string lastLine(const std::string& path);
}  // namespace viwo::accuracy
