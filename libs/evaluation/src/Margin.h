#pragma once

#include <viwo/core/Svg.h>

#include <algorithm>
#include <string>

namespace viwo
{
/** Room for the figures at an axis that need more than pictures leave to them, e.g. northings. */
class Margin
{
   public:
	/** Figures of this size are to stand at the axis, one under the other. */
	void add(const std::string& figure) { characters_ = std::max(characters_, figure.size()); }
	/** What is missing on the left. */
	double missing() const
	{
		constexpr size_t kUsual = 5;
		constexpr double kCharacter = 6.8;
		return characters_ > kUsual ? kCharacter * static_cast<double>(characters_ - kUsual) : 0;
	}
	/** The picture's parts, moved to the right by it. */
	std::string moved(const std::string& body) const
	{
		return missing() > 0 ? "<g transform=\"translate(" + svgNumber(missing()) + " 0)\">\n" + body + "</g>\n" : body;
	}

   private:
	size_t characters_ = 0;
};
}  // namespace viwo
