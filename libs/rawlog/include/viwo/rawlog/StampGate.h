#pragma once

#include <mrpt/obs/CObservation.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace viwo
{
/** Keeps observations out whose stamps lie absurdly far from the stream: a clock that was not set yet, a damaged stamp, another clock.
 *
 *  An observation whose stamp jumps is held back until it is clear where the stream goes on: at its old place, then the observation is
 *  rejected; or, for all sensors, at the new one, then nothing is lost and the jump is a gap. The same goes for the first observations,
 *  unless the first is trusted. At most about two seconds of data are held. What comes out depends on order and stamps alone.
 */
class StampGate
{
   public:
	struct Verdict
	{
		std::vector<mrpt::obs::CObservation::Ptr> passed, rejected;  //!< each in the order of arrival
	};

	/** @param max_jump_s 0: everything passes.
	 *  @param trusts_first the first stamp starts the stream, so that nothing waits there.
	 */
	StampGate(double max_jump_s, bool trusts_first) : max_jump_s_(max_jump_s), trusts_first_(trusts_first) {}

	/** The next observation, which has a stamp. @return what it decides, about itself or about those held back before. */
	Verdict push(const mrpt::obs::CObservation::Ptr& observation);

	/** Nothing follows. @return all that were still held back. */
	Verdict finish();

   private:
	struct Held
	{
		int64_t t_ns;
		mrpt::obs::CObservation::Ptr observation;
	};

	bool near(int64_t a_ns, int64_t b_ns) const;
	double spanAround_s(int64_t t_ns) const;
	size_t countAround(int64_t t_ns) const;
	void moveTo(int64_t t_ns, Verdict& verdict);
	void rejectHeld(Verdict& verdict);

	double max_jump_s_;
	bool trusts_first_;
	std::optional<int64_t> stream_ns_;  //!< newest stamp that passed
	int64_t stream_at_hold_ns_ = 0;
	std::vector<Held> held_;
};
}  // namespace viwo
