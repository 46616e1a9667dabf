#include "io/geometry/assemble.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include <cmath>
#include <fstream>

#include "core/boundary/shapes.h"
#include "core/error.h"
#include "core/fill.h"
#include "io/geometry/bodies.h"
#include "io/geometry/mesh_file.h"
#include "io/geometry/terrain.h"
#include "io/geometry/text.h"
#include "io/geometry/vents.h"
#include "io/scene/scene_file.h"

namespace molten {

namespace {

/// Longest edge of curved walls and bodies, in spacings.
constexpr double facet_edge = 2;

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
  Eigen::AlignedBox3d box;
  for (const Vec3& v : mesh.vertices) box.extend(v);
  const double extent = box.sizes()[2];
  if (file.height && !(extent > 1e-12 * box.sizes().norm()))
    throw Error(ExitCode::geometry,
                file.path + ": height scales by the extent along z, and this mesh is flat there; leave height out");
  const double scale = file.height ? *file.height / extent : 1;
  const Vec3 foot(box.center()[0], box.center()[1], box.min()[2]);
  const Vec3 position(file.position.data());
  constexpr double furthest = 1e9;  // sizes of the mesh; beyond, its corners run into one another
  if (position.norm() > furthest * scale * box.sizes().norm())
    throw Error(ExitCode::geometry, fmt::format("{}: is {:.3g} m in size and put {:.3g} m away; check its position",
                                                file.path, scale * box.sizes().norm(), position.norm()));
  for (Vec3& v : mesh.vertices) v = position + scale * (v - foot);
}

}  // namespace

TriangleMesh placed_mesh(const Scene& scene, const MeshFile& file, const std::function<void()>& waiting) {
  TriangleMesh mesh = read_mesh(find_file(scene, file.path, file.place), waiting);
  place(mesh, file);
  return mesh;
}

TriangleMesh surface(const Scene& scene, const Shape& shape, double spacing, Demand demand) {
  if (shape.terrain)
    return triangulate(read_terrain(*shape.terrain, find_file(scene, shape.terrain->path, shape.terrain->place)));
  if (shape.text) {
    TriangleMesh letters = extrude_text(scene, shape);
    MeshFile where;
    where.position = shape.text->position, where.placed = true, where.rotation = shape.text->rotation;
    place(letters, where);
    return letters;
  }
  if (!shape.mesh) return tessellate(shape, facet_edge * spacing);
  const auto file = find_file(scene, shape.mesh->path, shape.mesh->place);
  TriangleMesh mesh = read_mesh(file);
  if (demand == Demand::closed) require_closed(mesh, file.string());
  if (demand == Demand::vessel)
    require_closed(mesh, file.string(), ", or, for an open vessel, give two_sided = true instead of inside = true");
  if (demand == Demand::outward) require_outward(mesh, file.string());
  place(mesh, *shape.mesh);
  return mesh;
}

namespace {

void flip(TriangleMesh& mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
}

Region region_of(const Scene& scene, const Body& body, double edge_spacing) {
  Region region;
  if (scene.dimensions == 2)
    region.outline = outline(body.shape, facet_edge * edge_spacing);
  else
    region.mesh = surface(scene, body.shape, edge_spacing, Demand::closed);
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

/// `key` asks for them.
void require_memory(const Scene& scene, const std::string& key, double particles, const char* cure) {
  constexpr double bytes_a_particle = 600;  // state, set-up and one frame at their largest
  const double wanted = particles * bytes_a_particle, there = available_memory();
  if (particles < 2e9 && wanted < there) return;
  refuse(scene, key,
         fmt::format("{:.3g} particles need about {:.3g} GB and {:.3g} GB are free; {}", particles, wanted / 1e9,
                     there / 1e9, cure));
}

/// Powers of the smoothing length up to the fifth must fit into single precision.
void require_runnable_size(const Scene& scene, double spacing) {
  if (spacing >= 1e-6 && spacing <= 1e6) return;
  refuse(scene, "fluid",
         fmt::format("the particles come out {:.3g} m apart, and spacings from 1e-6 to 1e6 m can be run; give the "
                     "body's size in metres",
                     spacing));
}

Filling filled(const Scene& scene, const std::vector<Region>& regions) {
  try {
    return fill(regions, scene.dimensions, scene.fluid.particles, scene.fluid.spacing);
  } catch (const Error& e) {
    throw Error(e.code(), fmt::format("{}: fluid: {}", text_of(scene.fluid.place), e.what()));
  }
}

}  // namespace

Start fill_bodies(const Scene& scene, const Features& features) {
  const Fluid& fluid = scene.fluid;
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
  const auto fitting = [&] {
    return std::pow(measure / static_cast<double>(*fluid.particles), 1.0 / scene.dimensions);
  };
  build(fluid.spacing.value_or(1e300));
  if (!fluid.spacing) build(fitting());
  require_runnable_size(scene, fluid.spacing ? *fluid.spacing : fitting());
  if (regions.empty()) {  // all of it enters through vents
    Start start;
    start.spacing = *fluid.spacing;
    describe_vents(scene, start);
    return start;
  }
  require_memory(scene, "fluid",
                 fluid.spacing ? measure / std::pow(*fluid.spacing, scene.dimensions) : double(*fluid.particles),
                 "ask for fewer particles or a larger spacing");
  const Filling filling = filled(scene, regions);

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
    if (features.varied_conduction)
      start.conductivity.push_back(body.diffusivity.value_or(fluid.heat->diffusivity) / fluid.heat->diffusivity);
  }
  describe_vents(scene, start);
  return start;
}

