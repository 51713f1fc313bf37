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
		constexpr double kThere = 29, kCharacter = 7.7;
		const double needed = kCharacter * static_cast<double>(characters_);
		return characters_ > 4 ? needed - kThere : 0;
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
