#include "core/boundary/wall_integrals.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/boundary/gauss.h"

namespace molten {
namespace {

constexpr double same_direction = 1e-9;  // sine of the angle up to which facets that share an edge lie in one plane
constexpr double clump_radius = 0.2;     // support radii; facets larger than this are alone
constexpr double same_side = 0.99;       // cosine of the angle up to which facets may share a clump
constexpr double small_part = 0.4;       // radius over distance, up to which moments do
constexpr double least_scale = 0.124;    // of the parts that a facet is cut in; nearer, it is integrated
constexpr double least_height = 1e-6;    // of a particle over a facet, in support radii
constexpr double plane_size = 1e6;       // half of it, in support radii: what stands for infinite

const Gauss<6> coarse;
const Gauss<16> fine;

/// std::hypot takes care of overflow, which costs a sixth of the wall's share in a step.
double length_of(double a, double b) { return std::sqrt(a * a + b * b); }

/// The angle (rad) under which a line's part t0..t1 is seen from a point at the distance p, positive for −0, too.
double angle_of(double p, double t0, double t1) {
  const double angle = std::atan2(std::abs(p) * (t1 - t0), p * p + t0 * t1);
  return p < 0 ? -angle : angle;
}

/// An edge seen from the foot of a particle: how far inwards of the edge's line it is, and the edge along that (m).
template <int Dim> struct EdgeSeen {
  double p, t0, t1;
  template <class Edge>
  EdgeSeen(const Edge& e, const Point<Dim>& foot)
      : p(e.outward.dot(e.start - foot)), t0(e.along.dot(e.start - foot)), t1(t0 + e.length) {}
};

/// The part of the line's interval t0..t1 that is within `half` of its foot; false if none.
bool clip(double half2, double t0, double t1, double& from, double& to) {
  if (!(half2 > 0)) return false;
  const double half = std::sqrt(half2);
  from = std::max(t0, -half);
  to = std::min(t1, half);
  return from < to;
}

double distance_to_segment(double p, double t0, double t1) { return length_of(p, t0 > 0 ? t0 : t1 < 0 ? t1 : 0); }

template <int Dim> Turn<Dim> square(const Point<Dim>& v) { return v * v.transpose(); }

/// What a small piece of the size 1 adds, by its moments `spread` about its centre, which is at y: ∫ W dS, ∫ W y dS and
/// ∫ H dS.
template <int Dim> struct SmallPiece {
  double weight, hidden;
  Point<Dim> moment;

  [[gnu::always_inline]] SmallPiece(const RadialIntegrals& radial, const Turn<Dim>& spread, const Point<Dim>& y,
                                    double distance2) {
    const KernelBeyond at = radial.around(std::sqrt(distance2));
    const Point<Dim> across = spread * y;
    const double all = 0.5 * spread.trace(), along = 0.5 * across.dot(y) / distance2;
    weight = at.kernel + at.slope * all + (at.curvature - at.slope) * along;
    hidden = at.hidden + at.hidden_slope * all + (at.hidden_curvature - at.hidden_slope) * along;
    moment = weight * y + at.slope * across;
  }
};

}  // namespace

// ---- building
// ---------------------------------------------------------------------------------------------------------

/// Sorts facets into planes and clumps.
template <int Dim> class WallIntegrals<Dim>::Builder {
 public:
  Builder(WallIntegrals& to, const WallSurface<Dim>& surface)
      : to_(to), surface_(surface), facets_(surface.facets()), most_(clump_radius * to.reach()) {}

  void run() {
    const auto n = static_cast<std::int32_t>(facets_.size());
    find_planes();
    clump_.assign(facets_.size(), -1);
    for (std::int32_t f = 0; f < n; ++f)
      if (clump_[f] < 0 && has_area(f)) grow(f);
    std::vector<Facet<Dim>> listed;
    double margin = 0;
    for (const auto& members : members_) {
      const Clump& clump = add_clump(members);
      const bool alone = members.size() == 1;
      listed.push_back(facets_[members[0]]);
      if (alone) continue;
      listed.back().corner.fill(clump.centre);
      margin = std::max(margin, clump.radius);
    }
    to_.grid_ = FacetGrid<Dim>(listed, to_.reach() + margin, to_.reach());
  }

 private:
  bool has_area(std::int32_t f) const { return !facets_[f].normal.isZero(0); }  // without, a facet hides nothing

  Point<Dim> centre(std::int32_t f) const {
    Point<Dim> sum = Point<Dim>::Zero();
    for (const auto& c : facets_[f].corner) sum += c;
    return sum / Dim;
  }
  double furthest(std::int32_t f, const Point<Dim>& from) const {
    double r = 0;
    for (const auto& c : facets_[f].corner) r = std::max(r, (c - from).norm());
    return r;
  }
  bool is_small(std::int32_t f) const { return furthest(f, centre(f)) <= most_; }

  /// The facet across side k, −1 if there is none.
  std::int32_t neighbour(std::int32_t f, int k) const {
    if constexpr (Dim == 3) {
      return surface_.neighbour(f, k);
    } else {
      const std::int32_t g = k == 0 ? f - 1 : f + 1;
      if (k > 1 || g < 0 || g >= static_cast<std::int32_t>(facets_.size())) return -1;
      return facets_[f].corner[k] == facets_[g].corner[1 - k] ? g : -1;
    }
  }
  bool coplanar(std::int32_t f, std::int32_t g) const {
    return Dim == 3 && g >= 0 && surface_.wall(f) == surface_.wall(g) &&
           (facets_[f].normal - facets_[g].normal).squaredNorm() < same_direction * same_direction;
  }

  void find_planes() {
    const auto n = static_cast<std::int32_t>(facets_.size());
    std::vector<std::int32_t> root(facets_.size());
    std::iota(root.begin(), root.end(), 0);
    const auto root_of = [&](std::int32_t f) {
      while (root[f] != f) f = root[f] = root[root[f]];
      return f;
    };
    for (std::int32_t f = 0; f < n; ++f)
      for (int k = 0; k < 3; ++k)
        if (const std::int32_t g = neighbour(f, k); coplanar(f, g))
          root[std::max(root_of(f), root_of(g))] = std::min(root_of(f), root_of(g));
    plane_.resize(facets_.size());
    for (std::int32_t f = 0; f < n; ++f) {  // a root comes before what it is the root of
      const std::int32_t r = root_of(f);
      if (r == f) {
        plane_[f] = static_cast<std::int32_t>(to_.planes_.size());
        to_.planes_.push_back({facets_[f].normal, facets_[f].normal.dot(facets_[f].corner[0]), surface_.wall(f)});
      }
      plane_[f] = plane_[r];
    }
  }

  void grow(std::int32_t seed) {
    const auto number = static_cast<std::int32_t>(members_.size());
    const Point<Dim> middle = centre(seed);
    std::vector<std::int32_t>& members = members_.emplace_back(1, seed);
    clump_[seed] = number;
    if (!is_small(seed)) return;
    for (std::size_t m = 0; m < members.size(); ++m)
      for (int k = 0; k < 3; ++k) {
        const std::int32_t g = neighbour(members[m], k);
        if (g < 0 || clump_[g] >= 0 || !has_area(g) || surface_.wall(g) != surface_.wall(seed)) continue;
        if (facets_[g].normal.dot(facets_[seed].normal) < same_side || furthest(g, middle) > most_) continue;
        clump_[g] = number;
        members.push_back(g);
      }
  }

  const Clump& add_clump(const std::vector<std::int32_t>& members) {
    Clump c{};
    c.sheets_begin = static_cast<std::uint32_t>(to_.sheets_.size());
    c.whole = true;
    Point<Dim> normal = Point<Dim>::Zero();
    c.centre = normal;
    for (const std::int32_t f : members) {
      std::vector<bool> inner(Dim == 3 ? 3 : 1, false), cancels = inner;
      for (std::size_t k = 0; k < 3 && Dim == 3; ++k) {
        const std::int32_t g = neighbour(f, static_cast<int>(k));
        inner[k] = coplanar(f, g);
        cancels[k] = inner[k] && (clump_[f] == clump_[g] || (!is_small(f) && !is_small(g)));
        if (cancels[k] && clump_[f] != clump_[g]) c.whole = false;
      }
      to_.add_sheet({facets_[f].corner.begin(), facets_[f].corner.end()}, inner, cancels, plane_[f]);
      const Sheet& sheet = to_.sheets_.back();
      c.size += sheet.size;
      c.centre += sheet.size * sheet.centre;
      normal += sheet.size * sheet.normal;
    }
    c.sheets_end = static_cast<std::uint32_t>(to_.sheets_.size());
    c.centre /= c.size;
    c.area = normal.norm();
    c.normal = normal / c.area;
    c.spread.setZero();
    for (std::uint32_t k = c.sheets_begin; k < c.sheets_end; ++k) {
      const Sheet& sheet = to_.sheets_[k];
      const Point<Dim> aside = sheet.centre - c.centre;
      c.bulge += sheet.size * sheet.normal.dot(aside);
      c.spread += sheet.size / c.size * (sheet.spread + square<Dim>(aside));
    }
    for (const std::int32_t f : members) c.radius = std::max(c.radius, furthest(f, c.centre));
    to_.clumps_.push_back(c);
    return to_.clumps_.back();
  }

  WallIntegrals& to_;
  const WallSurface<Dim>& surface_;
  const std::vector<Facet<Dim>>& facets_;
  double most_;                                     // m
  std::vector<std::int32_t> plane_, clump_;         // by facet
  std::vector<std::vector<std::int32_t>> members_;  // of the clumps
};

template <int Dim>
WallIntegrals<Dim>::WallIntegrals(const std::vector<Wall<Dim>>& walls, const WallSurface<Dim>& surface,
                                  KernelKind kernel, double smoothing_length)
    : radial_(kernel, Dim, smoothing_length) {
  if constexpr (Dim == 3) across_ = EdgeIntegrals(radial_);
  Builder(*this, surface).run();
  facets_ = sheets_.size();
  add_planes(walls);
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
    const std::vector<bool> none(corners.size(), false);
    add_sheet(corners, none, none, static_cast<std::int32_t>(planes_.size()) - 1);
  }
}

