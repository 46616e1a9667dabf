// The flat parts of a triangle surface, and the edges where they meet: where a lattice of points can lie on it.
#pragma once

#include <array>
#include <vector>

#include "core/boundary/contact.h"

namespace molten {

/// Triangles side by side in one plane.
struct FlatPart {
  Point<3> normal, origin;              // unit; m, the corner that its lattice starts from
  std::array<Point<3>, 2> axis;         // unit, in the plane; the first along its longest edge
  std::array<double, 2> extent{};       // m, along the axes
  std::vector<std::int32_t> triangles;  // of the wall

  /// Within a triangle of it, seen along the normal.
  bool covers(const Wall<3>& wall, const Point<3>& x) const;
};

/// An edge of flat parts: where two meet, or the rim of an open surface.
struct FlatEdge {
  Point<3> from, to;              // m
  std::vector<Point<3>> normals;  // of the parts
};

/// A corner of flat parts.
struct FlatCorner {
  Point<3> at;  // m
  std::vector<Point<3>> normals;
};

struct FlatParts {
  std::vector<FlatPart> parts;
  std::vector<FlatEdge> edges;
  std::vector<FlatCorner> corners;
};

FlatParts flat_parts_of(const Wall<3>& wall);

}  // namespace molten
