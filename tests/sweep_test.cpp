// The swept sphere against an oracle that shares nothing with it: the distance from a point to a triangle in extended
// precision (Ericson 2005, 5.1.5), made into a time of contact by search and bisection, since along a straight path the
// distance to a convex set is convex.
#include "core/boundary/sweep.h"

#include <gtest/gtest.h>

#include "tests/contact_shapes.h"

namespace molten::sweep_test {
namespace {

using contact_test::Random;

template <int Dim> using Long = Eigen::Matrix<long double, Dim, 1>;

template <int Dim> Long<Dim> on_segment(const Long<Dim>& a, const Long<Dim>& b, const Long<Dim>& x) {
  const Long<Dim> e = b - a;
  const long double length2 = e.squaredNorm();
  return length2 > 0 ? Long<Dim>(a + e * std::clamp(e.dot(x - a) / length2, 0.0L, 1.0L)) : a;
}

Long<2> oracle_nearest(const std::array<Long<2>, 2>& f, const Long<2>& x) { return on_segment<2>(f[0], f[1], x); }

Long<3> oracle_nearest(const std::array<Long<3>, 3>& f, const Long<3>& x) {
  Long<3> best = on_segment<3>(f[0], f[1], x);
  const auto keep = [&](const Long<3>& q) {
    if ((x - q).norm() < (x - best).norm()) best = q;
  };
  keep(on_segment<3>(f[1], f[2], x));
  keep(on_segment<3>(f[2], f[0], x));
  const Long<3> ab = f[1] - f[0], ac = f[2] - f[0], ap = x - f[0];
  const long double aa = ab.dot(ab), bb = ac.dot(ac), c = ab.dot(ac), p = ab.dot(ap), q = ac.dot(ap);
  const long double v = bb * p - c * q, w = aa * q - c * p, det = aa * bb - c * c;
  if (v >= 0 && w >= 0 && v + w <= det && det > 0) keep(f[0] + ab * (v / det) + ac * (w / det));
  return best;
}

template <int Dim> struct Oracle {
  std::array<Long<Dim>, Dim> f;
  Long<Dim> x, d;
  long double radius;

  long double distance(long double t) const {
    const Long<Dim> p = x + t * d;
    return (p - oracle_nearest(f, p)).norm();
  }
  long double closest() const {
    long double a = 0, b = 1;
    for (int i = 0; i < 80; ++i) {
      const long double s = a + (b - a) * 0.382L, t = a + (b - a) * 0.618L;
      distance(s) <= distance(t) ? b = t : a = s;
    }
    return distance(0) <= distance((a + b) / 2) ? 0 : (a + b) / 2;
  }
  /// The first time at the radius, before `t` where it is nearer.
  long double first(long double t) const {
    long double a = 0;
    for (int i = 0; i < 62; ++i) (distance((a + t) / 2) > radius ? a : t) = (a + t) / 2;
    return t;
  }
};

struct Counts {
  int hits = 0, misses = 0, false_hits = 0, starts = 0, undecided = 0;
  double worst_gap = 0, worst_delay = 0, worst_normal = 0;  // in radii; delay: how far behind the oracle along the path
};

/// Compares one sweep (radius 1) and counts. Grazes and rims seen edge-on within the tolerance may go either way.
template <int Dim>
void compare(const std::array<Point<Dim>, Dim>& corner, const Point<Dim>& x, const Point<Dim>& d, Counts& counts) {
  constexpr double tolerance = 1e-9;
  const Facet<Dim> facet = make_facet<Dim>(corner);
  const auto hit = sweep_facet<Dim>(facet, x, d, 1.0);
  Oracle<Dim> oracle{{}, x.template cast<long double>(), d.template cast<long double>(), 1};
  for (int k = 0; k < Dim; ++k) oracle.f[k] = corner[k].template cast<long double>();
  const Long<Dim> front = facet.normal.template cast<long double>();
  if (oracle.distance(0) <= 1 + tolerance) return void(++counts.starts);  // tested apart
  const long double near = oracle.closest(), gap = oracle.distance(near) - 1;
  if (std::abs(gap) < tolerance) return void(++counts.undecided);
  bool expected = gap < 0;
  long double t = 0;
  Long<Dim> n = Long<Dim>::Zero();
  if (expected) {
    t = oracle.first(near);
    const Long<Dim> c = oracle.x + t * oracle.d;
    n = (c - oracle_nearest(oracle.f, c)).normalized();
    if (std::abs(n.dot(front)) < 1e-7L) return void(++counts.undecided);
    expected = n.dot(front) > 0;
  }
  counts.hits += expected;
  counts.misses += expected && !hit;
  counts.false_hits += !expected && hit;
  if (!expected || !hit) return;
  const auto length = d.norm();
  counts.worst_gap = std::max(counts.worst_gap, double(std::abs(oracle.distance(hit->t) - 1)));
  // Near a graze the time is ill-conditioned; the depth that an error of time means is what counts.
  const double approach = -double(n.dot(oracle.d)) / length;
  counts.worst_delay = std::max(counts.worst_delay, double(std::abs(hit->t - t)) * length * approach);
  counts.worst_normal =
      std::max(counts.worst_normal, (hit->normal - n.template cast<double>()).norm() * std::min(1.0, approach));
}

template <int Dim> Point<Dim> on_facet(const std::array<Point<Dim>, Dim>& corner, Random<Dim>& random) {
  const int kind = static_cast<int>(random.uniform(0, 4));  // inside twice as often as on an edge or at a corner
  if (kind == 0) return corner[0];
  double a = random.uniform(0, 1), b = kind == 1 ? 0 : random.uniform(0, 1);
  if (a + b > 1) a = 1 - a, b = 1 - b;
  Point<Dim> p = corner[0] + a * (corner[1] - corner[0]);
  if constexpr (Dim == 3) p += b * (corner[2] - corner[0]);
  return p;
}

std::array<Point<2>, 2> random_facet(Random<2>& random) {
  const double size = random.scale(0.01, 100);
  return {random.point(size), random.point(size)};
}

/// Every other triangle is a needle: a thin sliver or a cap.
std::array<Point<3>, 3> random_facet(Random<3>& random) {
  const double size = random.scale(0.01, 100);
  std::array<Point<3>, 3> corner = {random.point(size), random.point(size), random.point(size)};
  if (random.uniform() > 0)
    corner[2] =
        corner[0] + random.uniform(-0.2, 1.2) * (corner[1] - corner[0]) + random.point(size * random.scale(1e-9, 0.1));
  return corner;
}

/// Paths that are aimed at, past or along the facet; up to 1000 radii long.
template <int Dim> Counts compare_random(int n) {
  Random<Dim> random(Dim);
  Counts counts;
  for (int i = 0; i < n; ++i) {
    const auto corner = random_facet(random);
    const Point<Dim> aim = on_facet<Dim>(corner, random) + random.uniform(0, 1.5) * random.unit();
    const double before = random.scale(1, 1000), after = random.scale(0.1, 1000) - 0.1;
    Point<Dim> way = random.unit();
    const Point<Dim> along = corner[1] - corner[0];
    if (random.uniform() > 0.5 && along.norm() > 0)
      way = (along.normalized() + random.scale(1e-9, 1) * way).normalized();
    compare<Dim>(corner, aim - before * way, (before + after) * way, counts);
  }
  std::printf(
      "%d-D: %d sweeps, %d hits, %d misses, %d false hits, %d within 1e-9 of a graze, %d began near; "
      "worst gap %.1e, delay %.1e, normal %.1e radii\n",
      Dim, n, counts.hits, counts.misses, counts.false_hits, counts.undecided, counts.starts, counts.worst_gap,
      counts.worst_delay, counts.worst_normal);
  return counts;
}

template <int Dim> void expect_exact(const Counts& counts, int n) {
  EXPECT_EQ(counts.misses, 0);
  EXPECT_EQ(counts.false_hits, 0);
  EXPECT_GT(counts.hits, n / 8);
  EXPECT_LT(counts.undecided, n / 100);
  EXPECT_LT(counts.worst_gap, 1e-9);
  EXPECT_LT(counts.worst_delay, 1e-9);
  EXPECT_LT(counts.worst_normal, 1e-6);
}

TEST(Sweep, AgreesWithTheOracleIn2d) { expect_exact<2>(compare_random<2>(100000), 100000); }
TEST(Sweep, AgreesWithTheOracleIn3d) { expect_exact<3>(compare_random<3>(100000), 100000); }

/// [P] algorithm 2 as printed: the sphere is tested only where it meets the plane, and eq. 6-10's time may be negative.
bool printed_form_hits(const Facet<3>& f, const Point<3>& x, const Point<3>& d, double radius) {
  if (d.dot(f.normal) >= 0) return false;
  const double t = (std::abs((x - f.corner[0]).dot(f.normal)) - radius) / std::abs(d.dot(f.normal));
  return t >= 0 && t < 1 && nearest_point<3>(f, x + t * d).distance <= radius * (1 + 1e-12);
}

const Facet<3> unit_triangle = make_facet<3>({Point<3>(0, 0, 0), Point<3>(1, 0, 0), Point<3>(0, 1, 0)});

TEST(Sweep, MeetsAnEdgeLaterThanThePlane) {
  // Grazing flight from beyond the edge y = 0: at height 0.1 over the plane the sphere is far from the triangle.
  const Point<3> x(0.3, -1, 0.11), d(0, 1, -0.05);
  EXPECT_FALSE(printed_form_hits(unit_triangle, x, d, 0.1));
  const auto hit = sweep_facet<3>(unit_triangle, x, d, 0.1);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->feature, Feature::edge);
  EXPECT_NEAR((x + hit->t * d).tail<2>().norm(), 0.1, 1e-12);
}

TEST(Sweep, MeetsAVertexLaterThanThePlane) {
  const Point<3> x(-1, -1, 0.11), d(1, 1, -0.05);
  EXPECT_FALSE(printed_form_hits(unit_triangle, x, d, 0.1));
  const auto hit = sweep_facet<3>(unit_triangle, x, d, 0.1);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->feature, Feature::vertex);
  EXPECT_NEAR((x + hit->t * d).norm(), 0.1, 1e-12);
}

