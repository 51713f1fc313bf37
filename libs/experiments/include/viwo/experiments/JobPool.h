#pragma once

#include <functional>
#include <string>
#include <vector>

namespace viwo::experiments
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
	/** Called when the program has ended with another status than 0. @return true when it did its work all the same. May be empty. */
	std::function<bool()> tolerated;
	/** Called when the program has done its work. */
	std::function<void()> succeeded;
	bool alone = false;   //!< nothing else runs beside it
	bool loaded = false;  //!< alone, while every other core is kept busy
	double cost_s = 1;    //!< about how long it takes: for the time that is left
};

/** How far a pool has come, told when a job ends. */
struct JobReport
{
	std::string label, error;  //!< of the job that has ended; no error: it succeeded
	double took_s = 0;         //!< 0: there was nothing to do
	size_t done = 0, total = 0;
	double elapsed_s = 0;
	double fraction = 0;  //!< of the cost that is done
	double left_s = -1;   //!< negative while nothing has been done that tells
};

/** "[3/40] 01:20, 12:30 left  run seq05-s1-viwo (31.2 s)". */
std::string toLine(const JobReport& report);

/** Hooks of a pool's run; each may be empty. */
struct JobHooks
{
	std::function<bool()> interrupted;
	std::function<void(const JobReport&)> ended;
};

/** Runs programs side by side, each as soon as those it waits for are done; the order of what is equally due is that of adding. */
class JobPool
{
   public:
	/** @return the job's index. */
	size_t add(Job job);

	/** Runs all jobs, at most `parallel` at a time. A job that fails fails those after it too.
	 *  @throws Error when interrupted; programs that run are ended first.
	 */
	void run(size_t parallel, const JobHooks& hooks);

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
	void report(const Entry& entry) const;

	std::vector<Entry> entries_;
	std::vector<int> load_;  //!< processes that keep the other cores busy
	JobHooks hooks_;
	size_t ended_ = 0;
	double begin_s_ = 0;
};

/** Last line of what a program wrote to stderr; empty when it wrote nothing. */
std::string lastLine(const std::string& path);
}  // namespace viwo::experiments
