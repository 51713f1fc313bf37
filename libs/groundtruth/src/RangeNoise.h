#pragma once

#include "Session.h"

namespace viwo::gt
{
/** Standard deviation of a single range: of the distance of beams from the line through their neighbours, a robust estimate (most beams lie
 * on smooth surfaces). Never less than 5 mm.
 */
double rangeNoise_m(const std::vector<Scan>& scans);
}  // namespace viwo::gt
