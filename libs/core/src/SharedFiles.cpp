#include <viwo/core/Error.h>
#include <viwo/core/Joined.h>
#include <viwo/core/SharedFiles.h>

#include <cstdlib>
#include <filesystem>
#include <set>
#include <vector>

namespace viwo
{
std::string findShare(const std::string& relative)
{
	namespace fs = std::filesystem;
	std::error_code ignored;
	std::vector<fs::path> roots;
	if (const char* environment = std::getenv("VIWO_SHARE"); environment != nullptr && *environment != '\0')
		roots.emplace_back(environment);
	const fs::path executable = fs::read_symlink("/proc/self/exe", ignored);
	if (!executable.empty()) roots.push_back((executable.parent_path() / VIWO_SHARE_FROM_BIN).lexically_normal());
	roots.emplace_back(VIWO_SHARE_IN_SOURCE);

	std::string looked_at;
	std::set<std::string> names;
	for (const fs::path& root : roots)
	{
		const fs::path candidate = root / relative;
		if (fs::exists(candidate, ignored)) return candidate.string();
		for (const auto& entry : fs::directory_iterator(candidate.parent_path(), ignored)) names.insert(entry.path().filename().string());
		looked_at += (looked_at.empty() ? "" : ", ") + root.string();
	}
	if (!names.empty()) throw Error("there is no shared file '" + relative + "'; there are: " + joined(names));
	throw Error("shared file '" + relative + "' not found in " + looked_at +
	            "; set VIWO_SHARE to the folder share/viwo of the installation");
}
}  // namespace viwo
