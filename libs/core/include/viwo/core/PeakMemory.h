#pragma once

namespace viwo
{
/** Largest resident size of this process so far, MiB. */
double peakMemory_mb();
}  // namespace viwo
