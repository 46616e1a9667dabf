// Whole contact searches against a brute-force oracle that shares nothing with them: the distance from a point to every
// triangle (Ericson 2005, 5.1.5), minimised along the path; grid and tree, meshes with shared edges, corners and
// needles, paths of up to 1000 spacings. A particle that stops where it hits must have touched (no false hit) and must
// never have been nearer than its radius (no miss), beyond a tolerance of 1e-7 radii.
#include <gtest/gtest.h>

#include "core/boundary/contact.h"
#include "core/particle_pass.h"
#include "tests/contact_shapes.h"

namespace molten::contact_sweeps_test {
namespace {

using namespace contact_test;

constexpr double radius = 0.05, tolerance = 1e-7 * radius;
using Triangle = std::array<Point<3>, 3>;

double distance_to_segment(const Point<3>& a, const Point<3>& b, const Point<3>& x) {
  const Point<3> e = b - a;
  const double length2 = e.squaredNorm();
  const double s = length2 > 0 ? std::clamp(e.dot(x - a) / length2, 0.0, 1.0) : 0;
  return (x - a - s * e).norm();
}

double distance_to_triangle(const Triangle& f, const Point<3>& x) {
  double best = distance_to_segment(f[0], f[1], x);
  best = std::min(best, distance_to_segment(f[1], f[2], x));
  best = std::min(best, distance_to_segment(f[2], f[0], x));
  const Point<3> n = (f[1] - f[0]).cross(f[2] - f[0]);
  bool over = n.squaredNorm() > 0;
  for (int k = 0; k < 3; ++k) over = over && n.cross(f[(k + 1) % 3] - f[k]).dot(x - f[k]) >= 0;
  return over ? std::min(best, std::abs(n.normalized().dot(x - f[0]))) : best;
}

/// The least distance on the way from a to b: it is convex along a straight path.
double closest_approach(const Triangle& f, const Point<3>& a, const Point<3>& b) {
  constexpr double golden = 0.6180339887498949;
  double low = 0, high = 1, s = 1 - golden, t = golden;
  double at_s = distance_to_triangle(f, a + s * (b - a)), at_t = distance_to_triangle(f, a + t * (b - a));
  for (int i = 0; i < 70; ++i) {
    if (at_s <= at_t) {
      high = t, t = s, at_t = at_s, s = high - golden * (high - low);
      at_s = distance_to_triangle(f, a + s * (b - a));
    } else {
      low = s, s = t, at_s = at_t, t = low + golden * (high - low);
      at_t = distance_to_triangle(f, a + t * (b - a));
    }
  }
  return std::min({at_s, at_t, distance_to_triangle(f, a), distance_to_triangle(f, b)});
}

struct Mesh {
  Wall<3> wall;
  std::vector<Triangle> triangles;

  explicit Mesh(Wall<3> w) : wall(std::move(w)) {
    for (const auto& f : wall.facets)
      triangles.push_back({wall.vertices[f[0]], wall.vertices[f[1]], wall.vertices[f[2]]});
  }
  double distance(const Point<3>& x) const {
    double least = HUGE_VAL;
    for (const Triangle& f : triangles) least = std::min(least, distance_to_triangle(f, x));
    return least;
  }
  /// Only as exact as it must be where the path stays far away.
  double closest(const Point<3>& a, const Point<3>& b) const {
    double least = HUGE_VAL;
    for (const Triangle& f : triangles) {
      const double size = std::max((f[1] - f[0]).norm(), (f[2] - f[0]).norm());
      if (distance_to_segment(a, b, f[0]) < size + 2 * radius) least = std::min(least, closest_approach(f, a, b));
    }
    return least;
  }
};

/// Thin sheets that hold from both sides: a fan of needles about a corner, a strip with shared edges, loose triangles.
Mesh sheets(Random<3>& random) {
  Wall<3> wall;
  wall.two_sided = true;
  const double size = random.scale(0.2, 20) * radius * 10;
  const auto vertex = [&](const Point<3>& x) {
    wall.vertices.push_back(x);
    return static_cast<std::int32_t>(wall.vertices.size() - 1);
  };
  const auto hub = vertex(size * random.point());
  const int blades = 3 + static_cast<int>(random.uniform(0, 9));
  const double tilt = random.uniform(0, 1);
  for (int i = 0; i < blades; ++i)
    vertex(wall.vertices[hub] + size * Point<3>(std::cos(6.3 * i / 9), std::sin(6.3 * i / 9), tilt * random.uniform()));
  for (int i = 1; i < blades; ++i) wall.facets.push_back({hub, hub + i, hub + i + 1});
  auto a = vertex(size * random.point()), b = vertex(size * random.point());
  for (int i = 0; i < 6; ++i) {
    const Point<3> away = size * random.scale(1e-6, 1) * random.unit();
    const auto c = vertex(wall.vertices[a] + random.uniform(0, 1) * (wall.vertices[b] - wall.vertices[a]) + away);
    wall.facets.push_back({a, b, c});
    (random.uniform() > 0 ? a : b) = c;
  }
  for (int i = 0; i < 4; ++i) {
    const Point<3> at = 2 * size * random.point();
    wall.facets.push_back({vertex(at), vertex(at + size * random.point()), vertex(at + size * random.point())});
  }
  return Mesh(wall);
}

/// A closed body with raised and sunken tips, met from outside.
Mesh spiky(Random<3>& random) {
  Wall<3> wall = box(random.scale(2, 40) * radius, false);
  std::vector<std::array<std::int32_t, 3>> facets;
  for (const auto& f : wall.facets) {
    const auto tip = static_cast<std::int32_t>(wall.vertices.size());
    const Point<3> middle = (wall.vertices[f[0]] + wall.vertices[f[1]] + wall.vertices[f[2]]) / 3;
    wall.vertices.push_back(Point<3>(random.uniform(0.9, 1.5) * middle));
    for (int k = 0; k < 3; ++k) facets.push_back({f[k], f[(k + 1) % 3], tip});
  }
  wall.facets = facets;
  return Mesh(wall);
}

struct Counts {
  long sweeps = 0, hits = 0, misses = 0, false_hits = 0;
  double deepest = 0, loosest = 0;  // radii; worst nearness and worst distance of what was touched

