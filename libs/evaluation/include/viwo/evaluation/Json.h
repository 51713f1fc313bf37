#pragma once

#include <nlohmann/json.hpp>

#include <string>

namespace viwo
{
/** Keys stay in the order in which they were set. */
using Json = nlohmann::ordered_json;

/** Indented by two spaces, one newline at the end, numbers to nine significant digits, so that two runs that agree give the same bytes
 * whatever happens in the last bits. NaN and infinity become null.
 */
std::string toText(const Json& json);

/** Written to a temporary name and renamed. @throws Error when it cannot be written. */
void saveJson(const std::string& path, const Json& json);

/** @throws Error naming the file and the place: unreadable or not JSON. */
Json loadJson(const std::string& path);
}  // namespace viwo
