// Shapes of a scene file: the one shape key of a [fluid], [[fluid.body]] or [[boundary]] table.
#pragma once

#include <array>
#include <string_view>

#include "core/scene.h"
#include "io/scene/toml_reader.h"

namespace molten {

/// `keys` and those that read_shape understands.
TomlReader::Keys with_shape_keys(TomlReader::Keys keys);

bool has_shape(const TomlReader& table);

enum class ShapeUse { fluid, boundary };

/// Throws Error(usage) unless the table has exactly one shape, and one that `use` and the dimensions allow.
Shape read_shape(const TomlReader& table, int dimensions, ShapeUse use);

/// A point that must be given (m).
void read_point(const TomlReader& table, std::string_view key, std::array<double, 3>& point, int dimensions);

/// A box { min, max }, also the scene's domain.
Box read_box(const TomlReader& table, std::string_view key, int dimensions);

}  // namespace molten
