#include "core/boundary/facet_grid.h"

#include <gtest/gtest.h>

#include <set>

#include "core/boundary/facet_sides.h"
#include "tests/contact_shapes.h"

namespace molten::facet_grid_test {
namespace {

using contact_test::Random;

std::array<Point<2>, 2> small_facet(Random<2>& random, const Point<2>& at, double size) {
  return {at, at + random.point(size)};
}
std::array<Point<3>, 3> small_facet(Random<3>& random, const Point<3>& at, double size) {
  return {at, at + random.point(size), at + random.point(size)};
}

template <int Dim> std::vector<Facet<Dim>> soup(Random<Dim>& random, int n) {
  std::vector<Facet<Dim>> facets;
  for (int i = 0; i < n; ++i)
    facets.push_back(make_facet<Dim>(small_facet(random, random.point(5), random.scale(0.1, 5))));
  return facets;
}

/// Facets of all sizes, and the grid of them.
template <int Dim> struct GridOfSoup {
  static constexpr double margin = 0.2;
  Random<Dim> random;
  std::vector<Facet<Dim>> facets;
  FacetGrid<Dim> grid;

  explicit GridOfSoup(unsigned seed) : random(seed), facets(soup<Dim>(random, 60)), grid(facets, margin, 0.5) {}
};

template <int Dim> void lists_all_near() {
  GridOfSoup<Dim> of(11);
  auto& [random, facets, grid] = of;
  constexpr double margin = GridOfSoup<Dim>::margin;
  int few = 0;
  for (int i = 0; i < 20000; ++i) {
    const Point<Dim> x = random.point(9);
    const double reach = random.scale(0.001, 4);
    const auto list = grid.near(x);
    double nearest = 1e9;
    for (int f = 0; f < 60; ++f) {
      const double distance = nearest_point<Dim>(facets[f], x).distance;
      nearest = std::min(nearest, distance);
      ASSERT_TRUE(distance >= margin || std::count(list.begin(), list.end(), f)) << x.transpose();
    }
    ASSERT_TRUE(std::is_sorted(list.begin(), list.end()));
    ASSERT_TRUE(nearest >= reach + margin || grid.any_within(x, reach)) << x.transpose();
    few += nearest > 2 && reach < 0.1 && grid.any_within(x, reach);  // cells and margin reach less far
  }
  EXPECT_EQ(few, 0);
}

TEST(FacetGrid, ListsAllThatIsNear) {
  lists_all_near<2>();
  lists_all_near<3>();
}

template <int Dim> void hears_of_boxes() {
  GridOfSoup<Dim> of(12);
  auto& [random, facets, grid] = of;
  constexpr double margin = GridOfSoup<Dim>::margin;
  int none = 0;
  for (int i = 0; i < 5000; ++i) {
    const Point<Dim> middle = random.point(9), half = random.point().cwiseAbs() * random.scale(0.01, 3);
    const bool any = grid.any_in_box(middle - half, middle + half);
    none += !any;
    for (int k = 0; k < 5 && !any; ++k) {
      const Point<Dim> x = middle + half.cwiseProduct(random.point());
      for (const auto& f : facets) ASSERT_GE(nearest_point<Dim>(f, x).distance, margin);
    }
  }
  EXPECT_GT(none, 500);
}

TEST(FacetGrid, AnyInABoxIsHeardOf) {
  hears_of_boxes<2>();
  hears_of_boxes<3>();
}

template <int Dim> void one_list_has_all() {
  GridOfSoup<Dim> of(13);
  auto& [random, facets, grid] = of;
  constexpr double margin = GridOfSoup<Dim>::margin;
  int known = 0;
  for (int i = 0; i < 5000; ++i) {
    const Point<Dim> x = random.point(6);
    const double reach = random.scale(0.001, 0.5);
    const auto list = grid.near_all(x, reach);
    if (!list) continue;
    ++known;
    for (int f = 0; f < 60; ++f)
      ASSERT_TRUE(nearest_point<Dim>(facets[f], x).distance >= margin + reach ||
                  std::count(list->begin(), list->end(), f));
  }
  EXPECT_GT(known, 1000);
}

TEST(FacetGrid, OneListHasAllOnAShortWay) {
  one_list_has_all<2>();
  one_list_has_all<3>();
}

/// Never further than it is, the same where the point is over the inside, and seldom nearer elsewhere.
template <int Dim> void sides_tell() {
  Random<Dim> random(14);
  int further = 0, told = 0, over = 0;
  for (int i = 0; i < 50000; ++i) {
    const Facet<Dim> facet = make_facet<Dim>(small_facet(random, random.point(2), random.scale(0.1, 5)));
    const Point<Dim> x = random.point(3);
    const auto nearest = nearest_point<Dim>(facet, x);
    const auto at = FacetSides<Dim>(facet).at(x);
    const double distance = random.scale(0.01, 5);
    ASSERT_FALSE(at.further_than(distance) && nearest.distance < distance - 1e-12);
    if (at.inside > 1e-12) {
      ASSERT_EQ(nearest.feature, Feature::face);
      ASSERT_NEAR(nearest.distance, std::abs(at.height), 1e-12);
      ++over;
    }
    further += nearest.distance > distance;
    told += at.further_than(distance);
  }
  EXPECT_GT(told, 0.95 * further);
  EXPECT_GT(over, 500);
}

TEST(FacetSides, NeverTellOfMoreRoomThanThereIs) {
  sides_tell<2>();
  sides_tell<3>();
}

TEST(FacetSides, FacetWithoutAreaIsNeverFarther) {
  const Point<3> a(1, 2, 3), b(2, 4, 6);
  const FacetSides<3> sides(make_facet<3>({a, b, Point<3>(a + 3 * (b - a))}));
  EXPECT_FALSE(sides.at(Point<3>(50, 0, 0)).further_than(1));
}

/// The box test against points spread over the facet: never apart where a point is inside, and sharp.
TEST(FacetGrid, BoxTestIsExact) {
  Random<3> random(5);
  int inside = 0, outside = 0;
  for (int i = 0; i < 5000; ++i) {
    const auto corner = small_facet(random, random.point(2), 2);
    const Facet<3> f = make_facet<3>(corner);
    double gap = 1e9;  // how much the unit box must grow to touch the facet
    for (int a = 0; a <= 60; ++a)
      for (int b = 0; a + b <= 60; ++b)
        gap = std::min(gap, (corner[0] + a / 60.0 * (corner[1] - corner[0]) + b / 60.0 * (corner[2] - corner[0]))
                                    .lpNorm<Eigen::Infinity>() -
                                1);
    const bool touches = BoxTest<3>(f).overlaps(Point<3>::Zero(), Point<3>::Ones());
    EXPECT_TRUE(gap > 0 || touches);
    EXPECT_FALSE(gap > 0.1 && touches);  // the samples are at most 0.06 apart
    ++(touches ? inside : outside);
  }
  EXPECT_GT(inside, 500);
  EXPECT_GT(outside, 500);
}

/// Cells of a Bresenham line, which [P] walks: one per step along the longest axis, no corner cells.
std::set<std::pair<int, int>> bresenham(const Point<2>& x, const Point<2>& d, double cell) {
  const Point<2> a = (x / cell).array().floor(), b = ((x + d) / cell).array().floor();
  const int n = static_cast<int>((b - a).lpNorm<Eigen::Infinity>());
  std::set<std::pair<int, int>> cells;
  for (int i = 0; i <= n; ++i) {
    const Point<2> c = a + (b - a) * (double(i) / n);
    cells.insert({int(std::lround(c.x())), int(std::lround(c.y()))});
  }
  return cells;
}

TEST(FacetGrid, WalkVisitsTheCornerCellsThatBresenhamSkips) {
  // A short segment inside cell (2, 1) of 10 × 10 unit cells; the path cuts that cell's corner region.
  const Facet<2> f = make_facet<2>({Point<2>(2.15, 1.85), Point<2>(2.25, 1.95)});
  const Facet<2> frame = make_facet<2>({Point<2>(0, 9.9), Point<2>(9.9, 9.9)}),
                 low = make_facet<2>({Point<2>(0, 0), Point<2>(0, 0.1)});
  const Point<2> x(0.3, 0.1), d(8.2, 7.9);
  EXPECT_FALSE(bresenham(x, d, 1).contains({2, 1})) << "or the test proves nothing";
  const double margin = 0.05;
  const FacetGrid<2> grid({f, frame, low}, margin, 1);
  ASSERT_TRUE(sweep_facet<2>(f, x, d, margin) || sweep_facet<2>(f, x + d, -d, margin));
  bool seen = false;
  grid.walk(x, d, [&](std::span<const std::int32_t> list, double) {
    seen = seen || std::count(list.begin(), list.end(), 0);
    return true;
  });
  EXPECT_TRUE(seen);
}

/// Every facet that a sweep along the path hits is listed in a cell that is left no sooner than the hit.
template <int Dim> void walk_meets_all_hits() {
  Random<Dim> random(3);
  const auto facets = soup<Dim>(random, 400);
  const double radius = 0.05;
  const FacetGrid<Dim> grid(facets, radius * (1 + 1e-8), 0.3);
  int hits = 0;
  for (int i = 0; i < 6000; ++i) {
    Point<Dim> x = random.point(6), d = random.point(random.scale(0.01, 30));
    if (i % 3 == 0) {  // through corners of cells exactly
      x = (x / 0.3).array().round() * 0.3 - Point<Dim>::Constant(-5 - radius * (1 + 1e-8)).array();
      d = Point<Dim>::NullaryExpr([&](Eigen::Index) { return random.uniform() > 0 ? 3.0 : -3.0; });
    }
    if (i % 3 == 1) d[i % Dim] = 0;
    std::vector<double> seen_until(facets.size(), -1);
    double t_last = 0;
    grid.walk(x, d, [&](std::span<const std::int32_t> list, double t) {
      EXPECT_GE(t, t_last - 1e-12);
      t_last = t;
      for (const auto f : list) seen_until[f] = t;
      return true;
    });
    for (std::size_t f = 0; f < facets.size(); ++f) {
      const auto hit = sweep_facet<Dim>(facets[f], x, d, radius);
      if (!hit) continue;
      ++hits;
      ASSERT_GE(seen_until[f], hit->t - 1e-9 / d.norm()) << x.transpose() << " by " << d.transpose();
    }
  }
  EXPECT_GT(hits, Dim == 2 ? 1000 : 500);
}

TEST(FacetGrid, WalkMeetsAllHits) {
  walk_meets_all_hits<2>();
  walk_meets_all_hits<3>();
}

TEST(FacetGrid, LargeWallsStaySmall) {
  // A floor of 2 triangles, 100 000 cells wide: the cells are made larger instead of 10¹⁰ list entries.
  const std::vector<Facet<3>> floor = {make_facet<3>({Point<3>(0, 0, 0), Point<3>(100, 0, 0), Point<3>(100, 100, 0)}),
                                       make_facet<3>({Point<3>(0, 0, 0), Point<3>(100, 100, 0), Point<3>(0, 100, 0)})};
  const FacetGrid<3> grid(floor, 0.0005, 0.001);
  EXPECT_LT(grid.bytes(), std::size_t(200) << 20);
  EXPECT_TRUE(grid.any_within(Point<3>(37.3, 12.1, 0.0004), 0));
  EXPECT_FALSE(grid.any_within(Point<3>(37.3, 12.1, 3), 0.01));
  // Two specks far apart in a huge domain.
  const std::vector<Facet<3>> specks = {
      make_facet<3>({Point<3>(0, 0, 0), Point<3>(1, 0, 0), Point<3>(0, 1, 0)}),
      make_facet<3>({Point<3>(1e6, 1e6, 1e6), Point<3>(1e6 + 1, 1e6, 1e6), Point<3>(1e6, 1e6 + 1, 1e6)})};
  EXPECT_LT(FacetGrid<3>(specks, 0.01, 0.02).bytes(), std::size_t(20) << 20);
}

TEST(FacetGrid, EmptyAndNotFinite) {
  const FacetGrid<2> empty;
  EXPECT_FALSE(empty.any_within(Point<2>(0, 0), 1));
  EXPECT_TRUE(empty.near(Point<2>(0, 0)).empty());
  const FacetGrid<2> grid({make_facet<2>({Point<2>(0, 0), Point<2>(1, 0)})}, 0.1, 0.5);
  const Point<2> nan = Point<2>::Constant(NAN);
  EXPECT_TRUE(grid.near(nan).empty());
  int visits = 0;
  grid.walk(nan, nan, [&](std::span<const std::int32_t>, double) { return ++visits < 1000; });
  EXPECT_LT(visits, 1000);
}

}  // namespace
}  // namespace molten::facet_grid_test
