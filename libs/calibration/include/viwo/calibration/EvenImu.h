#pragma once

#include <viwo/calibration/AllanDeviation.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace viwo
{
constexpr size_t kImuAxes = 6;

/** "acc x" ... "gyro z". */
const char* imuAxisName(size_t axis);
/** "m/s^2" or "rad/s". */
const char* imuAxisUnit(size_t axis);

/** Samples of an IMU as they were recorded: stamps rising, acceleration x y z (m/s^2), then rates x y z (rad/s). */
struct ImuRecord
{
	std::vector<int64_t> t_ns;
	std::array<std::vector<double>, kImuAxes> axes;
};

/** The same, each in the cell of an even grid to which it belongs. */
struct EvenImu
{
	struct Piece
	{
		int64_t first_t_ns = 0;
		size_t cells = 0;
	};
	int64_t log_start_ns = 0;  //!< times are told from here
	double interval_s = 0;
	std::vector<Piece> pieces;
	std::array<EvenPieces, kImuAxes> axes;  //!< NaN in cells without a sample
	size_t samples = 0, lost = 0;           //!< lost: cells without a sample
	double jitter_s = 0;                    //!< 90 % of the stamps' intervals are within this of the sensor's, lost samples aside
	double longest_gap_s = 0;

	double duration_s() const;  //!< of all pieces
	int64_t t_ns(size_t piece, size_t cell) const;
};

/** A sensor samples by its own steady clock, stamps come from whoever received them: samples are counted, and stamps only tell where some
 * were lost, by a delay that lasts. A gap of more than ten minutes starts a new piece. @pre at least two samples; emptied.
 * @throws Error: stamps that nearly all belong to lost samples. */
EvenImu evenlySampled(ImuRecord&& record);
}  // namespace viwo
