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
	/** Whether its result is there already, so that there is nothing to do. May be empty. */
	std::function<bool()> there;
	/** Called right before the program starts. May be empty. */
	std::function<void()> prepare;
	std::vector<std::string> command;  //!< program and arguments
	std::string log_stem;              //!< its output goes to files of this name with .out and .err added
	/** Called when the program has ended with another status than 0. @return true when it did its work all the same. May be empty. */
	std::function<bool()> tolerated;
	/** Called when the program has done its work. */
	std::function<void()> succeeded;
	bool alone = false;   //!< nothing else runs beside it
	bool loaded = false;  //!< alone, while every other core is kept busy
	double cost_s = 1;    //!< about how long it takes: for the time that is left
};

/** How far a pool has come. */
struct JobReport
{
	std::string label, error;  //!< of the job that has ended; no error: it succeeded. While jobs run: the label of the first of them
	double took_s = 0;         //!< 0: there was nothing to do
	size_t done = 0, total = 0;
	double elapsed_s = 0;
	double left_s = 0;

	/** Of the time, that has passed. */
	double fraction() const { return left_s > 0 ? elapsed_s / (elapsed_s + left_s) : 1; }
};

/** "[3/40] 01:20, 12:30 left  run seq05-s1-viwo (31.2 s)". */
std::string toLine(const JobReport& report);

/** Hooks of a pool's run; each may be empty. */
struct JobHooks
{
	std::function<bool()> interrupted = {};
	std::function<void(const JobReport&)> ended = {};    //!< when a job ends
	std::function<void(const JobReport&)> running = {};  //!< many times a second
};

/** Runs programs side by side, each as soon as those it waits for are done; the order of what is equally due is that of adding. */
class JobPool
{
   public:
	/** @return the job's index. */
	size_t add(Job job);

	/** Runs all jobs, at most `parallel` at a time. A job that fails fails those after it too.
	 *  @return false when interrupted: programs that run are ended, and what has not come to its end is open.
	 */
	[[nodiscard]] bool run(size_t parallel, const JobHooks& hooks);

	/** Why a job failed, one line; empty for one that succeeded. */
	const std::string& error(size_t index) const { return entries_[index].error; }
	/** Whether it has not come to its end. */
	bool open(size_t index) const { return entries_[index].state != State::done; }

	size_t size() const { return entries_.size(); }
	/** How many are open. */
	size_t open() const { return entries_.size() - ended_; }

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
		double begin_s = 0, took_s = 0;  //!< 0: there was nothing to do
	};

	bool interrupted() const { return hooks_.interrupted && hooks_.interrupted(); }
	void endWhatIsThere();
	void startDue();
	void start(Entry& entry);
	void collect();
	void end(Entry& entry, const std::string& error);
	bool due(Entry& entry);
	size_t running() const;
	bool allDone() const;
	void stopAll();
	JobReport report(const Entry* entry) const;
	void tellWhatRuns() const;
	double left_s() const;

	std::vector<Entry> entries_;
	std::vector<int> load_;  //!< processes that keep the other cores busy
	JobHooks hooks_;
	size_t ended_ = 0, parallel_ = 1;
	double begin_s_ = 0;
};

/** Last line of what a program wrote to stderr; empty when it wrote nothing. */
std::string lastLine(const std::string& path);
}  // namespace viwo::experiments
