#pragma once

#include <viwo/sim/World.h>

#include "Texture.h"

namespace viwo::sim
{
/** True where the picture depends on the size and variant of the surface that carries it; otherwise one texture serves a material. */
bool isFitted(TextureKind kind);

/** The picture of a material on a surface of that size. Same arguments, same texels. */
Canvas paintTexture(const Material& material, double width_m, double height_m, uint32_t variant);
}  // namespace viwo::sim