  void operator+=(const Counts& c) {
    sweeps += c.sweeps, hits += c.hits, misses += c.misses, false_hits += c.false_hits;
    deepest = std::max(deepest, c.deepest), loosest = std::max(loosest, c.loosest);
  }
};

void sweep_once(const Contact<3>& contact, const Mesh& mesh, Random<3>& random, bool outside, Counts& counts) {
  const auto& f = mesh.triangles[static_cast<std::size_t>(random.uniform(0, 0.999999) * mesh.triangles.size())];
  double u = random.uniform(0, 1), v = random.uniform(0, 1);
  if (u + v > 1) u = 1 - u, v = 1 - v;
  if (random.uniform() > 0.5) v = 0;  // at an edge
  if (random.uniform() > 0.7) u = 0;  // … or a corner
  const Point<3> target = f[0] + u * (f[1] - f[0]) + v * (f[2] - f[0]) + random.uniform(0, 3) * radius * random.unit();
  Point<3> way = random.unit();
  if (random.uniform() > 0.5) way = ((f[1] - f[0]).normalized() + random.scale(1e-8, 1) * way).normalized();
  const Point<3> x = target - random.scale(1, 1000) * radius * way,
                 d = target + random.scale(0.1, 1000) * radius * way - x;
  if (mesh.distance(x) < radius + tolerance) return;
  if (outside && contact.signed_distance(x, 1000) < 0) return;
  Motion<3> m{x, d, d};
  const int bounces = contact.move(m, 1);
  ++counts.sweeps;
  counts.hits += bounces > 0;
  const double depth = radius - mesh.closest(x, m.position), gap = mesh.distance(m.position) - radius;
  counts.misses += depth > tolerance || (bounces == 0 && m.position != x + d);
  counts.false_hits += bounces > 0 && gap > tolerance;
  counts.deepest = std::max(counts.deepest, depth / radius);
  if (bounces > 0) counts.loosest = std::max(counts.loosest, gap / radius);
}

/// Over so many meshes, numbered from `first` on.
void expect_exact(std::size_t first, std::size_t meshes, int sweeps_each) {
  std::vector<Counts> parts(meshes);
  for_each_piece(meshes, [&](std::size_t k) {
    Random<3> random(static_cast<unsigned>(first + k + 1));
    const bool outside = k % 3 == 0;
    const Mesh mesh = outside ? spiky(random) : sheets(random);
    const auto method = k % 2 ? SearchMethod::tree : SearchMethod::grid;
    const Contact<3> contact({mesh.wall}, radius, 5 * radius, method);
    while (parts[k].sweeps < sweeps_each) sweep_once(contact, mesh, random, outside, parts[k]);
  });
  Counts all;
  for (const Counts& c : parts) all += c;
  std::printf("%ld sweeps, %ld hits, %ld misses, %ld false hits; worst depth %.1e, worst gap %.1e radii\n", all.sweeps,
              all.hits, all.misses, all.false_hits, all.deepest, all.loosest);
  EXPECT_EQ(all.misses, 0);
  EXPECT_EQ(all.false_hits, 0);
  EXPECT_GT(all.hits, all.sweeps / 8);
}

TEST(ContactSweeps, NeitherMissesNorFalseHits) { expect_exact(0, 200, 500); }

class SlowContactSweeps : public testing::TestWithParam<int> {};
TEST_P(SlowContactSweeps, NeitherMissesNorFalseHits) { expect_exact(1000 + 500 * GetParam(), 500, 5000); }
INSTANTIATE_TEST_SUITE_P(QuarterOfTenMillion, SlowContactSweeps, testing::Range(0, 4));

// ---- grid and tree --------------------------------------------------------------------------------------------------

/// Moves of all lengths, several bounces each, through both searches.
void expect_same(const std::vector<Wall<3>>& walls, double span, unsigned seed, int moves) {
  const Contact<3> grid(walls, radius, 5 * radius, SearchMethod::grid),
      tree(walls, radius, 5 * radius, SearchMethod::tree), rule(walls, radius, 5 * radius);
  Random<3> random(seed);
  int bounced = 0;
  for (int i = 0; i < moves; ++i) {
    const Point<3> x = span * random.point(), v = random.scale(0.1, 400) * random.unit();
    Motion<3> a{x, v, v + 0.1 * random.point()}, b = a, c = a;
    const int n = grid.move(a, 0.5);
    ASSERT_EQ(tree.move(b, 0.5), n);
    ASSERT_EQ(rule.move(c, 0.5), n);
    ASSERT_TRUE(a.position == b.position && a.velocity == b.velocity && a.rate == b.rate) << x.transpose();
    ASSERT_TRUE(a.position == c.position && a.velocity == c.velocity && a.rate == c.rate) << x.transpose();
    ASSERT_EQ(grid.signed_distance(x, 3 * radius), tree.signed_distance(x, 3 * radius));
    bounced += n > 0;
  }
  EXPECT_GT(bounced, moves / 20);
}

TEST(ContactSearch, GridAndTreeGiveTheSameContacts) {
  Random<3> random(6);
  for (unsigned k = 0; k < 20; ++k) {
    Wall<3> sheet = sheets(random).wall, body = spiky(random).wall;
    sheet.response = {0.5, 0.9};
    body.response = {1, 1};
    expect_same({sheet, body, plane<3>({0, 0, -1}, {0, 0, 1}, {0.5, 1})}, 2, k, 1000);
  }
  // Ties: many facets at one corner, hit exactly there; and far from the origin, where single precision is coarse.
  Wall<3> hills = terrain(20, [&](int i, int j) { return (i + j) % 2 ? 0.3 : 0.0; }, {0.9, 1});
  const auto shift = [&](const Point<3>& by) {
    for (auto& v : hills.vertices) v += by;
  };
  shift({-10, -10, 0});
  expect_same({hills}, 10, 50, 20000);
  shift({1e6 + 10, -3e5 + 10, 1e4});
  const Contact<3> grid({hills}, radius, 5 * radius, SearchMethod::grid),
      tree({hills}, radius, 5 * radius, SearchMethod::tree);
  for (int i = 0; i < 20000; ++i) {
    const Point<3> corner(1e6 + static_cast<int>(random.uniform(1, 19)), -3e5 + static_cast<int>(random.uniform(1, 19)),
                          1e4);
    const Point<3> d = random.scale(1, 1000) * Point<3>(random.uniform(), random.uniform(), -random.uniform(0.1, 1));
    Motion<3> a{corner - 0.3 * d, d, d}, b = a;
    ASSERT_EQ(grid.move(a, 1), tree.move(b, 1));
    ASSERT_EQ(a.position, b.position);
  }
}

/// A way of no length has no direction to look along; steps of bodies and particles at rest have such.
TEST(ContactSearch, RestingIsNoWay) {
  const Wall<3> box = contact_test::box(1, true);
  const Contact<3> grid({box}, radius, 5 * radius, SearchMethod::grid),
      tree({box}, radius, 5 * radius, SearchMethod::tree);
  Random<3> random(5);
  for (int i = 0; i < 1000; ++i) {
    const Point<3> x = 1.1 * random.point();
    for (const double speed : {0.0, 1e-320, 1e-200}) {
      Motion<3> a{x, random.unit(), speed * random.unit()}, b = a;
      ASSERT_EQ(grid.move(a, 1), tree.move(b, 1));
      ASSERT_TRUE(a.position == b.position && a.velocity == b.velocity && a.rate == b.rate) << x.transpose();
    }
  }
}

TEST(ContactSearch, GridAndTreeGiveTheSameContactsIn2d) {
  Random<2> random(7);
  std::vector<Point<2>> corner;
  for (int i = 0; i < 40; ++i)
    corner.push_back(random.uniform(0.5, 2) * Point<2>(std::cos(i * 2 * M_PI / 40), std::sin(i * 2 * M_PI / 40)));
  const Wall<2> star = chain(corner, true, {0.9, 1});
  const Contact<2> grid({star}, radius, 5 * radius, SearchMethod::grid),
      tree({star}, radius, 5 * radius, SearchMethod::tree);
  for (int i = 0; i < 20000; ++i) {
    const Point<2> v = random.scale(1e-2, 500) * random.unit();
    Motion<2> a{2 * random.point(), v, v}, b = a;
    ASSERT_EQ(grid.move(a, 0.5), tree.move(b, 0.5));
    ASSERT_TRUE(a.position == b.position && a.velocity == b.velocity);
  }
}

TEST(SlowContactSearch, AMillionTrianglesGoThroughTheTree) {
  const int n = 720;  // 1 036 800 triangles
  const Wall<3> hills = terrain(n, [](int i, int j) { return 3 * std::sin(0.1 * i) * std::cos(0.13 * j); }, {0.5, 1});
  const Contact<3> contact({hills}, radius, 5 * radius);
  Random<3> random(9);
  int bounces = 0;
  for (int i = 0; i < 20000; ++i) {
    Motion<3> m{{random.uniform(10, n - 10), random.uniform(10, n - 10), 8}, {}, {}};
    m.velocity = m.rate = random.scale(1, 300) * Point<3>(random.uniform(), random.uniform(), -random.uniform(0.2, 1));
    bounces += contact.move(m, 1);
    if (m.position.x() < 1 || m.position.y() < 1 || m.position.x() > n - 1 || m.position.y() > n - 1) continue;
    ASSERT_GT(contact.signed_distance(m.position, 1), 0) << m.position.transpose();
  }
  EXPECT_GT(bounces, 10000);
}

// ---- two-sided ------------------------------------------------------------------------------------------------------

TEST(ContactTwoSided, HoldsFromBothSidesWithoutBumps) {
  Wall<3> sheet = terrain(20, [](int, int) { return 0.0; }, {0, 1});
  sheet.two_sided = true;
  const Contact<3> contact({sheet}, radius, 5 * radius);
  for (const double side : {-1.0, 1.0})
    for (const double angle : {0.0, M_PI / 4, 0.3}) {
      Motion<3> m{{1, 1, side * radius}, {std::cos(angle), std::sin(angle), 0}, {}};
      const Point<3> along = m.velocity;
      for (int step = 0; step < 1500; ++step) {
        m.velocity.z() -= side * 0.1;
        m.rate = m.velocity;
        contact.move(m, 0.01);
        ASSERT_NEAR(m.position.z(), side * radius, 1e-7 * radius);
      }
      EXPECT_NEAR((m.velocity - along).norm(), 0, 1e-8);
    }
}

TEST(ContactTwoSided, AParticlePinchedBetweenSheetsStays) {
  // Two sheets that meet at 10 degrees: pushed into the corner, the centre stays between them.
  const double slope = std::tan(0.087);
  Wall<3> wedge;
  wedge.vertices = {{0, -2, 0},        {0, 2, 0},           {2, -2, 2 * slope},
                    {2, 2, 2 * slope}, {2, -2, -2 * slope}, {2, 2, -2 * slope}};
  wedge.facets = {{0, 1, 3}, {0, 3, 2}, {0, 4, 5}, {0, 5, 1}};
  wedge.two_sided = true;
  wedge.response = {0, 1};
  const Contact<3> contact({wedge}, radius, 5 * radius);
  Random<3> random(3);
  Motion<3> m{{1.5, 0, 0}, {}, {}};
  for (int step = 0; step < 5000; ++step) {
    m.velocity = m.rate = Point<3>(-3, 0, 0) + random.point();
    m.velocity.y() = m.rate.y() = 0;
    contact.move(m, 0.01);
    ASSERT_LT(std::abs(m.position.z()), slope * m.position.x());
  }
}

}  // namespace
}  // namespace molten::contact_sweeps_test
