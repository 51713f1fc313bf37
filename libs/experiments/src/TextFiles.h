#pragma once

#include <string>

namespace viwo::experiments
{
/** @throws Error when it cannot be read. */
std::string readFile(const std::string& path);

/** Whether the file is there with just this content. */
bool holds(const std::string& path, const std::string& content);

/** With the folders above it, unless it is there. @throws Error that says why it cannot be. */
void createFolder(const std::string& path);

/** FNV-1a, 64 bit, as 16 hexadecimal digits: names for content. */
std::string hashOf(const std::string& content);
}  // namespace viwo::experiments
