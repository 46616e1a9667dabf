// Named sets of numerics: "molten" (the best measured), "internal" (the same for flows without
// free surfaces) and the sources' own, for replication.
#pragma once

#include <optional>
#include <string_view>

#include "core/scene.h"

namespace molten {

/// Empty when this version does not have the preset.
std::optional<Numerics> find_preset(std::string_view name);

}  // namespace molten
