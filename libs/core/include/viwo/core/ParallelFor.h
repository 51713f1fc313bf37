#pragma once

#include <cstddef>
#include <functional>

namespace viwo
{
/** body(i) for all i < count on several threads; body may touch only what belongs to i, so that the result does not depend on their number.
 *  An exception of any body is thrown again.
 */
void parallelFor(size_t count, int threads, const std::function<void(size_t)>& body);
}  // namespace viwo
