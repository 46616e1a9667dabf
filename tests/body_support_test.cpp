// Bodies whose walls have support: what they give to the fluid they get back, from where it is, and move with.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/memory_archive.h"
#include "tests/physics/case.h"

namespace molten::body_support_test {
namespace {

using namespace physics_case;

constexpr double spacing = 0.05;

/// A block of fluid and at its right side, `gap` (m) off, a box; `body` are the box's keys. Shifted particles would not
/// keep momentum: preset "basic".
std::string beside_block(int dimensions, const std::string& body, const std::string& velocity, double gap = 0) {
  const bool flat = dimensions == 2;
  return fmt::format(
      "[scene]\ndimensions = {}\ngravity = {}\n[fluid]\nbox = {}\nspacing = {}\nvelocity = {}\n[[boundary]]\n{}\n"
      "slip = 0\n{}\n[numerics]\npreset = \"basic\"\nwall_support = true\ndensity_diffusion = 0.1\nsound_speed = "
      "10\n[run]\nend_time = 1\n",
      dimensions, flat ? "[0, 0]" : "[0, 0, 0]",
      flat ? "{ min = [0, 0], max = [0.5, 0.5] }" : "{ min = [0, 0, 0], max = [0.4, 0.4, 0.4] }", spacing, velocity,
      flat ? fmt::format("box = {{ min = [{}, 0.1], max = [{}, 0.35] }}", 0.5 + gap, 0.8 + gap)
           : "box = { min = [0.4, 0.1, 0.05], max = [0.6, 0.3, 0.3] }",
      body);
}

template <int Dim, class Real> State<Dim, Real> state_with(const std::string& text) {
  const Scene scene = parse_scene(text, "s.toml");
  return state_of<Dim, Real>(scene, fill_bodies(scene, features_of(scene)));
}

template <int Dim> struct Momentum {
  Point<Dim> linear = Point<Dim>::Zero();
  Spin<Dim> angular = Spin<Dim>::Zero();
  double size = 0;  // Σ m |v|
};

/// Of particles and bodies, half a step behind.
template <int Dim, class Real> Momentum<Dim> momentum_of(const State<Dim, Real>& s) {
  Momentum<Dim> m;
  const double mass = s.parameters.particle_mass;
  for_each_particle(s, [&](std::size_t slot) {
    Point<Dim> x, v;
    for (int d = 0; d < Dim; ++d) x[d] = s.particles[position][d][slot], v[d] = s.particles[half_velocity][d][slot];
    m.linear += mass * v;
    m.angular += mass * moment_of(x, v);
    m.size += mass * v.norm();
  });
  for (std::size_t k = 0; k < s.bodies.count(); ++k) {
    const RigidMotion<Dim>& motion = s.bodies.motion(k);
    const Point<Dim> given = s.bodies.body(k).inertia->mass * motion.velocity;
    m.linear += given;
    m.angular += s.bodies.angular_momentum(k) + moment_of(motion.start.centre, given);
    m.size += given.norm();
  }
  return m;
}

template <int Dim> std::string fast_body() {
  return Dim == 2 ? "body = { density = 1500, velocity = [-0.6, 0.2], spin = 60 }"
                  : "body = { density = 1500, velocity = [-0.6, 0.2, 0.1], spin = [20, 60, 10] }";
}
template <int Dim> std::string at_rest() { return Dim == 2 ? "[0, 0]" : "[0, 0, 0]"; }

template <class F> class BodySupportOf : public testing::Test {};
TYPED_TEST_SUITE(BodySupportOf, Flavours, FlavourNames);

TYPED_TEST(BodySupportOf, KeepsLinearAndAngularMomentum) {
  MOLTEN_FLAVOUR;
  const WithThreads one(1);
  auto s = state_with<Dim, Real>(beside_block(Dim, fast_body<Dim>(), at_rest<Dim>()));
  const auto before = momentum_of(s);
  const Point<Dim> velocity = s.bodies.motion(0).velocity;
  for (int k = 0; k < 60; ++k) step(s);
  const auto after = momentum_of(s);
  EXPECT_GT((s.bodies.motion(0).velocity - velocity).norm(), 0.05) << "it has pushed the fluid";
  EXPECT_LT((after.linear - before.linear).norm(), 1e-6 * before.size);
  EXPECT_LT((after.angular - before.angular).norm(), 1e-6 * before.size);
}

TYPED_TEST(BodySupportOf, FeelsNothingOfABodyThatGoesAlong) {
  MOLTEN_FLAVOUR;
  const std::string velocity = Dim == 2 ? "[0.3, 0.1]" : "[0.3, 0.1, 0.2]";
  const auto rates_beside = [&](const std::string& of_body) {
    auto s = state_with<Dim, Real>(beside_block(Dim, "motion = { velocity = " + of_body + " }", velocity));
    find_all_rates(s);
    double largest = 0;
    for_each_particle(s, [&](std::size_t slot) {
      largest = std::max(largest, std::abs(double(s.particles[compression_rate][0][slot])));
    });
    return largest;
  };
  EXPECT_LT(rates_beside(velocity), 1e-5);
  EXPECT_GT(rates_beside(at_rest<Dim>()), 1) << "0.3 m/s towards a wall at 0.025 m";
}

TYPED_TEST(BodySupportOf, GivesTheSameBitsForAnyNumberOfThreads) {
  MOLTEN_FLAVOUR;
  const auto run = [&](int threads) {
    const WithThreads set(threads);
    auto s = state_with<Dim, Real>(beside_block(Dim, fast_body<Dim>(), at_rest<Dim>()));
    for (int k = 0; k < 30; ++k) step(s);
    return archived(s);
  };
  const MemoryArchive one = run(1);
  EXPECT_TRUE(one == run(2));
  EXPECT_TRUE(one == run(3));
}

TYPED_TEST(BodySupportOf, GoesOnBitForBit) {
  MOLTEN_FLAVOUR;
  const WithThreads one(1);
  const std::string text = beside_block(Dim, fast_body<Dim>(), at_rest<Dim>());
  auto whole = state_with<Dim, Real>(text), stopped = state_with<Dim, Real>(text);
  for (int k = 0; k < 17; ++k) step(stopped), step(whole);
  MemoryArchive memory = saved(stopped);
  auto resumed = state_with<Dim, Real>(text);
  resumed.archive(memory);
  for (int k = 0; k < 20; ++k) step(resumed), step(whole);
  EXPECT_TRUE(archived(resumed) == archived(whole));
}

TEST(BodySupport, IsFoundWhereABodyComesToFluidAtRest) {
  const WithThreads one(1);
  const std::string away = beside_block(2, "motion = { velocity = [-2, 0] }", "[0, 0]", 0.3);
  auto s = state_with<2, double>(away);
  const auto near = [&] {
    std::size_t count = 0;
    for (std::size_t c = 0; c < s.neighbours.clusters(); ++c)
      count += s.wall_support.plane(c) != WallSupport<2>::no_plane;
    return count;
  };
  const std::size_t before = near();
  run_until(s, 0.1);
  EXPECT_GT(near(), before);
}

}  // namespace
}  // namespace molten::body_support_test
