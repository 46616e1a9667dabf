// Named sets of numerics: "basic" (no corrections: the cheapest steps), "internal" (corrected gradients and shifting),
// "molten" (the one of these two that the study finds best for the kind of scene) and the sources' own, for
// replication.
#pragma once

#include <optional>
#include <string_view>

#include "core/scene.h"

namespace molten {

/// Empty when this version does not have the preset. Of the scene, gravity, periodic axes and the fluid must be known.
std::optional<Numerics> find_preset(std::string_view name, const Scene& scene = {});

}  // namespace molten