namespace {

/// A stress holds a particle by the area that it covers: one spacing across, and as thick.
Response response_of(const Scene& scene, const Boundary& boundary, double spacing) {
  Response response{boundary.restitution, boundary.slip};
  if (boundary.friction || boundary.yield_stress)
    response.grip = {boundary.friction.value_or(0),
                     boundary.yield_stress.value_or(0) / (scene.fluid.density * spacing)};
  return response;
}

/// Walls far smaller than particles are slips of a unit or of a zero.
template <int Dim> void require_size(const Scene& scene, std::size_t number, const Wall<Dim>& wall, double spacing) {
  if (wall.is_plane) return;
  constexpr double smallest = 1e-6;  // spacings
  Point<Dim> lower = wall.vertices.at(0), upper = lower;
  for (const Point<Dim>& v : wall.vertices) lower = lower.cwiseMin(v), upper = upper.cwiseMax(v);
  const double size = (upper - lower).norm();
  if (size < smallest * spacing)
    refuse(scene, fmt::format("boundary.{}", number),
           fmt::format("is {:.3g} m in size, far below the spacing of {:.3g} m; check its height and units", size,
                       spacing));
}

}  // namespace

template <int Dim> std::vector<Wall<Dim>> build_walls(const Scene& scene, double spacing) {
  std::vector<Wall<Dim>> walls;
  std::int32_t bodies = 0;
  for (const Boundary& boundary : scene.boundaries) {
    Wall<Dim> wall;
    if (boundary.motion || boundary.body) wall.body = bodies++;
    wall.response = response_of(scene, boundary, spacing);
    wall.two_sided = boundary.two_sided;
    for (int d = 0; d < Dim; ++d) wall.skin.velocity[d] = boundary.velocity[d];
    wall.skin.temperature = boundary.temperature;
    if (boundary.ground) {
      wall.skin.layer_diffusivity = boundary.ground->diffusivity;
      wall.skin.layer_thickness = boundary.ground->thickness;
    }
    if (boundary.shape.plane) {
      wall.is_plane = true;
      for (int d = 0; d < Dim; ++d) {
        wall.plane_point[d] = boundary.shape.plane->point[d];
        wall.plane_normal[d] = boundary.shape.plane->normal[d];
      }
      wall.plane_normal.normalize();
    } else if constexpr (Dim == 3) {
      const Demand demand = boundary.inside      ? Demand::vessel
                            : boundary.body      ? Demand::closed
                            : boundary.two_sided ? Demand::none
                                                 : Demand::outward;
      TriangleMesh mesh = surface(scene, boundary.shape, spacing, demand);
      if (boundary.inside) flip(mesh);
      wall.vertices = std::move(mesh.vertices);
      wall.facets = std::move(mesh.triangles);
    } else {
      const std::vector<Vec2> line = outline(boundary.shape, facet_edge * spacing);
      const auto n = static_cast<std::int32_t>(line.size());
      for (const Vec2& x : line) wall.vertices.push_back(x);
      const bool open = boundary.shape.polygon && boundary.shape.polygon->open;
      for (std::int32_t k = 0; k < (open ? n - 1 : n); ++k)
        boundary.inside ? wall.facets.push_back({k, (k + 1) % n}) : wall.facets.push_back({(k + 1) % n, k});
    }
    require_size(scene, walls.size(), wall, spacing);
    walls.push_back(std::move(wall));
  }
  return walls;
}

