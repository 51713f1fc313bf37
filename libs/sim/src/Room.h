#pragma once

#include <memory>

#include "WorldElements.h"

namespace viwo::sim
{
/** Section [room.name]: floor, ceiling and four walls, with skirting and openings. */
std::unique_ptr<WorldElement> makeRoom();
}  // namespace viwo::sim
