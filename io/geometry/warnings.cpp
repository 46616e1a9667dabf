#include "io/geometry/warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/boundary/sweep.h"
#include "io/geometry/point_text.h"

namespace molten {
namespace {

template <int Dim> using Corners = std::array<Point<Dim>, Dim>;

// ---- what something that falls meets ------------------------------------------------------------------------------

/// Where something that falls first meets a wall.
struct Landing {
  double t = HUGE_VAL;  // fraction of the way
  std::size_t wall = 0;
  bool behind = false;
};

/// Moves points straight along `way` (m) onto walls, from either side.
template <int Dim> class Drop {
 public:
  Drop(const std::vector<Wall<Dim>>& walls, const Point<Dim>& way, double radius) : way_(way), radius_(radius) {
    for (std::size_t k = 0; k < walls.size(); ++k) {
      if (walls[k].is_plane) planes_.push_back({walls[k].plane_point, walls[k].plane_normal, k});
      for (const auto& f : walls[k].facets) add(walls[k], f, k);
    }
  }

  const Point<Dim>& way() const { return way_; }

  Landing from(const Point<Dim>& x) const {
    Landing first;
    const auto meet = [&](const auto& hit, std::size_t wall, bool behind) {
      if (hit && hit->t < first.t) first = {hit->t, wall, behind};
    };
    for (const auto& p : planes_) meet(sweep_plane(p.point, p.normal, x, way_, radius_), p.wall, false);
    for (const auto& f : facets_) meet(sweep_facet(f.facet, x, way_, radius_), f.wall, f.behind);
    return first;
  }

 private:
  struct Part {
    Facet<Dim> facet;
    std::size_t wall;
    bool behind;
  };
  struct Plane {
    Point<Dim> point, normal;
    std::size_t wall;
  };

  /// The side that is met.
  void add(const Wall<Dim>& wall, const std::array<std::int32_t, Dim>& corners, std::size_t index) {
    Corners<Dim> c;
    for (int k = 0; k < Dim; ++k) c[k] = wall.vertices[corners[k]];
    Facet<Dim> facet = make_facet<Dim>(c);
    const bool behind = facet.normal.dot(way_) > 0;
    if (behind) {
      std::swap(c[0], c[1]);
      facet = make_facet<Dim>(c);
    }
    facets_.push_back({facet, index, behind && !wall.two_sided});
  }

  Point<Dim> way_;  // m
  double radius_;   // m
  std::vector<Part> facets_;
  std::vector<Plane> planes_;
};

// ---- fluid above the back of a wall -------------------------------------------------------------------------------

/// Every n-th of the particles, and the vents.
template <int Dim> std::vector<Point<Dim>> samples_of(const Start& start, std::size_t most) {
  std::vector<Point<Dim>> samples;
  const std::size_t stride = std::max<std::size_t>(1, (start.position.size() + most - 1) / most);
  const auto add = [&](const std::array<double, 3>& x) { samples.push_back(Point<Dim>(x.data())); };
  for (std::size_t k = 0; k < start.position.size(); k += stride) add(start.position[k]);
  for (const auto& x : start.vents) add(x);
  return samples;
}

/// Longer than from anything to any wall.
template <int Dim>
double reach_of(const std::vector<Wall<Dim>>& walls, const std::vector<Point<Dim>>& samples, double spacing) {
  double furthest = spacing;
  for (const auto& x : samples) furthest = std::max(furthest, x.norm());
  for (const auto& wall : walls) {
    if (wall.is_plane) furthest = std::max(furthest, wall.plane_point.norm());
    for (const auto& v : wall.vertices) furthest = std::max(furthest, v.norm());
  }
  return 4 * furthest;
}

template <int Dim>
void find_backs(const Scene& scene, const Start& start, const std::vector<Wall<Dim>>& walls,
                std::vector<std::string>& found) {
  const Point<Dim> gravity(scene.gravity.data());
  const auto surface = [](const Wall<Dim>& wall) { return !wall.facets.empty() && !wall.two_sided; };
  if (!(gravity.norm() > 0) || std::none_of(walls.begin(), walls.end(), surface)) return;
  std::size_t facets = 1;
  for (const auto& wall : walls) facets += wall.facets.size();
  constexpr std::size_t most_tests = 20000000, most_samples = 1000;
  const auto samples = samples_of<Dim>(start, std::clamp<std::size_t>(most_tests / facets, 8, most_samples));
  const Point<Dim> way = reach_of(walls, samples, start.spacing) * gravity.normalized();
  const Drop<Dim> drop(walls, way, start.spacing / 100);
  std::vector<std::size_t> behind(walls.size());
  std::vector<Point<Dim>> place(walls.size());
  for (const Point<Dim>& x : samples) {
    const Landing landing = drop.from(x);
    if (!landing.behind) continue;
    if (behind[landing.wall]++ == 0) place[landing.wall] = x + landing.t * drop.way();
  }
  for (std::size_t k = 0; k < walls.size(); ++k)
    if (behind[k] > 0)
      found.push_back(fmt::format(
          "boundary.{}: {:.0f} % of the fluid is above its back, which lets fluid through, first at {}: turn the "
          "surface over, close its holes, or give two_sided = true",
          k, 100.0 * static_cast<double>(behind[k]) / static_cast<double>(samples.size()), in_metres<Dim>(place[k])));
}

// ---- the rest -----------------------------------------------------------------------------------------------------

void find_narrow_vents(const Scene& scene, const Start& start, std::vector<std::string>& found) {
  for (std::size_t k = 0; k < scene.vents.size(); ++k)
    if (!scene.vents[k].mesh && 2 * scene.vents[k].radius < start.spacing)
      found.push_back(
          fmt::format("vent.{}: is {:.3g} m wide and its stream one particle, {:.3g} m; take a smaller spacing", k,
                      2 * scene.vents[k].radius, start.spacing));
}

}  // namespace

template <int Dim>
std::vector<std::string> warnings_of(const Scene& scene, const Start& start, const std::vector<Wall<Dim>>& walls) {
  std::vector<std::string> found;
  find_backs(scene, start, walls, found);
  find_narrow_vents(scene, start, found);
  return found;
}

template std::vector<std::string> warnings_of(const Scene&, const Start&, const std::vector<Wall<2>>&);
template std::vector<std::string> warnings_of(const Scene&, const Start&, const std::vector<Wall<3>>&);

}  // namespace molten
