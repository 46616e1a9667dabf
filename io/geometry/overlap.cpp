// Particles must not start in walls.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include "core/boundary/shapes.h"
#include "core/error.h"
#include "core/inside.h"
#include "io/geometry/assemble.h"
#include "io/geometry/mesh_file.h"
#include "io/geometry/point_text.h"
#include "io/geometry/terrain.h"
#include "io/scene/scene_file.h"

namespace molten {

namespace {

using Place3 = std::array<double, 3>;
using Test = std::function<bool(const Place3&)>;  // true: on the wrong side

bool is_closed(const TriangleMesh& mesh) {
  const MeshReport r = inspect(mesh);
  return r.open_edges + r.flipped_edges == 0;
}

Test test_of_plane(const Plane& plane, int dimensions) {
  return [plane, dimensions](const Place3& x) {
    double side = 0;
    for (int d = 0; d < dimensions; ++d) side += (x[d] - plane.point[d]) * plane.normal[d];
    return side < 0;
  };
}

Test test_of_terrain(const Scene& scene, const Terrain& terrain) {
  return [grid = read_terrain(terrain, find_file(scene, terrain.path, terrain.place))](const Place3& x) {
    const double c = (x[0] - grid.origin[0]) / grid.cell_size, r = (x[1] - grid.origin[1]) / grid.cell_size;
    if (c < 0 || r < 0 || c >= grid.columns - 1 || r >= grid.rows - 1) return false;
    const int i = static_cast<int>(c), j = static_cast<int>(r);
    // Below all four corners is under the ground whichever way the cell is cut; the surface itself is the contact's.
    return x[2] < std::min({grid.at(i, j), grid.at(i + 1, j), grid.at(i, j + 1), grid.at(i + 1, j + 1)});
  };
}

std::shared_ptr<const Inside> inside_of_wall(const Boundary& boundary, const Wall<2>&, double spacing) {
  return inside_of(outline(boundary.shape, spacing));
}

/// None if it is not closed. The wall faces the fluid, so one around it is turned.
std::shared_ptr<const Inside> inside_of_wall(const Boundary& boundary, const Wall<3>& wall, double) {
  TriangleMesh mesh{wall.vertices, wall.facets};
  if (!is_closed(mesh)) return nullptr;
  if (boundary.inside)
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return inside_of(mesh);
}

template <int Dim> Test test_of_closed(const Boundary& boundary, const Wall<Dim>& wall, double spacing) {
  const std::shared_ptr<const Inside> inside = inside_of_wall(boundary, wall, spacing);
  if (!inside) return [](const Place3&) { return false; };
  return [inside, container = boundary.inside, d = Dim - 1](const Place3& x) {
    std::vector<Span> spans;
    inside->spans(x[0], x[1], spans);
    const bool within =
        std::any_of(spans.begin(), spans.end(), [&](const Span& s) { return x[d] > s.low && x[d] < s.high; });
    return within != container;
  };
}

template <int Dim> std::vector<Test> tests_of(const Scene& scene, const std::vector<Wall<Dim>>& walls, double spacing) {
  std::vector<Test> tests;
  for (std::size_t w = 0; w < walls.size(); ++w) {
    const Boundary& boundary = scene.boundaries[w];
    if (boundary.motion && !boundary.motion->key_frames.empty()) continue;  // starts elsewhere; contact knows where
    if (boundary.shape.plane)
      tests.push_back(test_of_plane(*boundary.shape.plane, scene.dimensions));
    else if (boundary.shape.terrain && !boundary.two_sided)
      tests.push_back(test_of_terrain(scene, *boundary.shape.terrain));
    else if (!boundary.two_sided)
      tests.push_back(test_of_closed(boundary, walls[w], spacing));
  }
  return tests;
}

}  // namespace

namespace {

void require_in_domain(const Scene& scene, const Start& start) {
  if (!scene.domain) return;
  for (const Place3& x : start.position)
    for (int d = 0; d < scene.dimensions; ++d)
      if (x[d] < scene.domain->min[d] || x[d] > scene.domain->max[d])
        throw Error(
            ExitCode::geometry,
            fmt::format("{}: scene.domain: fluid starts outside of it, at ({:.6g}, {:.6g}, {:.6g}) m; enlarge the "
                        "domain or move the fluid",
                        scene.file, x[0], x[1], x[2]));
}

/// An outflow that takes the whole of the fluid, or what a vent lets in, looks the wrong way.
void require_before_outflows(const Scene& scene, const Start& start) {
  const auto beyond = [&](const Plane& p, const Place3& x) {
    double way = 0;
    for (int d = 0; d < scene.dimensions; ++d) way += p.normal[d] * (x[d] - p.point[d]);
    return way > 0;
  };
  for (std::size_t k = 0; k < scene.outflows.size(); ++k) {
    const auto taken = [&](const Place3& x) { return beyond(scene.outflows[k], x); };
    const bool all = !start.position.empty() && std::all_of(start.position.begin(), start.position.end(), taken);
    if (all || std::any_of(start.vents.begin(), start.vents.end(), taken))
      throw Error(ExitCode::geometry,
                  fmt::format("{}: outflow.{}: {} beyond its plane; turn its normal to the side where fluid is removed",
                              scene.file, k, all ? "all of the fluid starts" : "a vent lets fluid in"));
  }
}

}  // namespace

template <int Dim>
std::size_t count_inside_walls(const Scene& scene, const Start& start, const std::vector<Wall<Dim>>& walls,
                               const Contact<Dim>& contact, Place3* first) {
  const double nearest = 0.01 * start.spacing;  // to a wall, m; contact moves those in front of it out to their radius
  const std::vector<Test> tests = tests_of(scene, walls, start.spacing);
  std::size_t inside = 0;
  for (const Place3& x : start.position) {
    Point<Dim> point;
    for (int d = 0; d < Dim; ++d) point[d] = x[d];
    const bool wrong = std::any_of(tests.begin(), tests.end(), [&](const Test& t) { return t(x); }) ||
                       (contact.may_touch(point, 0) && contact.signed_distance(point, start.spacing) < nearest);
    if (wrong && inside++ == 0 && first) *first = x;
  }
  return inside;
}

template <int Dim>
void require_no_overlap(const Scene& scene, const Start& start, const std::vector<Wall<Dim>>& walls,
                        const Contact<Dim>& contact) {
  require_in_domain(scene, start);
  require_before_outflows(scene, start);
  if (contact.empty()) return;
  Place3 first{};
  const std::size_t inside = count_inside_walls(scene, start, walls, contact, &first);
  if (inside > 0)
    throw Error(ExitCode::geometry, fmt::format("{}: {} of {} particles start inside a wall, the first at {}; "
                                                "move the fluid at least half a spacing ({:.3g} m) away from the walls",
                                                scene.file, inside, start.position.size(),
                                                in_metres<Dim>(Point<Dim>(first.data())), start.spacing / 2));
}

#define MOLTEN_INSTANTIATE(Dim)                                                                      \
  template std::size_t count_inside_walls(const Scene&, const Start&, const std::vector<Wall<Dim>>&, \
                                          const Contact<Dim>&, Place3*);                             \
  template void require_no_overlap(const Scene&, const Start&, const std::vector<Wall<Dim>>&, const Contact<Dim>&);
MOLTEN_INSTANTIATE(2)
MOLTEN_INSTANTIATE(3)

}  // namespace molten