TEST(Sweep, HoldsAnOverlapAtTheStart) {
  for (const double height : {0.09, 0.0, -0.05}) {
    const Point<3> x(0.2, 0.2, height), d(0.1, 0, -1);
    EXPECT_FALSE(printed_form_hits(unit_triangle, x, d, 0.1) && height > 0);
    const auto hit = sweep_facet<3>(unit_triangle, x, d, 0.1);
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->t, 0);
    EXPECT_EQ(hit->normal, Point<3>(0, 0, 1));
    EXPECT_FALSE(sweep_facet<3>(unit_triangle, x, -d, 0.1)) << "moving away";
  }
  EXPECT_FALSE(sweep_facet<3>(unit_triangle, Point<3>(0.2, 0.2, -0.11), Point<3>(0, 0, -1), 0.1));
}

TEST(Sweep, PassesFromBehind) {
  const auto hit = sweep_facet<3>(unit_triangle, Point<3>(0.2, 0.2, -1), Point<3>(0, 0, 2), 0.1);
  EXPECT_FALSE(hit);
  EXPECT_FALSE(sweep_plane<3>(Point<3>(0, 0, 0), Point<3>(0, 0, 1), Point<3>(0, 0, -1), Point<3>(0, 0, 2), 0.1));
}

TEST(Sweep, PlaneIsExact) {
  const Point<2> p(0, 1), n(0, 1);
  const auto hit = sweep_plane<2>(p, n, Point<2>(0, 3), Point<2>(5, -4), 0.5);
  ASSERT_TRUE(hit);
  EXPECT_DOUBLE_EQ(hit->t, 1.5 / 4);
  EXPECT_EQ(sweep_plane<2>(p, n, Point<2>(0, 1.2), Point<2>(0, -1), 0.5)->t, 0);
  EXPECT_FALSE(sweep_plane<2>(p, n, Point<2>(0, 3), Point<2>(5, -1.4), 0.5));
  EXPECT_FALSE(sweep_plane<2>(p, n, Point<2>(0, 3), Point<2>(5, 0), 0.5));
}

