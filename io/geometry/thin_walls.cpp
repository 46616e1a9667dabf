#include "io/geometry/thin_walls.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_map>

#include "io/geometry/drop.h"
#include "io/geometry/point_text.h"

namespace molten {
namespace {

/// Points in cubes of a width, for those near a place.
template <int Dim> class Bins {
 public:
  explicit Bins(double width) : width_(width) {}

  void add(const Point<Dim>& x) { bins_[key_of(cell_of(x))].push_back(x); }

  /// Calls f(point) for the points within a width of x, and for some more.
  template <class F> void around(const Point<Dim>& x, F&& f) const {
    const Cell middle = cell_of(x);
    for (int k = 0; k < (Dim == 2 ? 9 : 27); ++k) {
      Cell cell = middle + Cell::Constant(-1);
      for (int d = 0, rest = k; d < Dim; ++d, rest /= 3) cell[d] += rest % 3;
      const auto bin = bins_.find(key_of(cell));
      if (bin != bins_.end()) std::for_each(bin->second.begin(), bin->second.end(), f);
    }
  }

 private:
  using Cell = Eigen::Matrix<std::int64_t, Dim, 1>;
  Cell cell_of(const Point<Dim>& x) const { return (x / width_).array().floor().template cast<std::int64_t>(); }
  static std::uint64_t key_of(const Cell& cell) {  // cells that share one share a bin
    std::uint64_t key = 0;
    for (int d = 0; d < Dim; ++d) key = key * 0x9e3779b97f4a7c15u + static_cast<std::uint64_t>(cell[d]);
    return key;
  }

  double width_;  // m
  std::unordered_map<std::uint64_t, std::vector<Point<Dim>>> bins_;
};

template <int Dim> struct ThinPart {
  std::array<Point<Dim>, Dim> corner;  // m
  Point<Dim> normal;
  double thickness;  // m
};

/// The facets, or every n-th of many, behind which the wall ends within `reach`.
template <int Dim> std::vector<ThinPart<Dim>> thin_parts(const Wall<Dim>& wall, double reach) {
  constexpr std::size_t most_tests = 1000000, most_samples = 1000;
  std::vector<ThinPart<Dim>> parts;
  const std::size_t facets = wall.facets.size();
  const std::size_t samples = std::clamp<std::size_t>(most_tests / std::max<std::size_t>(facets, 1), 8, most_samples);
  const double skip = reach * 1e-6;
  for (std::size_t k = 0; k < facets; k += std::max<std::size_t>(1, facets / samples)) {
    ThinPart<Dim> part;
    for (int c = 0; c < Dim; ++c) part.corner[c] = wall.vertices[wall.facets[k][c]];
    part.normal = make_facet<Dim>(part.corner).normal;
    part.thickness = 0;
    if (!wall.two_sided) {
      Point<Dim> middle = Point<Dim>::Zero();
      for (const auto& c : part.corner) middle += c / Dim;
      const Drop<Dim> inwards({wall}, -reach * part.normal, skip);
      const Landing landing = inwards.from(middle - 3 * skip * part.normal);
      if (!landing.behind) continue;
      part.thickness = landing.t * reach + 4 * skip;
    }
    parts.push_back(part);
  }
  return parts;
}

/// How far particles see, and how far from each other two of them can come to rest, half of it from a wall (m).
struct Sight {
  double reach, spacing;
};

/// Whether particles on the two sides of a place on a part are within reach of each other, or will be once they rest
/// against the wall.
template <int Dim>
bool sees_through(const ThinPart<Dim>& part, const Point<Dim>& place, const Bins<Dim>& fluid, const Sight& sight) {
  double before = HUGE_VAL, behind = HUGE_VAL;
  fluid.around(place, [&](const Point<Dim>& x) {
    const double height = (x - place).dot(part.normal);
    if ((x - place - height * part.normal).norm() > sight.reach / 4) return;
    if (height > 0) before = std::min(before, height);
    if (height < -part.thickness) behind = std::min(behind, -height);
  });
  const bool both = before < HUGE_VAL && behind < HUGE_VAL;
  return both && std::min(before + behind, part.thickness + sight.spacing) < sight.reach;
}

/// Where it does: looked for at places half a reach apart, or at most 32 along an edge.
template <int Dim>
std::optional<Point<Dim>> where_seen_through(const ThinPart<Dim>& part, const Bins<Dim>& fluid, const Sight& sight) {
  const auto& c = part.corner;
  double longest = 0;
  for (int k = 0; k < Dim; ++k) longest = std::max(longest, (c[k] - c[(k + 1) % Dim]).norm());
  const int n = std::clamp(static_cast<int>(2 * longest / sight.reach) + 1, 1, 32);
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < (Dim == 3 ? n - a : 1); ++b) {
      const double u = (a + 0.5) / n, v = Dim == 3 ? (b + 0.5) / n : 0;
      Point<Dim> place = c[0] + u * (c[1] - c[0]);
      if constexpr (Dim == 3) place += v * (1 - u) * (c[2] - c[0]);
      if (sees_through(part, place, fluid, sight)) return place;
    }
  return std::nullopt;
}

template <int Dim> Bins<Dim> fluid_beside(const std::vector<ThinPart<Dim>>& parts, const Start& start, double reach) {
  Point<Dim> lower = Point<Dim>::Constant(HUGE_VAL), upper = -lower;
  for (const auto& part : parts)
    for (const auto& corner : part.corner) lower = lower.cwiseMin(corner), upper = upper.cwiseMax(corner);
  Bins<Dim> bins(reach);
  for (const auto& position : start.position) {
    const Point<Dim> x(position.data());
    const bool near = ((x - lower).array() > -reach).all() && ((upper - x).array() > -reach).all();
    if (near) bins.add(x);
  }
  return bins;
}

}  // namespace

template <int Dim>
void find_thin_walls(const Start& start, const std::vector<Wall<Dim>>& walls, double reach,
                     std::vector<std::string>& found) {
  for (std::size_t k = 0; k < walls.size(); ++k) {
    const auto parts = thin_parts(walls[k], reach);
    if (parts.empty()) continue;
    const Bins<Dim> fluid = fluid_beside(parts, start, reach);
    for (const auto& part : parts) {
      const auto place = where_seen_through(part, fluid, Sight{reach, start.spacing});
      if (!place) continue;
      found.push_back(fmt::format(
          "boundary.{}: is {:.3g} m thick at {}, less than the {:.3g} m that particles see, and has fluid on both "
          "sides: pressure and heat pass through it; make it thicker or fluid.spacing smaller",
          k, part.thickness, in_metres<Dim>(*place), reach));
      break;
    }
  }
}

template void find_thin_walls(const Start&, const std::vector<Wall<2>>&, double, std::vector<std::string>&);
template void find_thin_walls(const Start&, const std::vector<Wall<3>>&, double, std::vector<std::string>&);

}  // namespace molten