namespace {

/// −g·x of the start's surface and of the lowest boundary particle.
template <int Dim>
StillWater still_water(const Start& start, const Parameters<Dim>& p, const std::vector<RepulsivePoint<Dim>>& points) {
  const Eigen::Map<const Point<Dim>> g(p.gravity.data());
  StillWater water{-1e300, 1e300};
  for (const auto& x : start.position)
    water.surface = std::max(water.surface, g.norm() * start.spacing / 2 - g.dot(Point<Dim>(x.data())));
  for (const auto& b : points) water.bottom = std::min(water.bottom, -g.dot(b.at));
  return water;
}

/// Of a wall that ends, m² (2-D: m).
template <int Dim> double size_of(const Wall<Dim>& wall) {
  double size = 0;
  for (const auto& f : wall.facets) {
    const Point<Dim> a = wall.vertices[f[1]] - wall.vertices[f[0]];
    if constexpr (Dim == 3)
      size += a.cross(Point<3>(wall.vertices[f[2]] - wall.vertices[f[0]])).norm() / 2;
    else
      size += a.norm();
  }
  return size;
}

/// Before they are made: `rows` of boundary particles `pitch` (m) apart.
template <int Dim>
void require_memory_on(const Scene& scene, const std::vector<Wall<Dim>>& walls, double pitch, int rows) {
  for (std::size_t k = 0; k < walls.size(); ++k)
    if (!walls[k].is_plane)
      require_memory(scene, fmt::format("boundary.{}", k), rows * size_of(walls[k]) / std::pow(pitch, Dim - 1),
                     "as boundary particles; give a smaller wall or a larger spacing");
}

/// A boundary particle beyond the domain would be dropped with the first sort.
template <int Dim>
void require_in_domain(const Scene& scene, const std::vector<Wall<Dim>>& walls, const Parameters<Dim>& p) {
  for (std::size_t k = 0; k < walls.size(); ++k) {
    if (walls[k].is_plane || walls[k].body >= 0) continue;
    double beyond = -1e300;
    for (const Point<Dim>& v : walls[k].vertices)
      for (int d = 0; d < Dim; ++d) beyond = std::max({beyond, p.domain.lower[d] - v[d], v[d] - p.domain.upper[d]});
    beyond += 2 * p.spacing;  // the second row
    if (beyond <= 0) continue;
    const std::string key = fmt::format("boundary.{}", k);
    if (scene.domain)
      refuse(scene, "scene.domain",
             fmt::format("leaves boundary particles of {} outside; widen it by {:.3g} m", key, beyond));
    refuse(scene, key,
           fmt::format("reaches {:.3g} m beyond where boundary particles are kept, a hundred times the fluid's size to "
                       "each side; make it smaller, or give scene.domain, which says how far",
                       beyond));
  }
}

template <int Dim>
std::vector<HeldPoint<Dim>> build_held(const Scene& scene, const Start& start, const Parameters<Dim>& p,
                                       const std::vector<Wall<Dim>>& walls) {
  const auto& asked = scene.numerics.boundary_particles;
  if (!asked || asked->kind != BoundaryParticles::Kind::dynamic) return {};
  require_in_domain(scene, walls, p);
  const double pitch = held_pitch<Dim>(start.spacing);
  require_memory_on(scene, walls, pitch, 2);
  return held_points(walls, pitch);
}

template <int Dim>
Repulsion<Dim> build_repulsion(const Scene& scene, const Start& start, const Parameters<Dim>& p,
                               const std::vector<Wall<Dim>>& walls) {
  const auto& asked = scene.numerics.boundary_particles;
  if (!asked || asked->kind != BoundaryParticles::Kind::repulsive || walls.empty()) return {};
  require_memory_on(scene, walls, start.spacing, 1);
  auto points = repulsive_points(walls, start.spacing);
  const StillWater water = still_water(start, p, points);
  return {std::move(points), p, water};
}

}  // namespace

template <int Dim>
Surroundings<Dim> build_surroundings(const Scene& scene, const Start& start, const Parameters<Dim>& p) {
  return build_surroundings(scene, start, p, build_walls<Dim>(scene, start.spacing));
}

template <int Dim>
Surroundings<Dim> build_surroundings(const Scene& scene, const Start& start, const Parameters<Dim>& p,
                                     std::vector<Wall<Dim>> walls) {
  Bodies<Dim> bodies = take_bodies(scene, walls);
  require_stable(scene, walls, bodies, start.spacing);
  std::vector<HeldPoint<Dim>> held = build_held(scene, start, p, walls);
  Repulsion<Dim> repulsion = build_repulsion(scene, start, p, walls);
  Contact<Dim> contact(std::move(walls), p.contact_radius, p.support_radius);
  bodies.place(contact);
  Surroundings<Dim> around{std::move(contact), std::move(bodies), build_vents<Dim>(scene, start, p.support_radius)};
  around.held = std::move(held);
  around.repulsion = std::move(repulsion);
  return around;
}

template Surroundings<2> build_surroundings(const Scene&, const Start&, const Parameters<2>&);
template Surroundings<3> build_surroundings(const Scene&, const Start&, const Parameters<3>&);
template Surroundings<2> build_surroundings(const Scene&, const Start&, const Parameters<2>&, std::vector<Wall<2>>);
template Surroundings<3> build_surroundings(const Scene&, const Start&, const Parameters<3>&, std::vector<Wall<3>>);
template std::vector<Wall<2>> build_walls(const Scene&, double);
template std::vector<Wall<3>> build_walls(const Scene&, double);

}  // namespace molten
