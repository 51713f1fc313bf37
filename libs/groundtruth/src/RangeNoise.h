#pragma once

#include "Session.h"

namespace viwo::gt
{
/** Standard deviation of a single range: of the distance of beams from the line through their neighbours, a robust estimate (most beams lie
 * on smooth surfaces). Never less than 5 mm.
 */
double rangeNoise_m(const std::vector<Scan>& scans);

/** Takes all beams from scans that show no surface: hardly any of their beams lies on the line through its neighbours. @return how many.
 */
size_t blankNoise(std::vector<Scan>& scans, double noise_m);
}  // namespace viwo::gt
