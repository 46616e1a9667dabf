// The sections of a scene file whose reading takes more than a few lines. Each throws Error(usage).
#pragma once

#include "core/scene.h"
#include "io/scene/toml_reader.h"

namespace molten {

Fluid read_fluid(const TomlReader& root, int dimensions);
/// [[vent]] and [[outflow]].
void read_vents(const TomlReader& root, Scene& scene);
Numerics read_numerics(const TomlReader& root, const Scene& scene);

}  // namespace molten
