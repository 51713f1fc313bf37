#include <viwo/core/Error.h>
#include <viwo/sim/Route.h>

#include <cmath>
#include <sstream>

namespace viwo::sim
{
namespace
{
[[noreturn]] void fail(const std::string& entry, const std::string& remedy)
{
	throw Error("[route] segments: cannot read '" + entry + "'; " + remedy);
}

std::string trimmed(const std::string& text)
{
	const size_t begin = text.find_first_not_of(" \t\r\n");
	return begin == std::string::npos ? std::string() : text.substr(begin, text.find_last_not_of(" \t\r\n") - begin + 1);
}

double number(std::istringstream& in, const std::string& unit, const std::string& entry)
{
	double value = 0;
	std::string found_unit;
	if (!(in >> value >> found_unit) || found_unit != unit || !std::isfinite(value))
		fail(entry, "expected a number followed by '" + unit + "'");
	return value;
}

RouteSegment parseSegment(const std::string& entry)
{
	std::istringstream in(entry);
	std::string word, rest;
	in >> word;
	RouteSegment s;
	const auto angle = [&] { return number(in, "deg", entry) * M_PI / 180; };
	if (word == "straight")
	{
		s.kind = RouteSegment::Kind::straight;
		s.length_m = number(in, "m", entry);
	}
	else if (word == "rotate")
	{
		s.kind = RouteSegment::Kind::rotate;
		s.angle_rad = angle();
	}
	else if (word == "arc")
	{
		s.kind = RouteSegment::Kind::arc;
		s.radius_m = number(in, "m", entry);
		s.angle_rad = angle();
	}
	else if (word == "stand" || word == "free")
	{
		s.kind = word == "stand" ? RouteSegment::Kind::stand : RouteSegment::Kind::free;
		s.duration_s = number(in, "s", entry);
	}
	else
		fail(entry, "expected straight, rotate, arc, stand or free");
	if (in >> rest) fail(entry, "nothing may follow the last unit; separate segments by commas");
	if (s.length_m < 0 || s.radius_m < 0 || s.duration_s < 0) fail(entry, "lengths, radii and durations must not be negative");
	if (s.kind == RouteSegment::Kind::arc && s.radius_m < 1e-3) fail(entry, "the radius must be at least 0.001 m; use rotate");
	return s;
}

/** "N x (a, b)" -> "a, b, a, b, ...": one level of repetition is enough for a route. */
std::string withoutRepetitions(std::string text)
{
	for (size_t open; (open = text.find('(')) != std::string::npos;)
	{
		const size_t close = text.find(')', open);
		if (close == std::string::npos) fail(text.substr(open), "a parenthesis is not closed");
		const size_t comma = text.rfind(',', open);
		const size_t begin = comma == std::string::npos ? 0 : comma + 1;
		const std::string head = trimmed(text.substr(begin, open - begin));
		std::istringstream in(head);
		int count = 0;
		std::string x, rest;
		if (!(in >> count >> x) || x != "x" || (in >> rest) || count < 1 || count > 1000)
			fail(head, "expected 'N x (segments)', N from 1 to 1000");
		const std::string body = text.substr(open + 1, close - open - 1);
		std::string repeated = body;
		for (int i = 1; i < count; ++i) repeated.append(",").append(body);
		text = text.substr(0, begin) + repeated + text.substr(close + 1);
	}
	return text;
}
}  // namespace

std::vector<RouteSegment> Route::parsedSegments() const
{
	std::vector<RouteSegment> result;
	std::istringstream in(withoutRepetitions(segments) + ",");  // getline would pass over an empty entry at the end
	for (std::string entry; std::getline(in, entry, ',');)
	{
		entry = trimmed(entry);
		if (entry.empty()) fail(entry, "an entry between two commas is empty");
		result.push_back(parseSegment(entry));
	}
	if (result.empty()) fail(segments, "name at least one segment");
	return result;
}
}  // namespace viwo::sim
