// Walls of boundary particles: where they are put, that dynamic ones stay there and hold the fluid, and the force of
// repulsive ones.
#include "core/boundary/boundary_particles.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numbers>

#include "core/boundary/repulsion.h"
#include "core/diagnostics.h"
#include "core/step.h"
#include "io/geometry/assemble.h"
#include "tests/contact_shapes.h"
#include "tests/flavours.h"
#include "tests/memory_archive.h"
#include "tests/scene_texts.h"
#include "tests/with_threads.h"

namespace molten::boundary_particles_test {
namespace {

using namespace scene_texts;
using contact_test::ball;
using contact_test::chain;

template <class F> class BoundaryParticlesOf : public testing::Test {};
TYPED_TEST_SUITE(BoundaryParticlesOf, Flavours, FlavourNames);

// ---- where they are -------------------------------------------------------------------------------------------------

/// A tank without a lid, of whole pitches of 1 m.
Wall<2> open_tank(double width, double height) {
  return chain({{0, height}, {0, 0}, {width, 0}, {width, height}}, false);
}

/// The unit cube of so many pitches a side; the fluid is inside.
Wall<3> cube_wall(double pitches) {
  Shape shape;
  shape.box = Box{{0, 0, 0}, {pitches, pitches, pitches}};
  return contact_test::shell(shape, 1e9, true);
}

template <int Dim> double least_distance(const std::vector<HeldPoint<Dim>>& points) {
  double least = 1e300;
  for (std::size_t a = 0; a < points.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) least = std::min(least, (points[a].at - points[b].at).norm());
  return least;
}

/// Dias 2017: tanks of 4 × 4 m at 0.03 m, of 0.42 × 0.44 m and of 1.61 × 0.6 m at 0.0032 m.
TEST(BoundaryParticles, AreAsManyAsInTheTanksOfDias) {
  EXPECT_EQ(held_points<2>({open_tank(133, 133)}, 1).size(), 801u);
  EXPECT_EQ(held_points<2>({open_tank(131, 137)}, 1).size(), 813u);
  EXPECT_EQ(held_points<2>({open_tank(503, 188)}, 1).size(), 1761u);
}

TEST(BoundaryParticles, AreTwoStaggeredRowsAroundACorner) {
  const auto points = held_points<2>({open_tank(3, 2)}, 1);
  EXPECT_NEAR(least_distance(points), std::numbers::sqrt2 / 2, 1e-12);
  const auto has = [&](double x, double y) {
    return std::any_of(points.begin(), points.end(),
                       [&](const auto& p) { return (p.at - Point<2>(x, y)).norm() < 1e-12; });
  };
  for (int k = 0; k <= 3; ++k) EXPECT_TRUE(has(k, 0)) << k;
  for (double x = -0.5; x < 4; ++x) EXPECT_TRUE(has(x, -0.5)) << x;
  for (double y : {0.5, 1.5}) EXPECT_TRUE(has(-0.5, y) && has(3.5, y)) << y;
  EXPECT_EQ(points.size(), 4u + 2 * 2 + 5 + 4);
}

TEST(BoundaryParticles, OfWallsThatMeetKeepTheirDistance) {
  const Wall<2> step = chain({{1, -2}, {1, 1.3}, {2, 1.3}, {2, -2}}, false);
  EXPECT_GE(least_distance(held_points<2>({open_tank(3, 2), step}, 1)), 0.45);
}

TEST(BoundaryParticles, StandBehindTheFacesOfACube) {
  constexpr int n = 5;
  const auto points = held_points<3>({cube_wall(n)}, 1);
  EXPECT_EQ(points.size(), 6u * n * n + 2 + 6 * n * n + 12 * n + 8);
  EXPECT_NEAR(least_distance(points), std::sqrt(3) / 2, 1e-12);
  const auto inside = [](const Point<3>& x) { return (x.array() > 1e-9).all() && (x.array() < n - 1e-9).all(); };
  for (const auto& p : points) EXPECT_FALSE(inside(p.at));
}

TEST(BoundaryParticles, LeaveNoHolesInRoundWalls) {
  const Wall<3> wall = ball(6, 2);
  const auto points = held_points<3>({wall}, 1);
  EXPECT_GE(least_distance(points), 0.45);
  double widest = 0;  // from a place on the wall to the next point
  for (const auto& t : wall.facets)
    for (const auto& [u, v] : {std::pair{0.33, 0.33}, {0.5, 0.5}, {0.5, 0.0}, {0.0, 0.5}, {0.1, 0.1}}) {
      const Vec3 x = (1 - u - v) * wall.vertices[t[0]] + u * wall.vertices[t[1]] + v * wall.vertices[t[2]];
      double next = 1e300;
      for (const auto& p : points) next = std::min(next, (p.at - x).norm());
      widest = std::max(widest, next);
    }
  EXPECT_LT(widest, 0.8);
}

// ---- a tank at rest and a dam that breaks ---------------------------------------------------------------------------

/// A closed tank of 1 × 1 (× 0.5) m, water from x = 0 to `width` m and half as high as the tank.
std::string tank_text(int dim, double width, const std::string& numerics) {
  const auto box = [&](double x, double up, double across) {
    return dim == 2 ? fmt::format("{{ min = [0, 0], max = [{}, {}] }}", x, up)
                    : fmt::format("{{ min = [0, 0, 0], max = [{}, {}, {}] }}", x, across, up);
  };
  return fmt::format(
      "[scene]\ndimensions = {}\n[fluid]\nbox = {}\nspacing = {}\nhydrostatic = true\n[[boundary]]\nbox = {}\n"
      "inside = true\nslip = 1\n[run]\nend_time = 1\n[numerics]\n{}",
      dim, box(width, 0.5, 0.5), dim == 2 ? 0.05 : 0.1, box(1, 1, 0.5), numerics);
}

template <int Dim, class Real> State<Dim, Real> state_of(const std::string& text) {
  const Scene scene = parse_scene(text, "s.toml");
  const Features features = features_of(scene);
  const Start start = fill_bodies(scene, features);
  const Parameters<Dim> p = parameters_of<Dim>(scene, start);
  return make_state<Dim, Real>(features, p, build_surroundings(scene, start, p), start);
}

template <int Dim, class Real> void run(State<Dim, Real>& s, int steps) {
  for (int k = 0; k < steps; ++k) step(s);
}

const std::string dynamic = "boundary_particles = { kind = \"dynamic\" }\n";
const std::string repulsive = "boundary_particles = { kind = \"repulsive\" }\n";
const std::string dias = "preset = \"dias\"\n";

TYPED_TEST(BoundaryParticlesOf, DynamicOnesHoldATankAtRest) {
  MOLTEN_FLAVOUR;
  for (const std::string& numerics : {dias, dynamic}) {
    auto s = state_of<Dim, Real>(tank_text(Dim, 1, numerics));
    const Diagnostics at_start = diagnose(s);
    EXPECT_EQ(at_start.particles + static_cast<std::int64_t>(s.boundary_count),
              static_cast<std::int64_t>(s.particles.count()));
    std::map<std::int64_t, Point<Dim>> places;
    const auto for_each_held = [&](auto&& f) {
      for (std::size_t k = 0; k < s.particles.slots(); ++k) {
        if (s.particles.is_padding(k) || s.particles[held][0][k] == 0) continue;
        Point<Dim> at;
        for (int d = 0; d < Dim; ++d) at[d] = s.particles[position][d][k];
        f(k, s.particles[id][0][k], at);
      }
    };
    for_each_held([&](std::size_t, std::int64_t number, const Point<Dim>& at) { places[number] = at; });
    ASSERT_EQ(places.size(), s.boundary_count);
    s.clock.stop = 0.3;
    while (s.clock.time < s.clock.stop) step(s);
    std::size_t found = 0;
    for_each_held([&](std::size_t k, std::int64_t number, const Point<Dim>& at) {
      ++found;
      EXPECT_EQ(places.at(number), at);
      EXPECT_GE(s.particles[compression][0][k], 0);
      for (int d = 0; d < Dim; ++d) EXPECT_EQ(s.particles[velocity][d][k], 0);
    });
    EXPECT_EQ(found, s.boundary_count);
    const Diagnostics d = diagnose(s);
    EXPECT_EQ(d.particles, at_start.particles);
    EXPECT_LT(d.kinetic_energy, 1e-3 * at_start.potential_energy);
    for (int k = 0; k < Dim; ++k) EXPECT_GT(d.lower[k], 0) << k;
    EXPECT_NEAR(d.upper[Dim - 1], 0.5, 0.1);
  }
}

TYPED_TEST(BoundaryParticlesOf, NothingLeaksFromABreakingDam) {
  MOLTEN_FLAVOUR;
  for (const std::string& numerics : {dias, dynamic, dias + repulsive, repulsive}) {
    auto s = state_of<Dim, Real>(tank_text(Dim, 0.4, numerics));
    const std::int64_t particles = diagnose(s).particles;
    s.clock.stop = 0.4;
    while (s.clock.time < s.clock.stop) step(s);
    const Diagnostics d = diagnose(s);
    EXPECT_EQ(d.particles, particles) << numerics;
    const double across = Dim == 2 ? 1 : 0.5;
    for (int k = 0; k < Dim; ++k) {
      EXPECT_GT(d.lower[k], 0) << numerics;
      EXPECT_LT(d.upper[k], k == 1 ? across : 1) << numerics;
    }
    EXPECT_GT(d.upper[0], 0.8) << "the water has run through the tank: " << numerics;
  }
}

TYPED_TEST(BoundaryParticlesOf, SameBitsForAnyThreadsAndAfterARestart) {
  MOLTEN_FLAVOUR;
  for (const std::string& numerics : {dias, dynamic, dias + repulsive}) {
    const std::string text = tank_text(Dim, 0.4, numerics);
    const auto after = [&](int threads) {
      const WithThreads with(threads);
      auto s = state_of<Dim, Real>(text);
      run(s, 60);
      return archived(s);
    };
    const MemoryArchive whole = after(1);
    EXPECT_TRUE(whole == after(2)) << numerics;
    auto first = state_of<Dim, Real>(text), second = state_of<Dim, Real>(text);
    run(first, 30);
    MemoryArchive half = saved(first);
    second.archive(half);
    prepare(second);
    run(second, 30);
    EXPECT_TRUE(whole == archived(second)) << numerics;
  }
}

TYPED_TEST(BoundaryParticlesOf, DensityWaitsForItsTurn) {
  MOLTEN_FLAVOUR;
  auto s = state_of<Dim, Real>(tank_text(Dim, 0.4, "boundary_particles = { kind = \"dynamic\", every = 5 }\n"));
  for (int k = 0; k < 12; ++k) {
    step(s);
    bool changing = false;
    for (std::size_t slot = 0; slot < s.particles.slots(); ++slot)
      changing = changing || (s.particles[held][0][slot] > 0 && s.particles[compression_rate][0][slot] != 0);
    EXPECT_EQ(changing, s.clock.step % 5 == 0) << s.clock.step;
  }
}

TYPED_TEST(BoundaryParticlesOf, DynamicOnesGoWithTheirWall) {
  MOLTEN_FLAVOUR;
  const std::string gate = Dim == 2 ? "box = { min = [0.7, 0.2], max = [0.8, 0.6] }\nmotion = { velocity = [0, 0.5] }\n"
                                    : "box = { min = [0.7, 0, 0.2], max = [0.8, 0.5, 0.6] }\n"
                                      "motion = { velocity = [0, 0, 0.5] }\n";
  auto s = state_of<Dim, Real>(tank_text(Dim, 0.4, dynamic) + "[[boundary]]\n" + gate);
  std::map<std::int64_t, double> heights;
  const auto for_each_moving = [&](auto&& f) {
    for (std::size_t k = 0; k < s.particles.slots(); ++k)
      if (s.particles[held][0][k] > 1) f(s.particles[id][0][k], s.particles[position][Dim - 1][k]);
  };
  for_each_moving([&](std::int64_t number, double height) { heights[number] = height; });
  EXPECT_GT(heights.size(), 10u);
  run(s, 50);
  EXPECT_GT(s.clock.time, 0);
  for_each_moving(
      [&](std::int64_t number, double height) { EXPECT_NEAR(height, heights.at(number) + 0.5 * s.clock.time, 1e-12); });
}

/// The filter leaves boundary particles and does not take them for fluid.
TYPED_TEST(BoundaryParticlesOf, DensityFilterIsOfTheFluidAlone) {
  MOLTEN_FLAVOUR;
  auto s = state_of<Dim, Real>(tank_text(Dim, 1, dynamic + "density_filter = { kind = \"shepard\", every = 5 }\n"));
  for (std::size_t k = 0; k < s.particles.slots(); ++k)
    if (!s.particles.is_padding(k))
      s.particles[compression][0][k] = s.particles[held][0][k] > 0 ? Real(0.1) : Real(0.01);
  filter_density(s);
  for (std::size_t k = 0; k < s.particles.slots(); ++k) {
    if (s.particles.is_padding(k)) continue;
    EXPECT_NEAR(s.particles[compression][0][k], s.particles[held][0][k] > 0 ? 0.1 : 0.01, 1e-7);
  }
}

// ---- the force of repulsive ones ------------------------------------------------------------------------------------

template <int Dim> Parameters<Dim> still_parameters() {
  Parameters<Dim> p;
  p.smoothing_length = 0.13;
  p.gravity[Dim - 1] = -10;
  p.eos = {StateEquation::tait, 1000, 40, 7};
  return p;
}

/// A floor of 11 (× 11) points, and one of its points alone.
template <int Dim> std::vector<RepulsivePoint<Dim>> floor_points() {
  if constexpr (Dim == 2) {
    Wall<2> wall;
    wall.vertices = {{0, 0}, {1, 0}};
    wall.facets = {{0, 1}};
    return repulsive_points<2>({wall}, 0.1);
  } else {
    Wall<3> wall;
    wall.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    wall.facets = {{0, 1, 2}, {0, 2, 3}};
    return repulsive_points<3>({wall}, 0.1);
  }
}

template <int Dim> void test_floor() {
  const auto points = floor_points<Dim>();
  EXPECT_EQ(points.size(), Dim == 2 ? 11u : 121u);
  const Parameters<Dim> p = still_parameters<Dim>();
  const double depth = 2, c0 = 40;
  const Repulsion<Dim> repulsion(points, p, {10 * depth, 0});
  const auto at = [](double x, double height) {
    Point<Dim> place = Point<Dim>::Constant(0.43);
    place[0] = x, place[Dim - 1] = height;
    return place;
  };
  // Monaghan and Kos 1999 with β = c0/(10 √(gH)), at the bottom, for a particle that falls, and one that rises.
  const double beta = c0 / (10 * std::sqrt(10 * depth)), delta = 0.01, c = c0 * std::pow(1 + delta, 3);
  for (const double u : {0.0, -0.3, 0.4})
    for (const double psi : {0.01, 0.1, 0.2}) {
      const double q = psi / (2 * 0.13);
      const double A = (0.01 * c * c / (beta * beta) - (u > 0 ? c * u / beta : 0)) / 0.13;
      const double expected = A * (1 - q) / std::sqrt(q) * (1 + (u < 0 ? std::min(1.0, 40 * -u / c0) : 0));
      Point<Dim> v = Point<Dim>::Constant(7);  // along the floor it does not matter
      v[Dim - 1] = u;
      for (const double x : {0.3, 0.337, 0.35, 0.61}) {
        const Point<Dim> a = repulsion.acceleration(at(x, psi), v, delta);
        EXPECT_NEAR(a[Dim - 1], expected, 1e-9 * expected) << "the same all along the row";
        EXPECT_EQ(a[0], 0);
      }
    }
  EXPECT_EQ(repulsion.acceleration(at(0.5, 0.27), Point<Dim>::Zero(), 0), Point<Dim>::Zero()) << "beyond 2h";
  EXPECT_EQ(repulsion.acceleration(at(0.5, -0.01), Point<Dim>::Zero(), 0), Point<Dim>::Zero()) << "behind";
  EXPECT_EQ(repulsion.acceleration(at(1.11, 0.05), Point<Dim>::Zero(), 0), Point<Dim>::Zero()) << "beyond the end";
  EXPECT_EQ(repulsion.acceleration(at(1e30, 1e30), Point<Dim>::Zero(), 0), Point<Dim>::Zero()) << "far away";
}

TEST(RepulsiveParticles, PushAsMonaghanAndKosSay) {
  test_floor<2>();
  test_floor<3>();
}

TEST(RepulsiveParticles, PushLessTowardsTheSurface) {
  RepulsivePoint<2> b{{0, 1.5}, {1, 0}, {Point<2>(0, 1)}, {0.1}};
  const Repulsion<2> repulsion({b}, still_parameters<2>(), {20, 0});
  const Repulsion<2> at_bottom({{{0, 0}, {1, 0}, {Point<2>(0, 1)}, {0.1}}}, still_parameters<2>(), {20, 0});
  const double full = at_bottom.acceleration({0.1, 0}, {0, 0}, 0)[0];
  EXPECT_NEAR(repulsion.acceleration({0.1, 1.5}, {0, 0}, 0)[0] / full, 0.02 + 0.25, 1e-12);
  b.at[1] = 2.05;
  const Repulsion<2> above({b}, still_parameters<2>(), {20, 0});
  EXPECT_NEAR(above.acceleration({0.1, 2.05}, {0, 0}, 0)[0] / full, 0.02, 1e-12);
}

TEST(RepulsiveParticles, HaveANormalEachSideOfACornerAndOneWhereItIsBlunt) {
  EXPECT_EQ(repulsive_points<2>({open_tank(3, 2)}, 1).size(), 3u + 4 + 3);
  const Wall<2> bend = chain({{0, 0}, {3, 0}, {6, 1}}, false);
  EXPECT_EQ(repulsive_points<2>({bend}, 1).size(), 7u);
}

TEST(RepulsiveParticles, RefuseNarrowWallsAndStillWaterWithoutDepth) {
  EXPECT_THROW(repulsive_points<3>({ball(1, 0.3)}, 1), Error);
  EXPECT_THROW(Repulsion<2>({}, still_parameters<2>(), {0, 1}), Error);
}

// ---- what a scene may ask for ---------------------------------------------------------------------------------------

std::string refusal(const std::string& text) {
  try {
    const Scene scene = parse_scene(text, "s.toml");
    const Features features = features_of(scene);
    const Start start = fill_bodies(scene, features);
    build_surroundings(scene, start, parameters_of<2>(scene, start));
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

TEST(BoundaryParticles, RefuseWhatTheyDoNotKnow) {
  const std::string good = tank_text(2, 0.4, dynamic);
  EXPECT_EQ(refusal(good), "");
  const auto with = [&](const std::string& more) { return refusal(good + more); };
  expect_complaint(with("[numerics.sleep]\n"), "numerics.sleep: does not go together with dynamic boundary particles");
  expect_complaint(with("wall_support = true\n"), "numerics.wall_support: does not go together");
  expect_complaint(with("gradient_correction = true\nshifting = true\n"), "numerics.shifting: does not go together");
  expect_complaint(with("integrator = \"energy_bounded_euler\"\n"), "numerics.integrator: does not go together");
  expect_complaint(refusal(replaced(good, "hydrostatic = true\n", "") + "density = \"summation\"\n"),
                   "numerics.density: does not go together");
  expect_complaint(with("[fluid.heat]\ndiffusivity = 1\ninitial = 20\n"), "fluid.heat: does not go together");
  expect_complaint(with("[[vent]]\ndisc = { centre = [0.5, 0.8], normal = [0, -1], radius = 0.1 }\nrate = 0.1\n"),
                   "vent: does not go together");
  expect_complaint(with("[[outflow]]\nplane = { point = [0.9, 0], normal = [1, 0] }\n"), "outflow: does not go");
  expect_complaint(with("[[boundary]]\nplane = { point = [0, 0], normal = [0, 1] }\n"),
                   "boundary.1: a plane has no end to put boundary particles on");
  expect_complaint(with("[[boundary]]\nbox = { min = [0.6, 0.5], max = [0.8, 0.7] }\nbody = { density = 500 }\n"),
                   "boundary.1.body: a free body cannot be made of boundary particles");
  const std::string moving =
      "[[boundary]]\nbox = { min = [0.6, 0.5], max = [0.8, 0.7] }\nmotion = { velocity = [0, 1] }\n";
  EXPECT_EQ(refusal(good + moving), "");
  expect_complaint(refusal(tank_text(2, 0.4, repulsive) + moving),
                   "boundary.1.motion: repulsive boundary particles stay");
  const std::string small = replaced(good, "dimensions = 2", "dimensions = 2\ndomain = { min = [0, 0], max = [1, 1] }");
  expect_complaint(refusal(small), "scene.domain: leaves boundary particles of boundary.0 outside; widen it by 0.1 m");
}

TEST(BoundaryParticles, RefuseWallsFarLargerThanTheFluidAtOnce) {
  for (const std::string& kind : {dynamic, repulsive}) {
    const std::string domain = "dimensions = 2\ndomain = { min = [-9, -9], max = [9, 1e13] }";
    const std::string huge =
        replaced(replaced(tank_text(2, 0.4, kind), "[1, 1]", "[1, 1e12]"), "dimensions = 2", domain);
    expect_complaint(refusal(huge), "boundary.0: ");
    expect_complaint(refusal(huge), "as boundary particles; give a smaller wall or a larger spacing");
  }
  const std::string far = replaced(tank_text(2, 0.4, dynamic), "[1, 1]", "[1, 1e4]");
  expect_complaint(refusal(far), "boundary.0: reaches 9.95e+03 m beyond where boundary particles are kept");
}

TEST(BoundaryParticles, ScenesSayWhichOnes) {
  const auto asked = [](const std::string& numerics) {
    return parse_scene(tank_text(2, 0.4, numerics), "s.toml").numerics.boundary_particles;
  };
  EXPECT_FALSE(asked("").has_value());
  EXPECT_FALSE(asked(dias + "boundary_particles = false\n").has_value());
  ASSERT_TRUE(asked(dias).has_value());
  EXPECT_EQ(asked(dias)->every, 15);
  EXPECT_EQ(asked(dynamic)->every, 1);
  EXPECT_EQ(asked(dias + repulsive)->kind, BoundaryParticles::Kind::repulsive);
  const auto wrong = [](const std::string& numerics) { return complaint(tank_text(2, 0.4, numerics)); };
  expect_complaint(wrong("boundary_particles = true\n"), "true says too little");
  expect_complaint(wrong("boundary_particles = { every = 3 }\n"), "numerics.boundary_particles.kind");
  expect_complaint(wrong("boundary_particles = { kind = \"ghost\" }\n"), "ghost");
  expect_complaint(wrong("boundary_particles = { kind = \"repulsive\", every = 2 }\n"), "leave it out");
  expect_complaint(wrong("boundary_particles = { kind = \"dynamic\", every = 0 }\n"), "every");
}

TEST(BoundaryParticles, OpenPolygonsLackTheirLastEdge) {
  const std::string polygon = "polygon = { points = [[0, 1], [0, 0], [1, 0], [1, 1]], open = true }";
  const std::string text =
      replaced(tank_text(2, 0.4, ""), "[[boundary]]\nbox = { min = [0, 0], max = [1, 1] }", "[[boundary]]\n" + polygon);
  const auto walls = build_walls<2>(parse_scene(text, "s.toml"), 0.05);
  ASSERT_EQ(walls.size(), 1u);
  EXPECT_EQ(walls[0].facets.size(), 3u);
  for (const auto& [a, b] : walls[0].facets)
    EXPECT_FALSE(walls[0].vertices[a][1] == 1 && walls[0].vertices[b][1] == 1) << "the lid";
  expect_complaint(complaint(replaced(flat, "box = { min = [0, 0], max = [1, 2] }", polygon)), "is open");
}

}  // namespace
}  // namespace molten::boundary_particles_test
