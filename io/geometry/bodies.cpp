#include "io/geometry/bodies.h"

#include <fmt/format.h>

#include "core/boundary/mass_properties.h"
#include "core/error.h"

namespace molten {

namespace {

constexpr double to_radians = M_PI / 180;

template <int Dim> Point<Dim> point_of(const std::array<double, 3>& v) {
  Point<Dim> p;
  for (int d = 0; d < Dim; ++d) p[d] = v[d];
  return p;
}

template <int Dim> Spin<Dim> spin_of(const double* degrees) {
  if constexpr (Dim == 2)
    return Spin<2>(to_radians * degrees[2]);
  else
    return Spin<3>(to_radians * degrees[0], to_radians * degrees[1], to_radians * degrees[2]);
}

template <int Dim> Point<Dim> middle_of(const Wall<Dim>& wall) {
  if (wall.is_plane) return wall.plane_point;
  Point<Dim> lo = Point<Dim>::Constant(HUGE_VAL), hi = -lo;
  for (const auto& v : wall.vertices) {
    lo = lo.cwiseMin(v);
    hi = hi.cwiseMax(v);
  }
  return (lo + hi) / 2;
}

template <int Dim> PrescribedMotion<Dim> prescribed(const Movement& m) {
  PrescribedMotion<Dim> motion{point_of<Dim>(m.velocity), spin_of<Dim>(m.spin.data()), {}};
  for (const auto& row : m.key_frames)
    motion.key_frames.push_back({row[0], point_of<Dim>({row[1], row[2], row[3]}), spin_of<Dim>(&row[4])});
  return motion;
}

template <int Dim> RigidBody<Dim> free_body(const Scene& scene, const Boundary& boundary, const Wall<Dim>& wall) {
  const MassProperties<Dim> p = mass_properties(wall);
  if (!(p.measure > 0)) {
    const Place& at = boundary.shape.place;
    throw Error(ExitCode::geometry,
                fmt::format("{}:{}: boundary.body: its surface encloses nothing, so it has no mass; "
                            "close it and let its normals point outwards",
                            at.file.empty() ? scene.file : at.file, at.line));
  }
  RigidBody<Dim> body;
  body.centre = p.centre;
  body.inertia = Inertia<Dim>{boundary.body->density * p.measure, boundary.body->density * p.inertia};
  body.prescribed = {point_of<Dim>(boundary.body->velocity), spin_of<Dim>(boundary.body->spin.data()), {}};
  return body;
}

template <int Dim> void bring_into_frame(Wall<Dim>& wall, RigidBody<Dim>& body) {
  for (auto& v : wall.vertices) {
    v -= body.centre;
    body.extent = std::max(body.extent, v.norm());
  }
  if (!wall.is_plane) return;
  wall.plane_point -= body.centre;
  body.extent = HUGE_VAL;
}

}  // namespace

template <int Dim> Bodies<Dim> take_bodies(const Scene& scene, std::vector<Wall<Dim>>& walls) {
  std::vector<RigidBody<Dim>> bodies;
  for (std::size_t w = 0; w < walls.size(); ++w) {
    const Boundary& boundary = scene.boundaries[w];
    if (walls[w].body < 0) continue;
    if (boundary.body) {
      bodies.push_back(free_body(scene, boundary, walls[w]));
    } else {
      RigidBody<Dim>& body = bodies.emplace_back();
      body.centre = boundary.motion->centre ? point_of<Dim>(*boundary.motion->centre) : middle_of(walls[w]);
      body.prescribed = prescribed<Dim>(*boundary.motion);
    }
    bring_into_frame(walls[w], bodies.back());
  }
  return Bodies<Dim>(std::move(bodies));
}

template Bodies<2> take_bodies(const Scene&, std::vector<Wall<2>>&);
template Bodies<3> take_bodies(const Scene&, std::vector<Wall<3>>&);

namespace {

double facet_measure(const Wall<2>& wall, const std::array<std::int32_t, 2>& f) {
  return (wall.vertices[f[1]] - wall.vertices[f[0]]).norm();
}
double facet_measure(const Wall<3>& wall, const std::array<std::int32_t, 3>& f) {
  return (wall.vertices[f[1]] - wall.vertices[f[0]]).cross(wall.vertices[f[2]] - wall.vertices[f[0]]).norm() / 2;
}

}  // namespace

template <int Dim>
void require_stable(const Scene& scene, const std::vector<Wall<Dim>>& walls, const Bodies<Dim>& bodies,
                    double spacing) {
  for (std::size_t w = 0; w < walls.size(); ++w) {
    if (walls[w].body < 0 || !bodies.body(static_cast<std::size_t>(walls[w].body)).inertia) continue;
    double surface = 0;
    for (const auto& facet : walls[w].facets) surface += facet_measure(walls[w], facet);
    const double touching = scene.fluid.density * spacing * surface / 2;
    const double mass = bodies.body(static_cast<std::size_t>(walls[w].body)).inertia->mass;
    if (2 * mass >= touching) continue;
    refuse(
        scene, fmt::format("boundary.{}.body.density", w),
        fmt::format("makes the body lighter than half of the particles that it touches; give {:.4g} kg/m³ or more, or "
                    "take more particles",
                    scene.boundaries[w].body->density * touching / (2 * mass)));
  }
}

template void require_stable(const Scene&, const std::vector<Wall<2>>&, const Bodies<2>&, double);
template void require_stable(const Scene&, const std::vector<Wall<3>>&, const Bodies<3>&, double);

TriangleMesh placed(TriangleMesh mesh, const SnapshotBody& body) {
  const auto& t = body.turn;
  for (Vec3& v : mesh.vertices)
    v = Vec3(body.centre[0] + t[0] * v[0] + t[1] * v[1] + t[2] * v[2],
             body.centre[1] + t[3] * v[0] + t[4] * v[1] + t[5] * v[2],
             body.centre[2] + t[6] * v[0] + t[7] * v[1] + t[8] * v[2]);
  return mesh;
}

}  // namespace molten
