#pragma once

#include <stdexcept>
#include <string>

namespace viwo
{
/** A problem the user can mend: one line saying what is wrong, where (file, section, entry), and the remedy.
 *  Programs print what() after "error: " on stderr and exit with 1. Never thrown from inside the estimator.
 */
class Error : public std::runtime_error
{
   public:
	using std::runtime_error::runtime_error;
};
}  // namespace viwo