TEST(Sweep, FacetsWithoutAreaHoldFromAllSides) {
  const Facet<3> line = make_facet<3>({Point<3>(0, 0, 0), Point<3>(1, 0, 0), Point<3>(3, 0, 0)});
  const Facet<3> dot = make_facet<3>({Point<3>(1, 0, 0), Point<3>(1, 0, 0), Point<3>(1, 0, 0)});
  const Facet<2> dot2 = make_facet<2>({Point<2>(1, 0), Point<2>(1, 0)});
  for (const double side : {-1.0, 1.0}) {
    EXPECT_NEAR(sweep_facet<3>(line, Point<3>(2, 0, side), Point<3>(0, 0, -2 * side), 0.2)->t, 0.4, 1e-12);
    EXPECT_NEAR(sweep_facet<3>(dot, Point<3>(1, side, 0), Point<3>(0, -2 * side, 0), 0.2)->t, 0.4, 1e-12);
    EXPECT_NEAR(sweep_facet<2>(dot2, Point<2>(1, side), Point<2>(0, -2 * side), 0.2)->t, 0.4, 1e-12);
  }
}

TEST(Sweep, AtRestMeetsNothing) {
  EXPECT_FALSE(sweep_facet<3>(unit_triangle, Point<3>(0.2, 0.2, 0.05), Point<3>(0, 0, 0), 0.1));
  EXPECT_FALSE(sweep_facet<3>(unit_triangle, Point<3>(0.2, 0.2, 0), Point<3>(0, 0, 0), 0.1));
}

}  // namespace
}  // namespace molten::sweep_test
