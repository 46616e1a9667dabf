#include "core/boundary/wall_integrals.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "core/kernel.h"

namespace molten {
namespace {

constexpr std::size_t table_size = 2048;  // linear interpolation is then good to 1e-6
constexpr double same_direction = 1e-9;   // sine of the angle up to which facets that share an edge lie in one plane
constexpr double small_facet = 0.3;       // radius over distance, up to which three points do
constexpr double plane_size = 1e6;        // half of it, in support radii: what stands for infinite

/// Gauss-Legendre quadrature on [−1, 1].
template <int n> struct Gauss {
  std::array<double, n> node, weight;

  Gauss() {
    for (int k = 0; k < n; ++k) {
      double x = std::cos(std::numbers::pi * (k + 0.75) / (n + 0.5)), slope = 1;
      for (int round = 0; round < 20; ++round) {  // Newton on P_n
        double p = x, before = 1;
        for (int m = 2; m <= n; ++m) before = std::exchange(p, ((2 * m - 1) * x * p - (m - 1) * before) / m);
        slope = n * (x * p - before) / (x * x - 1);
        x -= p / slope;
      }
      node[k] = x;
      weight[k] = 2 / ((1 - x * x) * slope * slope);
    }
  }
  /// ∫_a^b f
  template <class F> double operator()(double a, double b, F&& f) const {
    double sum = 0;
    for (int k = 0; k < n; ++k) sum += weight[k] * f((a + b) / 2 + (b - a) / 2 * node[k]);
    return sum * (b - a) / 2;
  }
};
const Gauss<6> coarse;
const Gauss<16> fine;

/// The angle (rad) under which a line's part t0..t1 is seen from a point at the distance p.
double angle_of(double p, double t0, double t1) { return std::atan2(p * (t1 - t0), p * p + t0 * t1); }

/// The part of the line's interval t0..t1 that is within `half` of its foot; false if none.
bool clip(double half2, double t0, double t1, double& from, double& to) {
  if (!(half2 > 0)) return false;
  const double half = std::sqrt(half2);
  from = std::max(t0, -half);
  to = std::min(t1, half);
  return from < to;
}

double distance_to_segment(double p, double t0, double t1) { return std::hypot(p, t0 > 0 ? t0 : t1 < 0 ? t1 : 0); }

}  // namespace

RadialIntegrals::RadialIntegrals(KernelKind kind, int dim, double smoothing_length)
    : reach_(kernel_reach(kind) * smoothing_length), per_entry_(table_size / reach_) {
  const std::size_t n = table_size;
  const double step = reach_ / n;
  kernel_.resize(n + 1, 0);
  with_kernel<double>(kind, dim, smoothing_length, 1, [&](const auto& kernel) {
    for (std::size_t k = 0; k < n; ++k) kernel_[k] = kernel(Lanes<double, 1>(k * step)).w.v;
  });
  // From the support inwards; W is linear between the entries, which makes the sums exact to second order.
  weight_beyond_.assign(n + 1, 0);
  volume_beyond_.assign(n + 1, 0);  // ∫_r^R W s² ds
  const auto integral = [&](std::size_t k, auto&& f) { return coarse(k * step, (k + 1) * step, f); };
  for (std::size_t k = n; k-- > 0;) {
    weight_beyond_[k] = weight_beyond_[k + 1] + integral(k, [&](double s) { return at(kernel_, s) * s; });
    volume_beyond_[k] = volume_beyond_[k + 1] + integral(k, [&](double s) { return at(kernel_, s) * s * s; });
  }
  plane_weight_.assign(n + 1, 0);
  plane_hidden_.assign(n + 1, 0);
  if (dim == 2)
    fill_planes_2d();
  else
    fill_planes_3d();
}

void RadialIntegrals::fill_planes_3d() {
  const std::size_t n = table_size;
  const double step = reach_ / n;
  Table beyond(n + 1, 0);  // ∫_r^R H s ds; H s = s^−2 ∫_s^R W
  hidden_beyond_.assign(n + 1, 0);
  for (std::size_t k = n; k-- > 1;) {
    const auto slope = [&](double s) { return at(volume_beyond_, s) / (s * s); };
    beyond[k] = beyond[k + 1] + coarse(k * step, (k + 1) * step, slope);
    hidden_beyond_[k] = k * step * beyond[k];
  }
  hidden_beyond_[0] = volume_beyond_[0];  // the limit
  for (std::size_t k = 0; k < n; ++k) {
    plane_weight_[k] = 2 * std::numbers::pi * weight_beyond_[k];
    plane_hidden_[k] = 2 * std::numbers::pi * hidden_beyond_[k];
  }
}

void RadialIntegrals::fill_planes_2d() {
  const std::size_t n = table_size;
  for (std::size_t k = 0; k < n; ++k) {
    const double d = k / per_entry_, half = std::sqrt(reach_ * reach_ - d * d);
    plane_weight_[k] = 2 * fine(0, half, [&](double t) { return at(kernel_, std::hypot(d, t)); });
    plane_hidden_[k] =
        2 * fine(0, std::acos(d / reach_), [&](double a) { return at(weight_beyond_, d / std::cos(a)); });
  }
}

template <int Dim>
WallIntegrals<Dim>::WallIntegrals(const std::vector<Wall<Dim>>& walls, const WallSurface<Dim>& surface,
                                  KernelKind kernel, double smoothing_length)
    : radial_(kernel, Dim, smoothing_length) {
  add_facets(surface);
  facets_ = sheets_.size();
  add_planes(walls);
}

/// Facets that share an edge and a plane become neighbours in the list, so that they are summed as one.
template <int Dim> void WallIntegrals<Dim>::add_facets(const WallSurface<Dim>& surface) {
  const auto& facets = surface.facets();
  const auto n = static_cast<std::int32_t>(facets.size());
  std::vector<std::int32_t> root(n);
  std::iota(root.begin(), root.end(), 0);
  const auto root_of = [&](std::int32_t f) {
    while (root[f] != f) f = root[f] = root[root[f]];
    return f;
  };
  const auto coplanar = [&](std::int32_t f, std::int32_t g) {
    return g >= 0 && surface.wall(f) == surface.wall(g) &&
           (facets[f].normal - facets[g].normal).squaredNorm() < same_direction * same_direction;
  };
  for (std::int32_t f = 0; f < n && Dim == 3; ++f)
    for (int k = 0; k < 3; ++k)
      if (const std::int32_t g = surface.neighbour(f, k); coplanar(f, g))
        root[std::max(root_of(f), root_of(g))] = std::min(root_of(f), root_of(g));
  std::vector<std::int32_t> order;
  for (std::int32_t f = 0; f < n; ++f)
    if (!facets[f].normal.isZero(0)) order.push_back(f);  // without area: hides nothing
  std::stable_sort(order.begin(), order.end(), [&](auto f, auto g) { return root_of(f) < root_of(g); });
  std::vector<Facet<Dim>> sorted;
  std::int32_t last = no_plane;
  for (const std::int32_t f : order) {
    if (root_of(f) != last) {
      last = root_of(f);
      planes_.push_back({facets[f].normal, facets[f].normal.dot(facets[f].corner[0]), surface.wall(f)});
    }
    std::vector<bool> inner(Dim == 3 ? 3 : 1, false);
    for (int k = 0; k < 3 && Dim == 3; ++k) inner[k] = coplanar(f, surface.neighbour(f, k));
    add_sheet({facets[f].corner.begin(), facets[f].corner.end()}, inner, static_cast<std::int32_t>(planes_.size()) - 1);
    sorted.push_back(facets[f]);
  }
  grid_ = FacetGrid<Dim>(sorted, reach(), reach());
}

/// The corners of the part of a convex polygon (2-D: a segment) in front of a plane.
template <int Dim>
std::vector<Point<Dim>> in_front(const std::vector<Point<Dim>>& corners, const Point<Dim>& normal, double offset) {
  std::vector<Point<Dim>> kept;
  const std::size_t n = corners.size(), sides = Dim == 3 ? n : n - 1;
  for (std::size_t k = 0; k < n; ++k) {
    const Point<Dim>&a = corners[k], &b = corners[(k + 1) % n];
    const double height_a = normal.dot(a) - offset, height_b = normal.dot(b) - offset;
    if (height_a >= 0) kept.push_back(a);
    if (k < sides && (height_a < 0) != (height_b < 0)) kept.push_back(a + height_a / (height_a - height_b) * (b - a));
  }
  return kept;
}

template <int Dim> void WallIntegrals<Dim>::add_planes(const std::vector<Wall<Dim>>& walls) {
  for (std::size_t w = 0; w < walls.size(); ++w) {
    if (!walls[w].is_plane) continue;
    const Point<Dim> n = walls[w].plane_normal.normalized(), middle = walls[w].plane_point;
    const double size = plane_size * reach();
    std::vector<Point<Dim>> corners;
    if constexpr (Dim == 3) {
      const Point<3> a = size * n.unitOrthogonal(), b = n.cross(a);
      corners = {middle - a - b, middle + a - b, middle + a + b, middle - a + b};
    } else {
      const Point<2> a(size * n.y(), -size * n.x());  // the normal is to the left of start → end
      corners = {middle - a, middle + a};
    }
    for (std::size_t other = 0; other < walls.size(); ++other) {
      if (other == w || !walls[other].is_plane) continue;
      const Point<Dim> m = walls[other].plane_normal.normalized();
      if (n.dot(m) < 1 - same_direction) corners = in_front<Dim>(corners, m, m.dot(walls[other].plane_point));
    }
    if (corners.size() < Dim) continue;
    planes_.push_back({n, n.dot(middle), static_cast<std::int32_t>(w)});
    add_sheet(corners, std::vector<bool>(corners.size(), false), static_cast<std::int32_t>(planes_.size()) - 1);
  }
}

template <int Dim>
void WallIntegrals<Dim>::add_sheet(const std::vector<Point<Dim>>& corners, const std::vector<bool>& inner,
                                   std::int32_t plane) {
  const Point<Dim>& n = planes_[plane].normal;
  Sheet sheet{n, Point<Dim>::Zero(), 0, static_cast<std::uint32_t>(edges_.size()), 0, plane, 0};
  for (const auto& c : corners) sheet.centre += c / static_cast<double>(corners.size());
  for (const auto& c : corners) sheet.radius = std::max(sheet.radius, (c - sheet.centre).norm());
  const std::size_t edges = Dim == 3 ? corners.size() : 1;
  for (std::size_t k = 0; k < edges; ++k) {
    const Point<Dim> e = corners[(k + 1) % corners.size()] - corners[k];
    Edge edge{corners[k], e.normalized(), Point<Dim>::Zero(), e.norm(), inner[k]};
    if constexpr (Dim == 3) edge.outward = edge.along.cross(n);
    if (edge.length > 0) edges_.push_back(edge);
  }
  sheet.edges_end = static_cast<std::uint32_t>(edges_.size());
  if constexpr (Dim == 3)
    if (sheet.edges_end - sheet.edges_begin == 3 && std::count(inner.begin(), inner.end(), true) == 0)
      sheet.area = 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm();
  sheets_.push_back(sheet);
}

/// A triangle that is small for its distance: the three-point rule of second degree.
template <int Dim>
void WallIntegrals<Dim>::add_small(Sum& sum, const Sheet& sheet, const Point<Dim>& x, double d) const {
  for (std::uint32_t k = sheet.edges_begin; k < sheet.edges_end; ++k) {
    const Point<Dim> y = (sheet.centre + edges_[k].start) / 2 - x;
    const double r = y.norm(), weight = sheet.area / 3 * radial_.kernel(r);
    sum.weight += weight;
    sum.moment += weight * (y + d * sheet.normal);
    sum.hidden += sheet.area / 3 * d * radial_.hidden_per_height(r);
  }
}

template <int Dim> void WallIntegrals<Dim>::add(Sum& sum, const Sheet& sheet, const Point<Dim>& x, double d) const {
  const double least = 1e-6 * reach(), height = std::abs(d) < least ? std::copysign(least, d) : d;
  const double radius2 = reach() * reach() - height * height;  // of the disc that the support cuts out of the plane
  const double far = sheet.radius + reach();
  const double distance2 = (sheet.centre - x).squaredNorm();
  if (distance2 > far * far) return;
  if (sheet.area > 0 && sheet.radius * sheet.radius < small_facet * small_facet * distance2)
    return add_small(sum, sheet, x, d);
  const Point<Dim> foot = x - d * sheet.normal;
  const auto at_foot = std::abs(height);
  if constexpr (Dim == 2) {
    const Edge& e = edges_[sheet.edges_begin];
    double from, to;
    const double t0 = e.along.dot(e.start - foot);
    if (!clip(radius2, t0, t0 + e.length, from, to)) return;
    const auto r = [&](double t) { return std::hypot(height, t); };
    sum.weight += fine(from, to, [&](double t) { return radial_.kernel(r(t)); });
    sum.moment += (radial_.weight_beyond(r(from)) - radial_.weight_beyond(r(to))) * e.along;
    sum.hidden += std::copysign(1.0, height) * fine(std::atan(from / at_foot), std::atan(to / at_foot), [&](double a) {
                    return radial_.weight_beyond(at_foot / std::cos(a));
                  });
  } else {
    // ∫ Q dA = ∮ (P(foot) − P) p/ρ² dt and ∫ Q ρ dA = −∮ P ν dt, with P = ∫_ρ Q s ds, over the polygon's edges
    const double weight = radial_.weight_beyond(at_foot), hidden = radial_.hidden_beyond(at_foot) / at_foot;
    for (std::uint32_t k = sheet.edges_begin; k < sheet.edges_end; ++k) {
      const Edge& e = edges_[k];
      const Point<3> a = e.start - foot;
      const double p = e.outward.dot(a), t0 = e.along.dot(a), t1 = t0 + e.length;
      double from, to;
      if (!clip(radius2 - p * p, t0, t1, from, to)) {
        const double angle = angle_of(p, t0, t1);
        sum.weight += weight * angle;
        sum.hidden += height * hidden * angle;
        continue;
      }
      if (e.inner) continue;  // what the facet beyond the edge adds cancels
      const double angle = (t0 < from ? angle_of(p, t0, from) : 0) + (to < t1 ? angle_of(p, to, t1) : 0);
      double inside_weight = 0, inside_hidden = 0, edge_weight = 0;
      const auto integrate = [&](const auto& rule) {
        const double half = (to - from) / 2, middle = (to + from) / 2;
        for (std::size_t g = 0; g < rule.node.size(); ++g) {
          const double t = middle + half * rule.node[g], rho2 = std::max(p * p + t * t, least * least);
          const double r = std::sqrt(height * height + rho2), beyond = radial_.weight_beyond(r);
          inside_weight += rule.weight[g] * half * p / rho2 * (weight - beyond);
          inside_hidden += rule.weight[g] * half * p / rho2 * (hidden - radial_.hidden_beyond(r) / r);
          edge_weight += rule.weight[g] * half * beyond;
        }
      };
      if (to - from < 1.5 * std::hypot(height, p))
        integrate(coarse);
      else
        integrate(fine);
      sum.weight += weight * angle + inside_weight;
      sum.hidden += height * (hidden * angle + inside_hidden);
      sum.moment -= edge_weight * e.outward;
    }
  }
}

template <int Dim> WallPatch<Dim> WallIntegrals<Dim>::patch_of(const Sum& sum, const Plane& plane, double d) const {
  return {plane.normal, sum.moment / sum.weight - d * plane.normal, sum.weight, sum.hidden, d, plane.wall};
}

template <int Dim>
double WallIntegrals<Dim>::distance(const Sheet& sheet, const Point<Dim>& x, bool outer_edges_alone) const {
  const double d = sheet.normal.dot(x - edges_[sheet.edges_begin].start);
  double nearest = HUGE_VAL;
  bool inside = true;
  for (std::uint32_t k = sheet.edges_begin; k < sheet.edges_end; ++k) {
    const Edge& e = edges_[k];
    const Point<Dim> a = e.start - x;
    const double t0 = e.along.dot(a), t1 = t0 + e.length;
    if constexpr (Dim == 2) {
      inside = t0 <= 0 && t1 >= 0;
      nearest = std::hypot(d, std::min(std::abs(t0), std::abs(t1)));
    } else {
      const double p = e.outward.dot(a);
      inside = inside && p >= 0;
      if (!(outer_edges_alone && e.inner)) nearest = std::min(nearest, std::hypot(d, distance_to_segment(p, t0, t1)));
    }
  }
  return inside && !outer_edges_alone ? std::abs(d) : nearest;
}

template <int Dim> std::int32_t WallIntegrals<Dim>::plane_near(const Point<Dim>& x, double reach) const {
  std::int32_t found = no_plane;
  const auto look = [&](const Sheet& sheet) {
    const double gap = reach + sheet.radius;
    if (found == many_planes || (sheet.centre - x).squaredNorm() > gap * gap || distance(sheet, x, false) > reach)
      return;
    const bool ends = distance(sheet, x, true) < reach;
    found = ends || (found != no_plane && found != sheet.plane) ? many_planes : sheet.plane;
  };
  const Point<Dim> span = Point<Dim>::Constant(reach);
  grid_.visit_box(x - span, x + span, [&](std::span<const std::int32_t> near) {
    for (const std::int32_t k : near) look(sheets_[k]);
  });
  for (std::size_t k = facets_; k < sheets_.size(); ++k) look(sheets_[k]);
  return found;
}

template <int Dim> std::size_t WallIntegrals<Dim>::bytes() const {
  return grid_.bytes() + sheets_.capacity() * sizeof(Sheet) + edges_.capacity() * sizeof(Edge) +
         planes_.capacity() * sizeof(Plane);
}

template class WallIntegrals<2>;
template class WallIntegrals<3>;

}  // namespace molten
