// Filling a closed region with particles on a lattice ([P] 6.5).
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/boundary/triangle_mesh.h"

namespace molten {

/// A closed region to fill: a mesh in 3-D or an outline in 2-D (the other one empty).
struct Region {
  TriangleMesh mesh;          // 3-D
  std::vector<Vec2> outline;  // 2-D, counter-clockwise
};

struct Filling {
  double spacing = 0;                // m
  double measure = 0;                // m³ (3-D) or m² (2-D) of all regions together
  std::vector<Vec3> positions;       // m; z = 0 in 2-D
  std::vector<std::int32_t> region;  // which region each position lies in
};

/// Fills the regions on one cubic (square) lattice. Exactly one of `count`, `spacing` is given. With `count` the
/// spacing is searched (and the lattice offset nudged) until the total is within 1 % of it, aiming at exactly it. Where
/// no lattice is that near (a small cube), cells of the top layer are left out. Inside tests by one Embree ray a
/// lattice column in 3-D (robust near edges: a ray that grazes an edge or vertex is moved by millionths of the mesh)
/// and by winding number in 2-D. Deterministic; the same for any thread count. Throws Error(usage) when a region is
/// smaller than one particle or the count would be absurd (> 2^31), Error(geometry) when regions overlap or are not
/// closed.
Filling fill(const std::vector<Region>& regions, int dimensions, std::optional<long long> count,
             std::optional<double> spacing);

}  // namespace molten
