#include <fcntl.h>
#include <mrpt/core/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <viwo/core/Error.h>
#include <viwo/experiments/JobPool.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <thread>

namespace viwo::experiments
{
namespace
{
/** Longer than any job takes on a slow machine: a program that hangs must not hang the table. */
constexpr double kTimeLimit_s = 3600;

/** The costs that jobs are added with count like a job of this cost that took as long. */
constexpr double kKnown_s = 10;

double now_s()
{
	return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/** For a child right after fork: input and output to files. */
void redirect(const std::string& path, int descriptor)
{
	const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
	if (file >= 0) dup2(file, descriptor);
}

int spawn(const Job& job)
{
	std::vector<char*> argv;
	for (const std::string& word : job.command) argv.push_back(const_cast<char*>(word.c_str()));
	argv.push_back(nullptr);
	const int pid = fork();
	if (pid != 0) return pid;
	prctl(PR_SET_PDEATHSIG, SIGKILL);
	redirect("/dev/null", STDIN_FILENO);
	redirect(job.log_stem + ".out", STDOUT_FILENO);
	redirect(job.log_stem + ".err", STDERR_FILENO);
	execv(argv[0], argv.data());
	std::perror(argv[0]);
	_exit(127);
}

void stop(int pid)
{
	kill(pid, SIGKILL);
	waitpid(pid, nullptr, 0);
}

int spawnLoad()
{
	const int pid = fork();
	if (pid != 0) return pid;
	prctl(PR_SET_PDEATHSIG, SIGKILL);
	for (volatile double x = 1;; x = x * 1.0000001 + 1e-9)
		;
}

/** What cannot be read is made again. */
bool isThere(const Job& job)
{
	try
	{
		return job.there && job.there();
	}
	catch (const std::exception&)
	{
		return false;
	}
}

std::string describe(int status, const std::string& err_path)
{
	const std::string line = lastLine(err_path);
	if (WIFSIGNALED(status)) return "ended by signal " + std::to_string(WTERMSIG(status)) + (line.empty() ? "" : ": " + line);
	return line.empty() ? "exit status " + std::to_string(WEXITSTATUS(status)) : line;
}
}  // namespace

std::string lastLine(const std::string& path)
{
	std::ifstream file(path);
	std::string last;
	for (std::string line; std::getline(file, line);)
		if (!line.empty()) last = line;
	return last;
}

size_t JobPool::add(Job job)
{
	Entry entry;
	entry.job = std::move(job);
	entries_.push_back(std::move(entry));
	return entries_.size() - 1;
}

bool JobPool::run(size_t parallel, const JobHooks& hooks)
{
	hooks_ = hooks;
	parallel_ = std::max<size_t>(1, parallel);
	begin_s_ = now_s();
	try
	{
		endWhatIsThere();
		while (!allDone() && !interrupted())
		{
			startDue();
			collect();
			tellWhatRuns();
			std::this_thread::sleep_for(std::chrono::milliseconds(20));
		}
	}
	catch (...)
	{
		stopAll();
		throw;
	}
	stopAll();
	return allDone();
}

/** First of all, so that an interruption leaves no result unseen and the time that is left is that of work. */
void JobPool::endWhatIsThere()
{
	for (Entry& entry : entries_)
		if (due(entry) && isThere(entry.job)) end(entry, "");
}

void JobPool::startDue()
{
	for (Entry& entry : entries_)
		if (!entry.job.alone && running() < parallel_ && due(entry)) start(entry);
	if (running() > 0) return;
	const auto together = [](const Entry& e) { return !e.job.alone && e.state != State::done; };
	if (std::any_of(entries_.begin(), entries_.end(), together)) return;
	for (Entry& entry : entries_)
		if (running() == 0 && due(entry)) start(entry);
}

bool JobPool::due(Entry& entry)
{
	if (entry.state != State::waiting) return false;
	for (const size_t i : entry.job.after)
	{
		if (entries_[i].state != State::done) return false;
		if (entries_[i].error.empty()) continue;
		end(entry, entries_[i].job.label + ": " + entries_[i].error);
		return false;
	}
	return true;
}

void JobPool::start(Entry& entry)
{
	try
	{
		if (isThere(entry.job)) return end(entry, "");
		if (entry.job.prepare) entry.job.prepare();
	}
	catch (const std::exception& e)
	{
		return end(entry, e.what());
	}
	const unsigned cores = std::max(2U, std::thread::hardware_concurrency());
	if (entry.job.loaded)
		for (unsigned i = 1; i < cores; ++i) load_.push_back(spawnLoad());
	entry.pid = spawn(entry.job);
	if (entry.pid < 0) throw Error("cannot start " + entry.job.command.front());
	entry.begin_s = now_s();
	entry.state = State::running;
}

void JobPool::collect()
{
	for (Entry& entry : entries_)
	{
		if (entry.state != State::running) continue;
		if (now_s() - entry.begin_s > kTimeLimit_s) kill(entry.pid, SIGKILL);
		int status = 0;
		if (waitpid(entry.pid, &status, WNOHANG) != entry.pid) continue;
		entry.took_s = now_s() - entry.begin_s;
		entry.pid = 0;
		// Ctrl-C on a terminal reaches the programs as well: one that ends for that has not failed.
		if (status != 0 && interrupted()) return;
		std::string error;
		try
		{
			if (status != 0 && !(entry.job.tolerated && entry.job.tolerated()))
				error = describe(status, entry.job.log_stem + ".err");
			else if (entry.job.succeeded)
				entry.job.succeeded();
		}
		catch (const std::exception& e)
		{
			error = e.what();
		}
		end(entry, error);
	}
}

void JobPool::end(Entry& entry, const std::string& error)
{
	for (const int pid : load_) stop(pid);
	load_.clear();
	entry.error = error;
	entry.state = State::done;
	++ended_;
	if (hooks_.ended) hooks_.ended(report(&entry));
}

size_t JobPool::running() const
{
	return static_cast<size_t>(std::count_if(entries_.begin(), entries_.end(), [](const Entry& e) { return e.state == State::running; }));
}

bool JobPool::allDone() const
{
	return std::all_of(entries_.begin(), entries_.end(), [](const Entry& e) { return e.state == State::done; });
}

void JobPool::stopAll()
{
	for (const int pid : load_) stop(pid);
	load_.clear();
	for (Entry& entry : entries_)
	{
		if (entry.state != State::running) continue;
		if (entry.pid > 0) stop(entry.pid);
		entry.state = State::waiting;
	}
}

/** The pace of what has been done, for what has not: a program that runs counts with what it should still need. Costs are seconds: at first
 * they tell. */
double JobPool::left_s() const
{
	double cost_s = 0, took_s = 0;  // of what is done
	for (const Entry& e : entries_)
	{
		if (e.state != State::done || e.took_s <= 0) continue;
		cost_s += e.job.cost_s;
		took_s += e.took_s;
	}
	const double pace = (took_s + kKnown_s) / (cost_s + kKnown_s);
	double left_s = 0;
	for (const Entry& e : entries_)
		if (e.state == State::waiting)
			left_s += pace * e.job.cost_s;
		else if (e.state == State::running)
			left_s += std::max(0.0, pace * e.job.cost_s - (now_s() - e.begin_s));
	return left_s / static_cast<double>(parallel_);
}

/** @param entry that has ended, or runs; may be null. */
JobReport JobPool::report(const Entry* entry) const
{
	JobReport report;
	if (entry != nullptr)
	{
		report.label = entry->job.label;
		report.error = entry->error;
		report.took_s = entry->took_s;
	}
	report.done = ended_;
	report.total = entries_.size();
	report.elapsed_s = now_s() - begin_s_;
	report.left_s = left_s();
	return report;
}

void JobPool::tellWhatRuns() const
{
	if (!hooks_.running) return;
	const auto runs = [](const Entry& e) { return e.state == State::running; };
	const auto first = std::find_if(entries_.begin(), entries_.end(), runs);
	hooks_.running(report(first == entries_.end() ? nullptr : &*first));
}

std::string toLine(const JobReport& report)
{
	const auto clock = [](double seconds)
	{
		const int whole_s = static_cast<int>(seconds);
		return mrpt::format("%02d:%02d", whole_s / 60, whole_s % 60);
	};
	return "[" + std::to_string(report.done) + "/" + std::to_string(report.total) + "] " + clock(report.elapsed_s) + ", " +
	       clock(report.left_s) + " left" + "  " + report.label + mrpt::format(" (%.1f s)", report.took_s) +
	       (report.error.empty() ? "" : "  FAILED: " + report.error);
}
}  // namespace viwo::experiments
