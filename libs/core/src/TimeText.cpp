#include <viwo/core/TimeText.h>

#include <charconv>
#include <limits>

namespace viwo
{
namespace
{
bool isDigit(char c)
{
	return c >= '0' && c <= '9';
}

/** digits * 10^exponent, rounded to an integer. */
std::optional<int64_t> scaled(std::string digits, int exponent)
{
	bool round_up = false;
	if (exponent < 0)
	{
		const size_t cut = static_cast<size_t>(-exponent);
		if (cut > digits.size()) return 0;
		round_up = digits[digits.size() - cut] >= '5';
		digits.resize(digits.size() - cut);
	}
	else
	{
		if (digits.find_first_not_of('0') == std::string::npos) return 0;
		if (exponent > 19) return std::nullopt;
		digits.append(static_cast<size_t>(exponent), '0');
	}
	int64_t value = 0;
	if (!digits.empty())
	{
		const auto result = std::from_chars(digits.data(), digits.data() + digits.size(), value);
		if (result.ec != std::errc()) return std::nullopt;
	}
	if (round_up && value == std::numeric_limits<int64_t>::max()) return std::nullopt;
	return value + (round_up ? 1 : 0);
}
}  // namespace

std::optional<int64_t> parseSeconds(std::string_view text)
{
	const bool negative = !text.empty() && text[0] == '-';
	size_t i = !text.empty() && (text[0] == '-' || text[0] == '+') ? 1 : 0;
	std::string digits;
	int exponent = 9;
	bool after_point = false;
	for (; i < text.size() && (isDigit(text[i]) || (text[i] == '.' && !after_point)); i++)
	{
		if (text[i] == '.')
		{
			after_point = true;
			continue;
		}
		digits += text[i];
		if (after_point) exponent--;
	}
	if (digits.empty()) return std::nullopt;
	if (i < text.size())
	{
		if (text[i] != 'e' && text[i] != 'E') return std::nullopt;
		i += (i + 1 < text.size() && text[i + 1] == '+') ? 2 : 1;
		int e = 0;
		const auto result = std::from_chars(text.data() + i, text.data() + text.size(), e);
		if (result.ec != std::errc() || result.ptr != text.data() + text.size() || e > 100 || e < -100) return std::nullopt;
		exponent += e;
	}
	const auto magnitude = scaled(digits, exponent);
	if (!magnitude) return std::nullopt;
	return negative ? -*magnitude : *magnitude;
}

std::string formatSeconds(int64_t t_ns)
{
	const uint64_t magnitude = t_ns < 0 ? 0 - static_cast<uint64_t>(t_ns) : static_cast<uint64_t>(t_ns);
	std::string decimals = std::to_string(magnitude % 1000000000);
	decimals.insert(0, 9 - decimals.size(), '0');
	return (t_ns < 0 ? "-" : "") + std::to_string(magnitude / 1000000000) + "." + decimals;
}
}  // namespace viwo
