#include "core/neighbours.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "tests/clouds.h"

namespace molten::neighbours_test {
namespace {

using namespace clouds;

/// The largest error of a particle's local position, in spacings.
template <int Dim, class Real> double worst_local_error(const Cloud<Dim, Real>& c) {
  double worst = 0;
  for_each_particle(c.particles, [&](std::size_t s, const auto& x) {
    for (int d = 0; d < Dim; ++d) {
      const double origin = c.neighbours.grid().origin(d, c.neighbours.cell(s / cluster_size)[d]);
      worst = std::max(worst, std::abs(c.particles[local_position][d][s] - (x[d] - origin)));
    }
  });
  return worst / c.settings.spacing;
}

/// Holds the list against brute force within `reach` (m). Local positions have to be good to `accuracy` spacings; a
/// pair has the errors of two of them and, across a period that is no multiple of the quantum, half a quantum more.
template <int Dim, class Real> void expect_complete(const Cloud<Dim, Real>& c, double reach, double accuracy = 1e-6) {
  const auto listed = listed_pairs(c, reach);
  const auto same = [](const auto& a, const auto& b) { return a.key() == b.key(); };
  EXPECT_TRUE(std::adjacent_find(listed.begin(), listed.end(), same) == listed.end()) << "listed twice";
  const auto true_pairs = brute_pairs(c, 1.001 * reach);
  const auto find = [&](const auto& pairs, const ImagePair<Dim>& p) {
    const auto it = std::lower_bound(pairs.begin(), pairs.end(), p);
    return it != pairs.end() && same(*it, p) ? &*it : nullptr;
  };
  int missing = 0, false_pairs = 0;
  double worst = 0;
  for (const ImagePair<Dim>& pair : true_pairs) {
    const ImagePair<Dim>* const found = find(listed, pair);
    missing += !found && pair.distance() < reach;
    for (int d = 0; d < Dim && found; ++d) worst = std::max(worst, std::abs(found->x[d] - pair.x[d]));
  }
  for (const ImagePair<Dim>& pair : listed) false_pairs += pair.distance() < reach && !find(true_pairs, pair);
  EXPECT_EQ(false_pairs, 0) << "a shift leads to the wrong place";
  EXPECT_EQ(missing, 0);
  EXPECT_LT(worst / c.settings.spacing, 2 * accuracy);
  EXPECT_LT(worst_local_error(c), accuracy);
}

/// x_i − x_j and x_j − x_i are the same bits but for the sign, so what two particles do to each other cancels.
template <int Dim, class Real> void expect_antisymmetric(const Cloud<Dim, Real>& c) {
  const double reach = c.settings.support_radius;
  const auto listed = listed_pairs(c, reach);
  int wrong = 0;
  for (const ImagePair<Dim>& p : listed) {
    ImagePair<Dim> back{p.j, p.i, {}, {}};
    double r2 = 0;
    for (int d = 0; d < Dim; ++d) {
      back.image[d] = -p.image[d];
      back.x[d] = -p.x[d];
      r2 += p.x[d] * p.x[d];
    }
    if (r2 >= reach * reach) continue;
    const auto it = std::lower_bound(listed.begin(), listed.end(), back);
    wrong += it == listed.end() || it->key() != back.key() || it->x != back.x;
  }
  EXPECT_EQ(wrong, 0);
}

/// Slots: all particles there once; columns in order; cells sorted along the column by less than a rounding.
template <int Dim, class Real> void expect_ordered(const Cloud<Dim, Real>& c) {
  const auto& grid = c.neighbours.grid();
  const auto x = c.particles[position];
  std::vector<std::int64_t> ids;
  std::size_t column_before = 0;
  double along_before = -1e300;
  for (std::size_t s = 0; s < c.particles.slots(); ++s) {
    if (c.particles.is_padding(s)) continue;
    ids.push_back(c.particles[id][0][s]);
    Cell<Dim> cell{};
    for (int d = 0; d < Dim - 1; ++d) cell[d] = grid.index(d, x[d][s]);
    const std::size_t column = grid.column(cell);
    EXPECT_EQ(column, grid.column(c.neighbours.cell(s / cluster_size)));
    if (column != column_before) along_before = -1e300;
    EXPECT_GE(column, column_before);
    EXPECT_GE(x[Dim - 1][s], along_before - 0.01 * c.settings.spacing);
    column_before = column;
    along_before = x[Dim - 1][s];
  }
  EXPECT_EQ(ids.size(), c.particles.count());
  std::sort(ids.begin(), ids.end());
  EXPECT_EQ(std::adjacent_find(ids.begin(), ids.end()), ids.end());
}

/// Whatever the particles may have moved, all pairs are listed that can have come within the support.
template <int Dim, class Real> void expect_complete_shells(Cloud<Dim, Real>& c, double accuracy = 1e-6) {
  double moved = 0;
  for (int s = 1; s <= shells; ++s) {
    const double way = 0.5 * (1 - 1e-6) * c.settings.skin * s / shells;
    c.neighbours.moved(way - moved);
    moved = way;
    EXPECT_FALSE(c.neighbours.is_due());
    SCOPED_TRACE(s);
    expect_complete(c, c.settings.support_radius + c.settings.skin * s / shells, accuracy);
  }
}

template <int Dim, class Real> void expect_good(Cloud<Dim, Real>& c) {
  expect_complete_shells(c);
  expect_antisymmetric(c);
  expect_ordered(c);
}

template <class F> class NeighboursOf : public testing::Test {};
TYPED_TEST_SUITE(NeighboursOf, Flavours, FlavourNames);

/// Every column has one number and one place, and a row of a strip follows on the one before it.
TEST(Grid, NumbersItsColumnsStripByStrip) {
  for (const std::int32_t across : {1, 5, 6, 7, 12, 20}) {
    Grid<3> grid;
    grid.cells = {across, 9, 4};
    Cell<3> before{};
    for (std::size_t n = 0; n < grid.columns(); ++n) {
      Cell<3> cell{-1, -1, 3};
      grid.place(n, cell);
      ASSERT_EQ(grid.column(cell), n);
      ASSERT_TRUE(cell[0] >= 0 && cell[0] < across && cell[1] >= 0 && cell[1] < 9 && cell[2] == 3) << n;
      const auto strip = [](const Cell<3>& c) { return c[0] / static_cast<int>(Grid<3>::strip_width); };
      ASSERT_GE(strip(cell), strip(before)) << n;
      if (strip(cell) == strip(before)) {
        ASSERT_LE(cell[1] - before[1], 1) << n;
      }
      before = cell;
    }
  }
}

TYPED_TEST(NeighboursOf, Lattice) {
  MOLTEN_FLAVOUR;
  Cloud<Dim, Real> c(cube<Dim>(Dim == 2 ? 25 : 10, 0.1), 0.1, domain_between<Dim>(-10, 10));
  expect_good(c);
  EXPECT_EQ(naive_pairs(c.particles, c.domain.periodic, c.settings.support_radius).size(),
            brute_pairs(c, c.settings.support_radius).size());
}

TYPED_TEST(NeighboursOf, RandomAndCoincident) {
  MOLTEN_FLAVOUR;
  const int cells = Dim == 2 ? 25 : 9;
  Points points = random_points<Dim>(static_cast<int>(std::pow(cells, Dim)), 0, 0.1 * cells);
  points[1] = points[0];
  points[3][0] = points[2][0];
  Cloud<Dim, Real> c(points, 0.1, domain_between<Dim>(-10, 10));
  expect_good(c);
}

TYPED_TEST(NeighboursOf, EachAxisPeriodic) {
  MOLTEN_FLAVOUR;
  const int cells = Dim == 2 ? 16 : 8;
  for (int axes = 1; axes < 1 << Dim; ++axes) {
    SCOPED_TRACE(axes);
    const auto domain = domain_between<Dim>(0, cells * 0.1, {bool(axes & 1), bool(axes & 2), bool(axes & 4)});
    Cloud<Dim, Real> c(cube<Dim>(cells, 0.1, 0.4), 0.1, domain);
    expect_good(c);
  }
}

TYPED_TEST(NeighboursOf, ShortPeriods) {
  // From barely more than two supports, where a pair has one image, down to less than one: several images of each pair
  // and of the particle itself.
  MOLTEN_FLAVOUR;
  for (const double period : {5.81, 5.3, 4.0, 2.5, 1.7}) {
    SCOPED_TRACE(period);
    const int count = static_cast<int>(std::pow(period, Dim));
    const auto domain = domain_between<Dim>(-0.3, 0.1 * period - 0.3, {true, true, true});
    Cloud<Dim, Real> c(random_points<Dim>(count, -0.3, 0.1 * period - 0.3), 0.1, domain);
    expect_good(c);
  }
}

TYPED_TEST(NeighboursOf, SparseWithFarOutliers) {
  MOLTEN_FLAVOUR;
  Points points = cube<Dim>(Dim == 2 ? 20 : 8, 0.1, 0.3);
  const Points sparse = random_points<Dim>(300, -3, 5), far = random_points<Dim>(40, -80, 80);
  points.insert(points.end(), sparse.begin(), sparse.end());
  points.insert(points.end(), far.begin(), far.end());
  Cloud<Dim, Real> c(points, 0.1, domain_between<Dim>(-100, 100));
  expect_good(c);
  EXPECT_LT(c.neighbours.grid().columns(), 65536 + 8 * points.size() + 1) << "the table stays small";
}

TYPED_TEST(NeighboursOf, OneAndNone) {
  MOLTEN_FLAVOUR;
  const Cloud<Dim, Real> one(Points{{0.2, 0.3, 0.4}}, 0.1, domain_between<Dim>(-1, 1));
  EXPECT_EQ(one.particles.count(), 1u);
  EXPECT_EQ(one.particles.slots(), std::size_t{cluster_size});
  expect_complete(one, one.settings.support_radius);
  const Cloud<Dim, Real> none(Points{}, 0.1, domain_between<Dim>(-1, 1));
  EXPECT_EQ(none.particles.count(), 0u);
  EXPECT_TRUE(none.neighbours.chunks().empty());
}

TYPED_TEST(NeighboursOf, FarFromTheOrigin) {
  // A 10 km domain, and 1000 km from the origin, with spacings of millimetres: double positions resolve 1e-10 m there.
  MOLTEN_FLAVOUR;
  for (const double origin : {-5e3, 1e4, 1e6}) {
    SCOPED_TRACE(origin);
    Points points = cube<Dim>(Dim == 2 ? 16 : 8, 0.001, 0.3);
    for (auto& p : points)
      for (int d = 0; d < Dim; ++d) p[d] += origin;
    Cloud<Dim, Real> c(points, 0.001, domain_between<Dim>(origin - 1, origin + 1));
    expect_good(c);
  }
}

/// Two heaps of particles, the second further by `distance` (m) on the axes from `first_axis` on; in shuffled order.
template <int Dim> Points two_heaps(double spacing, double distance, int first_axis) {
  Points points = cube<Dim>(Dim == 2 ? 16 : 7, spacing, 0.3);
  for (std::size_t k = 0, half = points.size(); k < half; ++k) {
    points.push_back(points[k]);
    for (int d = first_axis; d < Dim; ++d) points.back()[d] += distance;
  }
  std::shuffle(points.begin(), points.end(), std::mt19937(3));
  return points;
}

TYPED_TEST(NeighboursOf, TenKilometresAlongTheColumns) {
  // The sort key, a float, resolves no more than a spacing here.
  MOLTEN_FLAVOUR;
  for (const double spacing : {0.01, 0.001}) {
    SCOPED_TRACE(spacing);
    Cloud<Dim, Real> c(two_heaps<Dim>(spacing, 1e4, Dim - 1), spacing, domain_between<Dim>(-1, 2e4));
    expect_complete_shells(c);
  }
}

TYPED_TEST(NeighboursOf, TenKilometresAcrossTheColumns) {
  // So wide a spread of so few particles widens the columns, and positions in wide columns lose digits in single
  // precision: here up to 1e-3 spacings. The list stays complete.
  MOLTEN_FLAVOUR;
  Cloud<Dim, Real> c(two_heaps<Dim>(0.01, 1e4, 0), 0.01, domain_between<Dim>(-1, 2e4));
  expect_complete_shells(c, std::is_same_v<Real, float> ? 1e-3 : 1e-6);
}

TYPED_TEST(NeighboursOf, CompleteUntilHalfASkin) {
  MOLTEN_FLAVOUR;
  const int cells = Dim == 2 ? 20 : 8;
  const auto domain = domain_between<Dim>(0, cells * 0.1, {true, false, true});
  Cloud<Dim, Real> c(cube<Dim>(cells, 0.1, 0.3), 0.1, domain);
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const auto x = c.particles[position];
  for (std::size_t s = 0; s < c.particles.slots(); ++s) {
    if (c.particles.is_padding(s)) continue;
    std::array<double, 3> move{normal(random), normal(random), Dim == 3 ? normal(random) : 0};
    const double scale = 0.4999 * c.settings.skin / std::hypot(move[0], move[1], move[2]);
    for (int d = 0; d < Dim; ++d) x[d][s] += scale * move[d];
  }
  for (std::size_t k = 0; k < c.neighbours.clusters(); ++k) c.neighbours.localise(c.particles, k);
  EXPECT_FALSE(c.neighbours.is_due());
  c.neighbours.moved(0.4999 * c.settings.skin);
  EXPECT_FALSE(c.neighbours.is_due());
  expect_complete(c, c.settings.support_radius);
  expect_antisymmetric(c);
  c.neighbours.relist(c.particles);
  expect_complete(c, c.settings.support_radius);
  c.neighbours.moved(0.001 * c.settings.skin);
  EXPECT_TRUE(c.neighbours.is_due());
}

TYPED_TEST(NeighboursOf, RelistIsTheSameList) {
  MOLTEN_FLAVOUR;
  Cloud<Dim, Real> c(cube<Dim>(Dim == 2 ? 40 : 12, 0.1, 0.4), 0.1, domain_between<Dim>(-10, 10, {true, false, false}));
  const std::vector<ClusterChunk> before(c.neighbours.chunks().begin(), c.neighbours.chunks().end());
  c.neighbours.relist(c.particles);
  ASSERT_EQ(before.size(), c.neighbours.chunks().size());
  for (std::size_t k = 0; k < before.size(); ++k) EXPECT_EQ(before[k], c.neighbours.chunks()[k]);
}

TYPED_TEST(NeighboursOf, ListsNoGroupOutOfReach) {
  MOLTEN_FLAVOUR;
  const int cells = Dim == 2 ? 40 : 12;
  const Cloud<Dim, Real> c(cube<Dim>(cells, 0.1, 0.4), 0.1, domain_between<Dim>(0, 0.1 * cells, {true, true, false}));
  const std::size_t group = group_size<Real>, slots = c.particles.slots();
  std::map<std::array<std::size_t, 2>, double> nearest;  // m; by cluster and group
  for_each_listed(c, [&](std::uint32_t i, std::uint32_t j, const auto& x) {
    double r2 = 0;
    for (int d = 0; d < Dim; ++d) r2 += double(x[d]) * x[d];
    double& least = nearest.try_emplace({i / cluster_size, j / group}, INFINITY).first->second;
    least = std::min(least, std::sqrt(r2));
  });
  EXPECT_GT(nearest.size(), slots / cluster_size);
  const double reach = c.settings.support_radius + c.settings.skin / shells;
  const auto is_full = [&](std::size_t cluster) { return !c.particles.is_padding((cluster + 1) * cluster_size - 1); };
  // Padding is far from all particles but not from padding.
  for (const auto& [pair, distance] : nearest)
    if (is_full(pair[0])) {
      EXPECT_LT(distance, 1.0001 * reach) << pair[0] << ", " << pair[1];
    }
}

TYPED_TEST(NeighboursOf, TheOrderDependsOnPositionsAlone) {
  MOLTEN_FLAVOUR;
  const auto domain = domain_between<Dim>(-10, 10);
  const Points points = cube<Dim>(Dim == 2 ? 60 : 16, 0.1, 0.4);
  const auto ids_of = [](const Cloud<Dim, Real>& c) {
    const std::int64_t* const ids = c.particles[id][0];
    return std::vector<std::int64_t>(ids, ids + c.particles.slots());
  };
  Cloud<Dim, Real> c(points, 0.1, domain);
  const auto fresh = ids_of(c);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> way(-0.04, 0.04);
  const auto move = [&](const auto& place) {
    const auto x = c.particles[position];
    for (std::size_t s = 0; s < c.particles.slots(); ++s)
      for (int d = 0; d < Dim && !c.particles.is_padding(s); ++d)
        x[d][s] = place(points[static_cast<std::size_t>(c.particles[id][0][s])][d]);
    c.neighbours.rebuild(c.particles);
  };
  move([&](double at) { return at + way(random); });
  EXPECT_NE(ids_of(c), fresh);
  move([](double at) { return at; });
  EXPECT_EQ(ids_of(c), fresh) << "from an order that is nearly right";
  move([](double at) { return -at; });
  move([](double at) { return at; });
  EXPECT_EQ(ids_of(c), fresh) << "from the opposite order";
}

TYPED_TEST(NeighboursOf, DropsWhatLeavesTheDomain) {
  MOLTEN_FLAVOUR;
  Points points = cube<Dim>(8, 0.1);
  const std::size_t kept = points.size();
  points.push_back({5, 0.4, 0.4});
  points.push_back({0.4, -1.001, 0.4});
  points.push_back({NAN, 0.4, 0.4});
  Cloud<Dim, Real> c(points, 0.1, domain_between<Dim>(-1, 1));
  EXPECT_EQ(c.particles.count(), kept);
  EXPECT_EQ(c.neighbours.dropped(), 3u);
  expect_good(c);
}

TYPED_TEST(NeighboursOf, PaddingIsFarFromEverything) {
  MOLTEN_FLAVOUR;
  Cloud<Dim, Real> c(random_points<Dim>(401, 0, 2), 0.1, domain_between<Dim>(-10, 10));
  int padding = 0;
  for (std::size_t s = 0; s < c.particles.slots(); ++s) {
    if (!c.particles.is_padding(s)) continue;
    ++padding;
    for (int d = 0; d < Dim; ++d) EXPECT_GT(c.particles[local_position][d][s], 1000 * c.settings.spacing);
  }
  EXPECT_EQ(padding, static_cast<int>(c.particles.slots() - c.particles.count()));
  EXPECT_GT(padding, 0);
}

TYPED_TEST(NeighboursOf, WrapsPeriodicPositions) {
  MOLTEN_FLAVOUR;
  Points points = cube<Dim>(8, 0.1);
  for (std::size_t k = 0; k < points.size(); ++k) points[k][0] += 0.8 * (static_cast<int>(k % 5) - 2);
  Cloud<Dim, Real> c(points, 0.1, domain_between<Dim>(0, 0.8, {true, true, true}));
  for_each_particle(c.particles, [](std::size_t, const auto& x) {
    EXPECT_GE(x[0], 0);
    EXPECT_LT(x[0], 0.8);
  });
  expect_good(c);
}

}  // namespace
}  // namespace molten::neighbours_test
