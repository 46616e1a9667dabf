// The `motion` and `body` of a [[boundary]]: walls that move.
#pragma once

#include "core/scene.h"
#include "io/scene/toml_reader.h"

namespace molten {

/// Throws Error(usage) on contradictions, also with the boundary's shape.
void read_motion(const TomlReader& boundary_keys, int dimensions, Boundary& boundary);

}  // namespace molten
