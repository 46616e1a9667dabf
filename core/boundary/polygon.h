// Simple polygons: checked and cut into triangles.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/boundary/triangle_mesh.h"

namespace molten {

/// What is wrong with the polygon, empty when it is simple: at least 3 points, all finite and different, no two edges
/// that touch or cross.
std::string polygon_defect(const std::vector<Vec2>& points);

/// Twice the enclosed area (m²), positive when counter-clockwise.
double twice_area(const std::vector<Vec2>& points);

/// Ear clipping of a simple counter-clockwise polygon, concave or not: points.size() − 2 counter-clockwise triangles.
std::vector<std::array<std::int32_t, 3>> clip_ears(const std::vector<Vec2>& points);

}  // namespace molten