template <int Dim>
void WallIntegrals<Dim>::add_sheet(const std::vector<Point<Dim>>& corners, const std::vector<bool>& inner,
                                   const std::vector<bool>& cancels, std::int32_t plane) {
  const Point<Dim>& n = planes_[plane].normal;
  Sheet sheet{n, Point<Dim>::Zero(), 0, static_cast<std::uint32_t>(edges_.size()), 0, plane, 0, Turn<Dim>::Zero()};
  for (const auto& c : corners) sheet.centre += c / static_cast<double>(corners.size());
  for (const auto& c : corners) {
    sheet.radius = std::max(sheet.radius, (c - sheet.centre).norm());
    sheet.spread += square<Dim>(c - sheet.centre) / (Dim * (Dim + 1));
  }
  const std::size_t edges = Dim == 3 ? corners.size() : 1;
  for (std::size_t k = 0; k < edges; ++k) {
    const Point<Dim> e = corners[(k + 1) % corners.size()] - corners[k];
    Edge edge{corners[k], e.normalized(), Point<Dim>::Zero(), e.norm(), inner[k], cancels[k]};
    if constexpr (Dim == 3) edge.outward = edge.along.cross(n);
    if (edge.length > 0) edges_.push_back(edge);
  }
  sheet.edges_end = static_cast<std::uint32_t>(edges_.size());
  if constexpr (Dim == 3)
    sheet.size = 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm();
  else
    sheet.size = (corners[1] - corners[0]).norm();
  sheets_.push_back(sheet);
}

