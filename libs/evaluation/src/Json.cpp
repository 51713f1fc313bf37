#include <mrpt/core/format.h>
#include <viwo/core/AtomicFile.h>
#include <viwo/core/Error.h>
#include <viwo/evaluation/Json.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

namespace viwo
{
namespace
{
Json rounded(const Json& json)
{
	if (json.is_number_float())
	{
		const double value = json.get<double>();
		if (!std::isfinite(value)) return nullptr;
		return std::strtod(mrpt::format("%.9g", value).c_str(), nullptr);
	}
	Json copy = json;
	if (json.is_structured())
		for (auto& element : copy) element = rounded(element);
	return copy;
}
}  // namespace

std::string toText(const Json& json)
{
	return rounded(json).dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void saveJson(const std::string& path, const Json& json)
{
	writeAtomically(path, toText(json));
}

Json loadJson(const std::string& path)
{
	std::ifstream file(path);
	if (!file) throw Error(path + ": cannot be read");
	try
	{
		return Json::parse(file);
	}
	catch (const nlohmann::json::parse_error& e)
	{
		throw Error(path + ": not valid JSON at byte " + std::to_string(e.byte));
	}
}
}  // namespace viwo
