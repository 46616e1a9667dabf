#include "io/assemble.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>


#include <cmath>
#include <fstream>

#include "core/boundary/shapes.h"
#include "core/error.h"
#include "core/fill.h"
#include "io/mesh_file.h"
#include "io/scene_file.h"
#include "io/terrain.h"

namespace molten {

namespace {

/// Longest edge of curved walls and bodies, in spacings.
constexpr double facet_edge = 2;

Vec3 vec(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

struct Bounds {
  Vec3 lower = Vec3::Constant(1e300), upper = Vec3::Constant(-1e300);
  void add(const Vec3& x) { lower = lower.cwiseMin(x), upper = upper.cwiseMax(x); }
};

Bounds bounds_of(const TriangleMesh& mesh) {
  Bounds b;
  for (const Vec3& v : mesh.vertices) b.add(v);
  return b;
}

/// Turns, scales and places a mesh from a file as the scene asks.
void place(TriangleMesh& mesh, const MeshFile& file) {
  const double to_radians = M_PI / 180;
  for (int axis = 0; axis < 3; ++axis) {
    const double angle = file.rotation[axis] * to_radians;
    if (angle == 0) continue;
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    for (Vec3& v : mesh.vertices) {
      const double x = v[a], y = v[b];
      v[a] = x * std::cos(angle) - y * std::sin(angle);
      v[b] = x * std::sin(angle) + y * std::cos(angle);
    }
  }
  if (!file.height && !file.placed) return;
  const Bounds b = bounds_of(mesh);
  const double scale = file.height ? *file.height / (b.upper[2] - b.lower[2]) : 1;
  const Vec3 foot(0.5 * (b.lower[0] + b.upper[0]), 0.5 * (b.lower[1] + b.upper[1]), b.lower[2]);
  for (Vec3& v : mesh.vertices) v = vec(file.position) + scale * (v - foot);
}

/// The surface of any shape but a plane; bodies and containers must be closed.
TriangleMesh surface(const Scene& scene, const Shape& shape, double spacing, bool must_close) {
  if (shape.terrain) return triangulate(read_terrain(*shape.terrain, locate(scene, shape.terrain->path)));
  if (!shape.mesh) return tessellate(shape, facet_edge * spacing);
  const auto file = locate(scene, shape.mesh->path);
  TriangleMesh mesh = read_mesh(file);
  if (must_close) require_closed(mesh, file.string());
  place(mesh, *shape.mesh);
  return mesh;
}

void flip(TriangleMesh& mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
}

Region region_of(const Scene& scene, const Body& body, double edge_spacing) {
  Region region;
  if (scene.dimensions == 2) region.outline = outline(body.shape, facet_edge * edge_spacing);
  else region.mesh = surface(scene, body.shape, edge_spacing, true);
  return region;
}

double measure_of(const Region& region, int dimensions) {
  if (dimensions == 3) return signed_volume(region.mesh);
  double area = 0;
  for (std::size_t k = 0; k < region.outline.size(); ++k) {
    const Vec2& a = region.outline[k];
    const Vec2& b = region.outline[(k + 1) % region.outline.size()];
    area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
  }
  return area;
}

double available_memory() {
  std::ifstream info("/proc/meminfo");
  std::string key;
  double kib = 0;
  while (info >> key >> kib) {
    if (key == "MemAvailable:") return kib * 1024;
    std::string unit;
    std::getline(info, unit);
  }
  return 1e300;
}

void require_memory(const Scene& scene, double particles) {
  constexpr double bytes_a_particle = 600;  // state, set-up and one frame at their largest
  const double wanted = particles * bytes_a_particle, there = available_memory();
  if (particles < 2e9 && wanted < there) return;
  throw Error(ExitCode::usage, fmt::format("{}:{}: fluid: {:.3g} particles need about {:.3g} GB and {:.3g} GB are free; "
                                           "ask for fewer particles or a larger spacing",
                                           scene.file, scene.fluid.place.line, particles, wanted / 1e9, there / 1e9));
}

}  // namespace

Start fill_bodies(const Scene& scene, const Features& features) {
  const Fluid& fluid = scene.fluid;
  const double coarse = fluid.spacing.value_or(0);
  std::vector<Region> regions;
  double measure = 0;
  // Curved shapes are cut into facets a few spacings long; with a number of particles the spacing follows from a first
  // estimate of the measure.
  const auto build = [&](double spacing) {
    regions.clear();
    measure = 0;
    for (const Body& body : fluid.bodies) {
      regions.push_back(region_of(scene, body, spacing));
      measure += measure_of(regions.back(), scene.dimensions);
    }
  };
  if (fluid.spacing) {
    build(coarse);
  } else {
    build(1e300);
    build(std::pow(measure / static_cast<double>(*fluid.particles), 1.0 / scene.dimensions));
  }
  require_memory(scene, fluid.spacing ? measure / std::pow(coarse, scene.dimensions) : double(*fluid.particles));
  const Filling filling = fill(regions, scene.dimensions, fluid.particles, fluid.spacing);

  Start start;
  start.spacing = filling.spacing;
  start.measure = filling.measure;
  const int up = scene.dimensions - 1;
  double lowest = 1e300, highest = -1e300;
  for (const Vec3& x : filling.positions) lowest = std::min(lowest, x[up]), highest = std::max(highest, x[up]);
  for (std::size_t k = 0; k < filling.positions.size(); ++k) {
    const Vec3& x = filling.positions[k];
    const Body& body = fluid.bodies[filling.region[k]];
    start.position.push_back({x[0], x[1], x[2]});
    start.velocity.push_back(body.velocity);
    if (!features.heat) continue;
    const double u = highest > lowest ? (x[up] - lowest) / (highest - lowest) : 0;
    start.temperature.push_back(
        body.temperature.value_or((1 - u) * fluid.heat->initial_bottom + u * fluid.heat->initial_top));
  }
  return start;
}

template <int Dim>
std::vector<Wall<Dim>> build_walls(const Scene& scene, double spacing) {
  std::vector<Wall<Dim>> walls;
  for (const Boundary& boundary : scene.boundaries) {
    Wall<Dim> wall;
    wall.response = {boundary.restitution, boundary.slip};
    if (boundary.shape.plane) {
      wall.is_plane = true;
      for (int d = 0; d < Dim; ++d) {
        wall.plane_point[d] = boundary.shape.plane->point[d];
        wall.plane_normal[d] = boundary.shape.plane->normal[d];
      }
      wall.plane_normal.normalize();
    } else if constexpr (Dim == 3) {
      TriangleMesh mesh = surface(scene, boundary.shape, spacing, boundary.inside);
      if (boundary.inside) flip(mesh);
      wall.vertices = std::move(mesh.vertices);
      wall.facets = std::move(mesh.triangles);
    } else {
      const std::vector<Vec2> line = outline(boundary.shape, facet_edge * spacing);
      const auto n = static_cast<std::int32_t>(line.size());
      for (const Vec2& x : line) wall.vertices.push_back(x);
      for (std::int32_t k = 0; k < n; ++k)
        boundary.inside ? wall.facets.push_back({k, (k + 1) % n}) : wall.facets.push_back({(k + 1) % n, k});
    }
    walls.push_back(std::move(wall));
  }
  return walls;
}

namespace {

void append(TriangleMesh& all, const std::vector<Vec3>& vertices, const std::vector<std::array<std::int32_t, 3>>& triangles) {
  const auto first = static_cast<std::int32_t>(all.vertices.size());
  all.vertices.insert(all.vertices.end(), vertices.begin(), vertices.end());
  for (const auto& t : triangles) all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

/// A square of a plane about the fluid, `half` m to each side.
void append_plane(TriangleMesh& all, const Plane& plane, const Vec3& middle, double half) {
  const Vec3 n = vec(plane.normal).normalized();
  const Vec3 foot = middle - (middle - vec(plane.point)).dot(n) * n;
  const Vec3 a = (std::abs(n[2]) < 0.9 ? n.cross(Vec3::UnitZ()) : n.cross(Vec3::UnitY())).normalized() * half;
  const Vec3 b = n.cross(a);
  append(all, {foot - a - b, foot + a - b, foot + a + b, foot - a + b}, {{0, 1, 2}, {0, 2, 3}});
}

/// A 2-D outline as strips standing on the picture's plane.
void append_outline(TriangleMesh& all, const Wall<2>& wall, double thickness) {
  for (const auto& f : wall.facets) {
    const Vec2 a = wall.vertices[f[0]], b = wall.vertices[f[1]];
    const Vec2 out = thickness * Vec2(b[1] - a[1], a[0] - b[0]).normalized();  // away from the fluid
    append(all, {{a[0], a[1], 0}, {b[0], b[1], 0}, {b[0] + out[0], b[1] + out[1], 0}, {a[0] + out[0], a[1] + out[1], 0}},
           {{0, 1, 2}, {0, 2, 3}});
  }
}

}  // namespace

TriangleMesh picture_of_walls(const Scene& scene, const Start& start) {
  TriangleMesh all;
  Bounds fluid;
  for (const auto& x : start.position) fluid.add(vec(x));
  const Vec3 middle = 0.5 * (fluid.lower + fluid.upper);
  const double half = 1.5 * (fluid.upper - fluid.lower).maxCoeff();
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

template <int Dim>
void require_no_overlap(const Scene& scene, const Start& start, const Contact<Dim>& contact) {
  const double nearest_wall = 0.2 * start.spacing;
  std::size_t inside = 0;
  std::array<double, 3> first{};
  for (const auto& x : start.position) {
    Point<Dim> point;
    for (int d = 0; d < Dim; ++d) point[d] = x[d];
    if (contact.empty() || contact.signed_distance(point, start.spacing) >= nearest_wall) continue;
    if (inside++ == 0) first = x;
  }
  if (inside > 0)
    throw Error(ExitCode::geometry,
                fmt::format("{}: {} of {} particles start inside or against a wall, the first at ({:.6g}, {:.6g}, {:.6g}) m; "
                            "move the fluid at least half a spacing ({:.3g} m) away from the walls",
                            scene.file, inside, start.position.size(), first[0], first[1], first[2], start.spacing / 2));
}

namespace {

/// FNV-1a over numbers' bytes.
class Hash {
 public:
  template <class T>
  void add(const T* data, std::size_t count) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(data);
    for (std::size_t k = 0; k < count * sizeof(T); ++k) value_ = (value_ ^ bytes[k]) * 1099511628211ull;
  }
  template <class T>
  void add(const T& number) { add(&number, 1); }
  std::string text() const { return fmt::format("{:016x}", value_); }

 private:
  std::uint64_t value_ = 14695981039346656037ull;
};

template <int Dim>
void add_walls(Hash& hash, const Scene& scene, double spacing) {
  for (const Wall<Dim>& wall : build_walls<Dim>(scene, spacing)) {
    for (const auto& v : wall.vertices) hash.add(v.data(), Dim);
    for (const auto& f : wall.facets) hash.add(f.data(), Dim);
    hash.add(wall.plane_point.data(), Dim);
    hash.add(wall.plane_normal.data(), Dim);
    hash.add(wall.response.restitution);
    hash.add(wall.response.slip);
  }
}

void add_numerics(Hash& hash, const Numerics& n) {
  hash.add(static_cast<int>(n.precision));
  hash.add(static_cast<int>(n.resort));
  hash.add(static_cast<int>(n.kernel));
  hash.add(static_cast<int>(n.integrator));
  hash.add(static_cast<int>(n.state_equation));
  hash.add(n.xsph ? 1 + static_cast<int>(n.xsph->form) : 0);
  for (const double number : {n.smoothing_ratio, n.skin, n.gamma, n.sound_speed.value_or(0), n.artificial_viscosity,
                              n.xsph ? n.xsph->epsilon : 0, n.courant_sound, n.courant_viscous, n.courant_force,
                              n.courant_conduction, n.fixed_dt.value_or(0)})
    hash.add(number);
}

}  // namespace

std::string fingerprint(const Scene& scene, const Start& start) {
  Hash hash;
  hash.add(scene.dimensions);
  hash.add(start.spacing);
  hash.add(start.position.data(), start.position.size());
  hash.add(start.velocity.data(), start.velocity.size());
  hash.add(start.temperature.data(), start.temperature.size());
  const Rheology& r = scene.fluid.rheology;
  hash.add(static_cast<int>(r.model));
  for (const double number : {scene.fluid.density, r.viscosity, r.flow_index, r.jump_number[0], r.jump_number[1],
                              r.yield_stress, r.consistency, scene.gravity[0], scene.gravity[1], scene.gravity[2]})
    hash.add(number);
  if (scene.fluid.heat) {
    hash.add(scene.fluid.heat->diffusivity);
    hash.add(scene.fluid.heat->melting_range.value_or(std::array<double, 2>{}).data(), 2);
  }
  if (scene.domain) hash.add(scene.domain->min), hash.add(scene.domain->max), hash.add(scene.periodic);
  scene.dimensions == 2 ? add_walls<2>(hash, scene, start.spacing) : add_walls<3>(hash, scene, start.spacing);
  add_numerics(hash, scene.numerics);
  return hash.text();
}

template std::vector<Wall<2>> build_walls(const Scene&, double);
template std::vector<Wall<3>> build_walls(const Scene&, double);
template void require_no_overlap(const Scene&, const Start&, const Contact<2>&);
template void require_no_overlap(const Scene&, const Start&, const Contact<3>&);

}  // namespace molten