// ---- summing
// ----------------------------------------------------------------------------------------------------------

template <int Dim> void WallIntegrals<Dim>::add(PatchSums<Dim>& sums, const Clump& clump, const Point<Dim>& x) const {
  const Point<Dim> y = clump.centre - x;
  const double far = clump.radius + reach(), distance2 = y.squaredNorm();
  if (distance2 > far * far) return;
  const bool seen_whole = clump.whole && clump.radius * clump.radius < small_part * small_part * distance2;
  if (!seen_whole) {
    for (std::uint32_t k = clump.sheets_begin; k < clump.sheets_end; ++k) add(sums, sheets_[k], clump.whole, x);
    return;
  }
  const SmallPiece<Dim> piece(radial_, clump.spread, y, distance2);
  const double height = -clump.area * clump.normal.dot(y) - clump.bulge;  // ∫ n·(x − y) dS
  const std::int32_t wall = planes_[sheets_[clump.sheets_begin].plane].wall;
  sums.add(clump.normal, height > 0, wall, clump.area * piece.weight, clump.area * piece.moment, height * piece.hidden);
}

template <int Dim>
void WallIntegrals<Dim>::add(PatchSums<Dim>& sums, const Sheet& sheet, bool whole, const Point<Dim>& x) const {
  const double far = sheet.radius + reach(), distance2 = (sheet.centre - x).squaredNorm();
  if (distance2 > far * far) return;
  const Plane& plane = planes_[sheet.plane];
  const double d = plane.normal.dot(x) - plane.offset;
  if (!(std::abs(d) < reach())) return;
  Sum sum;
  const double nearest = std::max(std::abs(d), std::sqrt(distance2) - sheet.radius);
  if (whole && sheet.radius < 0.5 * reach() && sheet.radius * least_scale < small_part * nearest) {
    add_part(sum, sheet, sheet.centre, 1, x);
    sum.hidden *= d;
  } else {
    add_exact(sum, sheet, x, d);
    sum.moment -= d * sum.weight * sheet.normal;
  }
  if (sum.weight == 0) return;
  sums.add(sheet.normal, d > 0, plane.wall, sum.weight, sum.moment, sum.hidden);
}

