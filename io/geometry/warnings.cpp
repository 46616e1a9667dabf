#include "io/geometry/warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/kernel.h"
#include "io/geometry/drop.h"
#include "io/geometry/point_text.h"
#include "io/geometry/thin_walls.h"

namespace molten {
namespace {

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

/// Lucy's, poly6 and the spiky kernel end at one smoothing length, the others at two or three. On a lattice Laplacians
/// are up to a fifth off where a kernel ends at 1.7 spacings, more than half at 1.3.
void find_short_support(const Scene& scene, double reach, std::vector<std::string>& found) {
  constexpr double least = 1.8;
  const double at_one = kernel_reach(scene.numerics.kernel), spacings = at_one * scene.numerics.smoothing_ratio;
  if (spacings < least)
    found.push_back(fmt::format(
        "numerics.smoothing_ratio: particles see only {:.3g} spacings far ({:.3g} m), and sums over so few neighbours "
        "are wrong by tens of per cent; give {:.2g} with this kernel",
        spacings, reach, 2.6 / at_one));
}

}  // namespace

template <int Dim>
std::vector<std::string> warnings_of(const Scene& scene, const Start& start, const std::vector<Wall<Dim>>& walls) {
  std::vector<std::string> found;
  find_backs(scene, start, walls, found);
  find_narrow_vents(scene, start, found);
  const double reach = kernel_reach(scene.numerics.kernel) * scene.numerics.smoothing_ratio * start.spacing;
  find_short_support(scene, reach, found);
  find_thin_walls(start, walls, reach, found);
  return found;
}

template std::vector<std::string> warnings_of(const Scene&, const Start&, const std::vector<Wall<2>>&);
template std::vector<std::string> warnings_of(const Scene&, const Start&, const std::vector<Wall<3>>&);

}  // namespace molten
