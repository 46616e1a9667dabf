// The walls of a scene as one surface for pictures.
#include <Eigen/Geometry>
#include <cmath>

#include "io/geometry/assemble.h"

namespace molten {

namespace {

void append(TriangleMesh& all, const std::vector<Vec3>& vertices,
            const std::vector<std::array<std::int32_t, 3>>& triangles) {
  const auto first = static_cast<std::int32_t>(all.vertices.size());
  all.vertices.insert(all.vertices.end(), vertices.begin(), vertices.end());
  for (const auto& t : triangles) all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

/// A square of a plane about the fluid, `half` m to each side.
void append_plane(TriangleMesh& all, const Plane& plane, const Vec3& middle, double half) {
  const Vec3 n = Vec3(plane.normal.data()).normalized();
  const Vec3 foot = middle - (middle - Vec3(plane.point.data())).dot(n) * n;
  const Vec3 a = (std::abs(n[2]) < 0.9 ? n.cross(Vec3::UnitZ()) : n.cross(Vec3::UnitY())).normalized() * half;
  const Vec3 b = n.cross(a);
  append(all, {foot - a - b, foot + a - b, foot + a + b, foot - a + b}, {{0, 1, 2}, {0, 2, 3}});
}

/// A 2-D outline as strips standing on the picture's plane.
void append_outline(TriangleMesh& all, const Wall<2>& wall, double thickness) {
  for (const auto& f : wall.facets) {
    const Vec2 a = wall.vertices[f[0]], b = wall.vertices[f[1]];
    const Vec2 out = thickness * Vec2(b[1] - a[1], a[0] - b[0]).normalized();  // away from the fluid
    append(all,
           {{a[0], a[1], 0}, {b[0], b[1], 0}, {b[0] + out[0], b[1] + out[1], 0}, {a[0] + out[0], a[1] + out[1], 0}},
           {{0, 1, 2}, {0, 2, 3}});
  }
}

}  // namespace

TriangleMesh picture_of_walls(const Scene& scene, const Start& start) {
  TriangleMesh all;
  Eigen::AlignedBox3d fluid;
  for (const auto& x : start.position) fluid.extend(Vec3(x.data()));
  const Vec3 middle = fluid.center();
  const double half = 0.9 * fluid.sizes().maxCoeff();
  if (scene.dimensions == 2) {
    for (const Wall<2>& wall : build_walls<2>(scene, start.spacing)) {
      if (!wall.is_plane) {
        append_outline(all, wall, start.spacing);
        continue;
      }
      Wall<2> line;  // a long segment of it
      const Vec2 along(wall.plane_normal[1], -wall.plane_normal[0]);
      const Vec2 foot = wall.plane_point + (middle.head<2>() - wall.plane_point).dot(along) * along;
      line.vertices = {foot - half * along, foot + half * along};
      line.facets = {{0, 1}};
      append_outline(all, line, start.spacing);
    }
    return all;
  }
  for (const Boundary& boundary : scene.boundaries)
    if (boundary.shape.plane) append_plane(all, *boundary.shape.plane, middle, half);
  for (const Wall<3>& wall : build_walls<3>(scene, start.spacing))
    if (!wall.is_plane) append(all, wall.vertices, wall.facets);
  return all;
}

}  // namespace molten