/// A part of a facet, `scale` times as large (and turned by half a turn if that is negative): cut in 2^(d−1) like it
/// until they are small for their distance. What is hidden comes a height.
template <int Dim>
void WallIntegrals<Dim>::add_part(Sum& sum, const Sheet& sheet, const Point<Dim>& centre, double scale,
                                  const Point<Dim>& x) const {
  const Point<Dim> y = centre - x;
  const double radius = sheet.radius * std::abs(scale), far = radius + reach(), distance2 = y.squaredNorm();
  if (distance2 > far * far) return;
  if (radius * radius < small_part * small_part * distance2) {
    const SmallPiece<Dim> piece(radial_, scale * scale * sheet.spread, y, distance2);
    const double size = sheet.size * (Dim == 3 ? scale * scale : std::abs(scale));
    sum.weight += size * piece.weight;
    sum.moment += size * piece.moment;
    sum.hidden += size * piece.hidden;
    return;
  }
  if constexpr (Dim == 2) {
    const Edge& e = edges_[sheet.edges_begin];
    const Point<2> half = scale * e.length / 4 * e.along;
    add_part(sum, sheet, centre - half, scale / 2, x);
    add_part(sum, sheet, centre + half, scale / 2, x);
  } else {
    add_part(sum, sheet, centre, -scale / 2, x);
    for (std::uint32_t k = sheet.edges_begin; k < sheet.edges_end; ++k)
      add_part(sum, sheet, centre + scale / 2 * (edges_[k].start - sheet.centre), scale / 2, x);
  }
}

template <int Dim>
void WallIntegrals<Dim>::add_exact(Sum& sum, const Sheet& sheet, const Point<Dim>& x, double d) const {
  const double least = least_height * reach(), height = std::abs(d) < least ? std::copysign(least, d) : d;
  const Foot foot{x - d * sheet.normal, height, reach() * reach() - height * height};
  if constexpr (Dim == 2)
    add_segment(sum, edges_[sheet.edges_begin], foot);
  else if (!misses(sheet, foot))
    add_polygon(sum, sheet, foot);
}

template <int Dim> void WallIntegrals<Dim>::add_segment(Sum& sum, const Edge& e, const Foot& foot) const {
  double from, to;
  const double t0 = e.along.dot(e.start - foot.place), h = std::abs(foot.height);
  if (!clip(foot.radius2, t0, t0 + e.length, from, to)) return;
  const auto r = [&](double t) { return length_of(h, t); };
  sum.weight += fine(from, to, [&](double t) { return radial_.kernel(r(t)); });
  sum.moment += (radial_.weight_beyond(r(from)) - radial_.weight_beyond(r(to))) * e.along;
  sum.hidden += std::copysign(1.0, foot.height) * fine(std::atan(from / h), std::atan(to / h), [&](double a) {
                  return radial_.weight_beyond(h / std::cos(a));
                });
}

/// ∫ Q dA = ∮ (P(foot) − P) p/ρ² dt and ∫ Q ρ dA = −∮ P ν dt, with P = ∫_ρ Q s ds, over the edges. All of them together
/// go once round a foot inside: so a foot on an edge between two sheets is inside of both or of none without harm.
template <int Dim> void WallIntegrals<Dim>::add_polygon(Sum& sum, const Sheet& sheet, const Foot& foot) const {
  bool inside = true;
  double within = 0;  // the angle (rad) under which the foot sees what the support cuts out of edges
  for (std::uint32_t k = sheet.edges_begin; k < sheet.edges_end; ++k) {
    const Edge& e = edges_[k];
    const auto [p, t0, t1] = EdgeSeen<Dim>(e, foot.place);
    inside = inside && p >= 0;
    double from, to;
    if (!clip(foot.radius2 - p * p, t0, t1, from, to)) continue;
    if (!e.cancels && from > t0 && to < t1) {
      take_off_beyond(sum, e, foot, p);
      continue;
    }
    within += angle_of(p, from, to);
    if (!e.cancels) add_along(sum, e, foot, p, from, to);
  }
  const double angle = (inside ? 2 * std::numbers::pi : 0) - within, h = std::abs(foot.height);
  sum.weight += radial_.weight_beyond(h) * angle;
  sum.hidden += std::copysign(radial_.hidden_beyond(h), foot.height) * angle;
}

