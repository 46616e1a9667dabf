#include "core/boundary/sweep.h"

#include <Eigen/Geometry>
#include <cmath>

namespace molten {
namespace {

template <int Dim> using Long = Eigen::Matrix<long double, Dim, 1>;

constexpr long double thinnest = 1e-12L;  // altitude / longest edge under which a triangle has no usable normal

Point<2> unit_normal(const std::array<Point<2>, 2>& corner) {
  const Long<2> e = corner[1].cast<long double>() - corner[0].cast<long double>();
  const long double length = e.norm();
  if (!(length > 0)) return Point<2>::Zero();
  return (Long<2>(-e.y(), e.x()) / length).cast<double>();
}

Point<3> unit_normal(const std::array<Point<3>, 3>& corner) {
  const Long<3> a = corner[0].cast<long double>(), e = corner[1].cast<long double>() - a,
                f = corner[2].cast<long double>() - a;
  const Long<3> n = e.cross(f);
  const long double longest2 = std::max({e.squaredNorm(), f.squaredNorm(), (f - e).squaredNorm()});
  if (!(n.norm() > thinnest * longest2)) return Point<3>::Zero();
  return n.normalized().cast<double>();
}

/// Is x over the inside of the facet? x may be anywhere along the normal.
bool covers(const Facet<2>& f, const Point<2>& x) {
  const Point<2> e = f.corner[1] - f.corner[0];
  const double s = e.dot(x - f.corner[0]);
  return !f.normal.isZero(0) && s >= 0 && s <= e.squaredNorm();
}

bool covers(const Facet<3>& f, const Point<3>& x) {
  if (f.normal.isZero(0)) return false;
  for (int k = 0; k < 3; ++k) {
    const Point<3>&a = f.corner[k], &b = f.corner[(k + 1) % 3];
    if (f.normal.cross(b - a).dot(x - a) < 0) return false;
  }
  return true;
}

/// Does all of the path, which keeps at least `height` from the facet's plane, stay further than `radius` beyond one
/// end or edge of the facet? A cheap test for most.
bool passes_beside(const Facet<2>& f, const Point<2>& x, const Point<2>& d, double height, double radius) {
  const Point<2> e = f.corner[1] - f.corner[0];
  const double s = e.dot(x - f.corner[0]), end = s + e.dot(d), length2 = e.squaredNorm();
  const double beyond = std::max(-std::max(s, end), std::min(s, end) - length2);  // the end, × length
  return beyond > 0 && beyond * beyond > (radius * radius - height * height) * length2;
}

bool passes_beside(const Facet<3>& f, const Point<3>& x, const Point<3>& d, double height, double radius) {
  const double room2 = radius * radius - height * height;
  for (int k = 0; k < 3; ++k) {
    const Point<3>&a = f.corner[k], e = f.corner[(k + 1) % 3] - a, inwards = f.normal.cross(e);
    const double s = inwards.dot(x - a), inmost = std::max(s, s + inwards.dot(d));
    if (inmost < 0 && inmost * inmost > room2 * e.squaredNorm()) return true;
  }
  return false;
}

template <int Dim>
void keep_nearer(NearestPoint<Dim>& best, const Point<Dim>& x, const Point<Dim>& point, Feature feature, int index) {
  const double distance = (x - point).norm();
  if (distance < best.distance) best = {point, distance, feature, index};
}

void nearest_on_rim(NearestPoint<2>& best, const Facet<2>& f, const Point<2>& x) {
  for (int k = 0; k < 2; ++k) keep_nearer<2>(best, x, f.corner[k], Feature::vertex, k);
}

void nearest_on_rim(NearestPoint<3>& best, const Facet<3>& f, const Point<3>& x) {
  for (int k = 0; k < 3; ++k) keep_nearer<3>(best, x, f.corner[k], Feature::vertex, k);
  for (int k = 0; k < 3; ++k) {
    const Point<3>& a = f.corner[k];
    const Point<3> e = f.corner[(k + 1) % 3] - a;
    const double s = e.dot(x - a), length2 = e.squaredNorm();
    if (s > 0 && s < length2) keep_nearer<3>(best, x, a + e * (s / length2), Feature::edge, k);
  }
}

/// When |w + t v| first falls to `radius`, for t in 0..1 and w outside. The distance of closest approach is compared
/// rather than a discriminant: no cancellation on long paths.
template <int Dim> std::optional<double> entry(const Point<Dim>& w, const Point<Dim>& v, double radius) {
  const double speed2 = v.squaredNorm(), approach = -w.dot(v);
  if (!(approach > 0)) return {};
  const double closest = approach / speed2, room2 = radius * radius - (w + closest * v).squaredNorm();
  if (room2 < 0) return {};
  const double t = closest - std::sqrt(room2 / speed2);
  if (!(t <= 1)) return {};
  return std::max(t, 0.0);
}

template <int Dim> struct RimEntry {
  double t = HUGE_VAL;
  Feature feature = Feature::vertex;
  int index = 0;
  Point<Dim> point = Point<Dim>::Zero();  // where the sphere touches
};

template <int Dim>
void enter_vertex(RimEntry<Dim>& best, const Facet<Dim>& f, int k, const Point<Dim>& x, const Point<Dim>& d,
                  double radius) {
  const auto t = entry<Dim>(x - f.corner[k], d, radius);
  if (t && *t < best.t) best = {*t, Feature::vertex, k, f.corner[k]};
}

/// Edge k as a cylinder; where the cylinder is entered beyond an end, that end's sphere is met first or not at all.
void enter_edge(RimEntry<3>& best, const Facet<3>& f, int k, const Point<3>& x, const Point<3>& d, double radius) {
  const int next = (k + 1) % 3;
  const Point<3>& a = f.corner[k];
  const Point<3> e = f.corner[next] - a, w = x - a;
  const double length2 = e.squaredNorm();
  if (!(length2 > 0)) return enter_vertex(best, f, k, x, d, radius);
  const double along_w = w.dot(e) / length2, along_d = d.dot(e) / length2;
  const Point<3> across_w = w - along_w * e, across_d = d - along_d * e;
  double t = 0;
  if (across_w.squaredNorm() > radius * radius) {
    const auto cylinder = entry<3>(across_w, across_d, radius);
    if (!cylinder) return;
    t = *cylinder;
  }
  const double s = along_w + t * along_d;
  if (s < 0) return enter_vertex(best, f, k, x, d, radius);
  if (s > 1) return enter_vertex(best, f, next, x, d, radius);
  if (t < best.t) best = {t, Feature::edge, k, a + s * e};
}

RimEntry<2> enter_rim(const Facet<2>& f, const Point<2>& x, const Point<2>& d, double radius) {
  RimEntry<2> best;
  for (int k = 0; k < 2; ++k) enter_vertex(best, f, k, x, d, radius);
  return best;
}

RimEntry<3> enter_rim(const Facet<3>& f, const Point<3>& x, const Point<3>& d, double radius) {
  RimEntry<3> best;
  for (int k = 0; k < 3; ++k) enter_edge(best, f, k, x, d, radius);
  return best;
}

/// The direction from `point` to the centre, or the facet's own normal where they coincide.
template <int Dim>
Point<Dim> direction(const Facet<Dim>& f, const Point<Dim>& centre, const Point<Dim>& point, const Point<Dim>& d) {
  const Point<Dim> away = centre - point;
  if (away.squaredNorm() > 0) return away.normalized();
  return f.normal.isZero(0) ? Point<Dim>(-d.normalized()) : f.normal;
}

/// The facet is convex, so a sphere that moves away from its nearest point never comes back: one test decides.
template <int Dim>
std::optional<SweepHit<Dim>> overlap_at_start(const Facet<Dim>& f, const NearestPoint<Dim>& near, const Point<Dim>& x,
                                              const Point<Dim>& d) {
  const Point<Dim> n = near.feature == Feature::face ? f.normal : direction(f, x, near.point, d);
  if (n.dot(f.normal) < -side_tolerance || n.dot(d) >= -sliding_tolerance * d.norm()) return {};
  return SweepHit<Dim>{0, n, near.feature, near.index};
}

}  // namespace

template <int Dim> Facet<Dim> make_facet(const std::array<Point<Dim>, Dim>& corner) {
  return {corner, unit_normal(corner)};
}

template <int Dim> NearestPoint<Dim> nearest_point(const Facet<Dim>& f, const Point<Dim>& x) {
  if (covers(f, x)) {
    const double height = f.normal.dot(x - f.corner[0]);
    return {x - height * f.normal, std::abs(height), Feature::face, 0};
  }
  NearestPoint<Dim> best{f.corner[0], HUGE_VAL, Feature::vertex, 0};
  nearest_on_rim(best, f, x);
  return best;
}

template <int Dim> bool further_than(const Facet<Dim>& f, const Point<Dim>& x, double distance) {
  const double height = std::abs(f.normal.dot(x - f.corner[0]));
  return height > distance || passes_beside(f, x, Point<Dim>::Zero(), height, distance);
}

template <int Dim>
std::optional<SweepHit<Dim>> sweep_facet(const Facet<Dim>& f, const Point<Dim>& x, const Point<Dim>& d, double radius) {
  const double height = f.normal.dot(x - f.corner[0]), descent = -f.normal.dot(d), end = height - descent;
  if (misses_slab(height, descent, radius) || d.isZero(0)) return {};
  const double least = height * end > 0 ? std::min(std::abs(height), std::abs(end)) : 0;
  if (passes_beside(f, x, d, least, radius)) return {};
  if (std::abs(height) > radius) {  // so it nears: the plane is met before any edge, and counts if over the inside
    const double t = std::min((std::abs(height) - radius) / std::abs(descent), 1.0);
    if (covers(f, Point<Dim>(x + t * d))) {
      if (height < 0) return {};
      return SweepHit<Dim>{t, f.normal, Feature::face, 0};
    }
  } else {
    const auto near = nearest_point(f, x);
    if (near.distance <= radius) return overlap_at_start(f, near, x, d);
  }
  const RimEntry<Dim> rim = enter_rim(f, x, d, radius);
  if (!(rim.t <= 1)) return {};
  const Point<Dim> n = direction(f, Point<Dim>(x + rim.t * d), rim.point, d);
  if (n.dot(f.normal) < -side_tolerance) return {};
  return SweepHit<Dim>{rim.t, n, rim.feature, rim.index};
}

template <int Dim>
std::optional<SweepHit<Dim>> sweep_plane(const Point<Dim>& point, const Point<Dim>& normal, const Point<Dim>& x,
                                         const Point<Dim>& d, double radius) {
  const double height = normal.dot(x - point), descent = -normal.dot(d);
  if (height < -radius || !(descent > sliding_tolerance * d.norm())) return {};
  const double t = std::max((height - radius) / descent, 0.0);
  if (!(t <= 1)) return {};
  return SweepHit<Dim>{t, normal, Feature::face, 0};
}

#define MOLTEN_SWEEP(Dim)                                                                                         \
  template Facet<Dim> make_facet<Dim>(const std::array<Point<Dim>, Dim>&);                                        \
  template NearestPoint<Dim> nearest_point<Dim>(const Facet<Dim>&, const Point<Dim>&);                            \
  template bool further_than<Dim>(const Facet<Dim>&, const Point<Dim>&, double);                                  \
  template std::optional<SweepHit<Dim>> sweep_facet<Dim>(const Facet<Dim>&, const Point<Dim>&, const Point<Dim>&, \
                                                         double);                                                 \
  template std::optional<SweepHit<Dim>> sweep_plane<Dim>(const Point<Dim>&, const Point<Dim>&, const Point<Dim>&, \
                                                         const Point<Dim>&, double);
MOLTEN_SWEEP(2)
MOLTEN_SWEEP(3)
#undef MOLTEN_SWEEP

}  // namespace molten
