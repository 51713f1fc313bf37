#pragma once

#include <viwo/groundtruth/Pose2.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace viwo::gt
{
/** The readings of wheel odometry, freed of what no robot can have driven, and interpolated.
 *
 *  A pose that leaps is a fault of the counter, not a motion: encoders that were reset, an odometry that starts again at its origin, a
 *  number torn on its way. What the log's own speeds allow, with a generous factor, is a motion.
 */
class OdometryTrack
{
   public:
	struct Reading
	{
		int64_t t_ns;
		Pose2 T;
		size_t jumps = 0;  //!< before it: steps that were guessed because the readings tell of an impossible one
	};

	/** Readings that are no numbers, beyond any place on Earth, or not behind the last one in time are counted and left out. */
	void add(int64_t t_ns, const Pose2& T);

	/** To be called before the readings of a further rawlog: its odometry may count from its own start. */
	void beginFile();

	/** To be called once all readings are in. Single wild readings are taken out; where the readings leap and stay there, the step is
	 * replaced by that of constant velocity. Where most steps are impossible nothing is left. */
	void clean();

	/** Nothing where no reading is near. To be called with increasing t_ns. */
	std::optional<Reading> at(int64_t t_ns);

	size_t size() const { return readings_.size(); }
	size_t leftOut() const { return left_out_; }
	size_t jumps() const { return jumps_; }
	double largestJump_m() const { return largest_m_; }
	double largestJump_rad() const { return largest_rad_; }
	/** Whether clean() has found that most of it is impossible. */
	bool useless() const { return useless_; }

   private:
	struct Limits
	{
		double period_s, speed_m_s, turn_rad_s;
	};
	void joinFiles();
	Limits limits() const;
	bool possible(const Reading& a, const Reading& b, const Limits& limits) const;
	size_t backFromSpike(size_t last_good, size_t k, const Limits& limits) const;
	Pose2 constantVelocity(const std::vector<Reading>& kept, int64_t t_ns) const;

	std::vector<Reading> readings_;
	std::vector<size_t> file_begins_;
	size_t left_out_ = 0, jumps_ = 0, hint_ = 0;
	double largest_m_ = 0, largest_rad_ = 0;
	bool useless_ = false;
};
}  // namespace viwo::gt
