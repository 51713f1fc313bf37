#include <viwo/app/Program.h>

#include <mrpt/core/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

namespace viwo::app
{
namespace
{
constexpr int kCells = 20;
constexpr int64_t kPeriod_ms = 100;
/** Before this the time left is a guess not worth showing. */
constexpr int64_t kFirstEstimate_ms = 1000;

int64_t now_ms()
{
	using namespace std::chrono;
	return duration_cast<milliseconds>(steady_clock::now().time_since_epoch()).count();
}

/** A line that is longer than the terminal is wide would stay there at each update. */
std::string cutToTerminal(std::string line)
{
	winsize size = {};
	if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1 && line.size() >= size.ws_col) line.resize(size.ws_col - 1u);
	return line;
}
}  // namespace

ProgressBar::ProgressBar(bool enabled) : enabled_(enabled && !quiet() && isatty(STDERR_FILENO) == 1), start_ms_(now_ms()) {}

ProgressBar::~ProgressBar()
{
	clear();
}

std::string ProgressBar::render(double fraction, double left_s, const std::string& note)
{
	if (!std::isfinite(fraction)) fraction = 0;
	fraction = std::clamp(fraction, 0.0, 1.0);
	const int full = static_cast<int>(fraction * kCells);
	std::string line = "[" + std::string(static_cast<size_t>(full), '#') + std::string(static_cast<size_t>(kCells - full), '.') +
	                   mrpt::format("] %3d%%  ", static_cast<int>(fraction * 100));
	if (left_s >= 0)
	{
		const long seconds = std::lround(std::min(left_s, 359999.0));
		line += seconds >= 3600 ? mrpt::format("%ld:%02ld:%02ld left", seconds / 3600, seconds / 60 % 60, seconds % 60)
		                        : mrpt::format("%02ld:%02ld left", seconds / 60, seconds % 60);
	}
	else
		line += "--:-- left";
	if (!note.empty()) line += "  " + note;
	return line;
}

void ProgressBar::update(double fraction, const std::string& note)
{
	if (!enabled_) return;
	const int64_t now = now_ms();
	if (visible_ && now - last_ms_ < kPeriod_ms) return;
	last_ms_ = now;
	const double elapsed_s = static_cast<double>(now - start_ms_) * 1e-3;
	const bool known = now - start_ms_ >= kFirstEstimate_ms && fraction > 1e-3;
	const double left_s = known ? elapsed_s * (1 - std::min(fraction, 1.0)) / fraction : -1;
	std::fprintf(stderr, "\r%s\033[K", cutToTerminal(render(fraction, left_s, note)).c_str());
	std::fflush(stderr);
	visible_ = true;
}

void ProgressBar::clear()
{
	if (!visible_) return;
	std::fputs("\r\033[K", stderr);
	std::fflush(stderr);
	visible_ = false;
}
}  // namespace viwo::app
