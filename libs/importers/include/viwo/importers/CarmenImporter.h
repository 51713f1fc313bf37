#pragma once

#include <viwo/importers/ImportJob.h>

namespace viwo
{
/** A CARMEN log (plain, .gz or .bz2) as a rawlog.
 *
 *  Scans keep the name of their line as label (FLASER, RLASER, ROBOTLASER1). The odometry on the line of the (front) scan is written under
 *  ODOMETRY with the scan's own stamp; ODOM lines, whose clock may lag, go under ODOM. The order of the file is the truth: where stamps run
 *  back, strictly increasing ones are written, the nearest in the sense of least squares; X_stamps.csv (`rawlog_ns,original_s`) leads from
 *  one to the other.
 *
 *  @param job its folder is the log.
 *  @throws Error naming file and line.
 */
ImportResult importCarmen(const ImportJob& job);
}  // namespace viwo
