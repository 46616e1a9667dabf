// Simple polygons, and those with holes: checked and cut into triangles.
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

/// Whether two closed rings have a point of their edges in common.
bool rings_touch(const std::vector<Vec2>& a, const std::vector<Vec2>& b);

/// Whether the ring goes round p, in either sense.
bool goes_round(const std::vector<Vec2>& ring, const Vec2& p);

/// Ear clipping of a simple counter-clockwise polygon, concave or not: points.size() − 2 counter-clockwise triangles.
std::vector<std::array<std::int32_t, 3>> clip_ears(const std::vector<Vec2>& points);

/// The same of a polygon with holes: the first ring is the outline, counter-clockwise, the others are holes in it,
/// clockwise; no two touch. The triangles' corners count through all rings in turn. Holes are joined to the outline by
/// bridges that are walked both ways (D. Eberly, Triangulation by ear clipping, 2002).
std::vector<std::array<std::int32_t, 3>> clip_ears(const std::vector<std::vector<Vec2>>& rings);

}  // namespace molten
