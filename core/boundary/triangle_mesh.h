// A triangle surface in double precision (metres).
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace molten {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;

/// Vertices in metres; triangles counter-clockwise seen from outside (a closed mesh's normals point outwards).
struct TriangleMesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::int32_t, 3>> triangles;

  bool empty() const { return triangles.empty(); }
};

}  // namespace molten