/// What is beyond an edge that crosses the whole support.
template <int Dim> void WallIntegrals<Dim>::take_off_beyond(Sum& sum, const Edge& e, const Foot& foot, double p) const {
  const EdgeIntegrals::Beyond beyond = across_.beyond(std::abs(foot.height), std::abs(p));
  const double side = p < 0 ? -1 : 1;
  sum.weight -= side * beyond.weight;
  sum.hidden -= side * std::copysign(beyond.hidden, foot.height);
  sum.moment -= beyond.along * e.outward;
}

/// ∮ (P(foot) − P) p/ρ² dt and −∮ P ν dt over a part of an edge.
template <int Dim>
void WallIntegrals<Dim>::add_along(Sum& sum, const Edge& e, const Foot& foot, double p, double from, double to) const {
  const double least = least_height * reach(), h = foot.height, at_foot = std::abs(h);
  const double most_weight = radial_.weight_beyond(at_foot), most_hidden = radial_.hidden_beyond(at_foot) / at_foot;
  double weight = 0, hidden = 0, moment = 0;
  const auto integrate = [&](const auto& rule) {
    const double half = (to - from) / 2, middle = (to + from) / 2;
    for (std::size_t g = 0; g < rule.node.size(); ++g) {
      const double t = middle + half * rule.node[g], rho2 = std::max(p * p + t * t, least * least);
      const double r = std::sqrt(h * h + rho2), beyond = radial_.weight_beyond(r);
      weight += rule.weight[g] * half * p / rho2 * (most_weight - beyond);
      hidden += rule.weight[g] * half * p / rho2 * (most_hidden - radial_.hidden_beyond(r) / r);
      moment += rule.weight[g] * half * beyond;
    }
  };
  if (to - from < 1.5 * length_of(h, p))
    integrate(coarse);
  else
    integrate(fine);
  sum.weight += weight;
  sum.hidden += h * hidden;
  sum.moment -= moment * e.outward;
}

/// Does a disc in its plane have nothing in common with a convex sheet, seen from one edge?
template <int Dim> bool WallIntegrals<Dim>::misses(const Sheet& sheet, const Foot& foot) const {
  for (std::uint32_t k = sheet.edges_begin; k < sheet.edges_end; ++k) {
    const double p = edges_[k].outward.dot(edges_[k].start - foot.place);
    if (p < 0 && p * p >= foot.radius2) return true;
  }
  return false;
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
      nearest = length_of(d, std::min(std::abs(t0), std::abs(t1)));
    } else {
      const double p = e.outward.dot(a);
      inside = inside && p >= 0;
      if (!(outer_edges_alone && e.inner)) nearest = std::min(nearest, length_of(d, distance_to_segment(p, t0, t1)));
    }
  }
  return inside && !outer_edges_alone ? std::abs(d) : nearest;
}

template <int Dim> std::int32_t WallIntegrals<Dim>::plane_near(const Point<Dim>& x, double reach) const {
  std::int32_t found = no_plane;
  const auto look = [&](const Sheet& sheet) {
    const double gap = reach + sheet.radius;
    if (std::abs(sheet.normal.dot(x) - planes_[sheet.plane].offset) > reach) return;  // so are most sheets of a box
    if (found == many_planes || (sheet.centre - x).squaredNorm() > gap * gap || distance(sheet, x, false) > reach)
      return;
    const bool ends = distance(sheet, x, true) < reach;
    found = ends || (found != no_plane && found != sheet.plane) ? many_planes : sheet.plane;
  };
  const Point<Dim> span = Point<Dim>::Constant(std::max(0.0, reach - radial_.reach()));  // a cell lists what it reaches
  grid_.visit_box(x - span, x + span, [&](std::span<const std::int32_t> near) {
    for (std::size_t n = 0; n < near.size() && found != many_planes; ++n) {
      const Clump& clump = clumps_[near[n]];
      const double gap = reach + clump.radius;
      if ((clump.centre - x).squaredNorm() > gap * gap) continue;
      for (std::uint32_t k = clump.sheets_begin; k < clump.sheets_end; ++k) look(sheets_[k]);
    }
  });
  for (std::size_t k = facets_; k < sheets_.size(); ++k) look(sheets_[k]);
  return found;
}

template <int Dim> std::size_t WallIntegrals<Dim>::bytes() const {
  return grid_.bytes() + clumps_.capacity() * sizeof(Clump) + sheets_.capacity() * sizeof(Sheet) +
         edges_.capacity() * sizeof(Edge) + planes_.capacity() * sizeof(Plane);
}

template class WallIntegrals<2>;
template class WallIntegrals<3>;

}  // namespace molten
