// The walls of a scene as surfaces for pictures.
#include <Eigen/Geometry>
#include <cmath>

#include "io/geometry/assemble.h"
#include "io/geometry/bodies.h"

namespace molten {

namespace {

void append(TriangleMesh& all, const std::vector<Vec3>& vertices,
            const std::vector<std::array<std::int32_t, 3>>& triangles) {
  const auto first = static_cast<std::int32_t>(all.vertices.size());
  all.vertices.insert(all.vertices.end(), vertices.begin(), vertices.end());
  for (const auto& t : triangles) all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

/// What pictures show of the fluid: the middle, and how far planes reach from there (m).
struct View {
  Vec3 middle;
  double half;
};

View view_of(const Start& start) {
  Eigen::AlignedBox3d fluid;
  for (const auto& x : start.position) fluid.extend(Vec3(x.data()));
  for (const auto& x : start.vents) fluid.extend(Vec3(x.data()));
  const double size = start.position.empty() ? 60 * start.spacing : fluid.sizes().maxCoeff();
  return {fluid.center(), 0.9 * size};
}

/// A square of a plane about the fluid.
void append_plane(TriangleMesh& all, const Vec3& point, const Vec3& n, const View& view) {
  const Vec3 foot = view.middle - (view.middle - point).dot(n) * n;
  const Vec3 a = (std::abs(n[2]) < 0.9 ? n.cross(Vec3::UnitZ()) : n.cross(Vec3::UnitY())).normalized() * view.half;
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

void append_wall(TriangleMesh& all, const Wall<3>& wall, const View& view, double) {
  if (wall.is_plane)
    append_plane(all, wall.plane_point, wall.plane_normal, view);
  else
    append(all, wall.vertices, wall.facets);
}

void append_wall(TriangleMesh& all, const Wall<2>& wall, const View& view, double spacing) {
  if (!wall.is_plane) return append_outline(all, wall, spacing);
  Wall<2> line;  // a long segment of it
  const Vec2 along(wall.plane_normal[1], -wall.plane_normal[0]);
  const Vec2 foot = wall.plane_point + (view.middle.head<2>() - wall.plane_point).dot(along) * along;
  line.vertices = {foot - view.half * along, foot + view.half * along};
  line.facets = {{0, 1}};
  append_outline(all, line, spacing);
}

template <int Dim> TriangleMesh fixed_walls(const Scene& scene, const Start& start) {
  TriangleMesh all;
  for (const Wall<Dim>& wall : build_walls<Dim>(scene, start.spacing))
    if (wall.body < 0) append_wall(all, wall, view_of(start), start.spacing);
  return all;
}

template <int Dim> std::vector<TriangleMesh> bodies(const Scene& scene, const Start& start) {
  std::vector<Wall<Dim>> walls = build_walls<Dim>(scene, start.spacing);
  take_bodies(scene, walls);
  std::vector<TriangleMesh> all;
  View view = view_of(start);
  view.middle = Vec3::Zero();
  for (const Wall<Dim>& wall : walls)
    if (wall.body >= 0) append_wall(all.emplace_back(), wall, view, start.spacing);
  return all;
}

}  // namespace

TriangleMesh picture_of_walls(const Scene& scene, const Start& start) {
  return scene.dimensions == 2 ? fixed_walls<2>(scene, start) : fixed_walls<3>(scene, start);
}

std::vector<TriangleMesh> pictures_of_bodies(const Scene& scene, const Start& start) {
  return scene.dimensions == 2 ? bodies<2>(scene, start) : bodies<3>(scene, start);
}

}  // namespace molten
