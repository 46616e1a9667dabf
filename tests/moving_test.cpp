// Walls that move, vents and outflow in whole runs: restart, threads, sleep.
#include <gtest/gtest.h>
#include <omp.h>

#include "core/diagnostics.h"
#include "tests/contact_shapes.h"
#include "tests/flavours.h"
#include "tests/memory_archive.h"
#include "tests/particle_sets.h"

namespace molten::moving_test {
namespace {

using namespace particle_sets;

constexpr double spacing = 0.02;

template <int Dim> Point<Dim> along_x(double x) { return x * Point<Dim>::Unit(0); }

Wall<2> block(const Point<2>&, double half) { return contact_test::square(half, false); }
Wall<3> block(const Point<3>&, double half) { return contact_test::box(half, false); }

/// A block in its own frame, as the next of the bodies.
template <int Dim> void add_body(std::vector<Wall<Dim>>& walls, std::vector<RigidBody<Dim>>& bodies, double half) {
  Wall<Dim> wall = block(Point<Dim>(), half);
  wall.body = static_cast<std::int32_t>(bodies.size());
  walls.push_back(wall);
  bodies.emplace_back().extent = half * std::sqrt(Dim);
}

template <int Dim> void set_free(RigidBody<Dim>& body, double mass, double half) {
  using Moment = decltype(Inertia<Dim>::moment);
  body.inertia = Inertia<Dim>{mass, mass * half * half * 2 / 3 * Moment::Identity()};
}

template <int Dim> VentPatch<Dim> small_vent(const Point<Dim>& centre, const Point<Dim>& normal, double speed) {
  VentPatch<Dim> patch;
  patch.centre = centre;
  patch.normal = normal;
  patch.offsets = disc_offsets<Dim>(normal, 2.5 * spacing, spacing);
  const double rate = speed * static_cast<double>(patch.offsets.size()) * std::pow(spacing, Dim - 1);
  patch.table = {{0, rate, 50}, {0.05, 2 * rate, 90}};
  return patch;
}

template <int Dim>
Surroundings<Dim> surroundings(std::vector<Wall<Dim>> walls, std::vector<RigidBody<Dim>> bodies,
                               std::vector<VentPatch<Dim>> patches) {
  const double support = 2.6 * spacing;
  Surroundings<Dim> around(Contact<Dim>(std::move(walls), spacing / 2, support), Bodies<Dim>(std::move(bodies)),
                           Vents<Dim>(std::move(patches), spacing, support));
  around.bodies.place(around.contact);
  return around;
}

template <int Dim, class Real>
State<Dim, Real> state_in(const Scene& scene, const Start& start, Surroundings<Dim> around) {
  Features features = features_of(scene);
  features.contact = !around.contact.empty();
  features.bodies = around.bodies.count() > 0;
  features.vents = around.vents.count() > 0;
  features.outflow = !scene.outflows.empty();
  return make_state<Dim, Real>(features, parameters_of<Dim>(scene, start), std::move(around), start);
}

// ---- restart and threads --------------------------------------------------------------------------------------------

Scene busy_scene(int dim, bool sleeps) {
  Scene scene = plain_scene(dim);
  scene.numerics.artificial_viscosity = 0.2;
  scene.fluid.heat = Heat{1e-3, std::nullopt, 20, 90};
  scene.outflows = {{{1.3, 0, 0}, {1, 0, 0}}};
  if (!sleeps) return scene;
  scene.numerics.sleep.emplace();
  scene.numerics.sleep->speed = 0.01;
  scene.numerics.sleep->after = 0.005;
  scene.numerics.sleep->temperature_rate = 100;
  return scene;
}

/// A slab between a turning block that comes, a free one that hits it, and a vent; beyond, a vent spits through the
/// outflow.
template <int Dim, class Real> State<Dim, Real> busy_state(const Scene& scene) {
  const Start start = start_of(scene, lattice(Dim == 2 ? std::vector{44, 8} : std::vector{44, 5, 5}, spacing), spacing);
  const double high = (Dim == 2 ? 8 : 5) * spacing, wide = 44 * spacing;
  std::vector<Wall<Dim>> walls;
  std::vector<RigidBody<Dim>> bodies;
  add_body(walls, bodies, 0.05);
  bodies[0].centre = along_x<Dim>(-0.08) + Point<Dim>::Constant(high / 2) - along_x<Dim>(high / 2);
  bodies[0].prescribed.velocity[0] = 0.5;
  bodies[0].prescribed.spin[0] = 3;
  add_body(walls, bodies, 0.04);
  bodies[1].centre = Point<Dim>::Constant(high / 2);
  bodies[1].centre[Dim - 1] = high + 0.06;
  bodies[1].prescribed.velocity[Dim - 1] = -1;
  set_free(bodies[1], 1000 * std::pow(0.08, Dim), 0.04);
  Point<Dim> middle = Point<Dim>::Constant(high / 2);
  middle[0] = wide + 0.08;
  const std::vector<VentPatch<Dim>> vents = {
      small_vent<Dim>(middle, along_x<Dim>(-1), 0.8),
      small_vent<Dim>(middle + along_x<Dim>(1.28 - middle[0]), along_x<Dim>(1), 1.5)};
  return state_in<Dim, Real>(scene, start, surroundings<Dim>(walls, bodies, vents));
}

template <class F> class Moving : public testing::Test {};
TYPED_TEST_SUITE(Moving, Flavours, FlavourNames);

TYPED_TEST(Moving, WallsAndVentsSurviveARestartBitForBit) {
  MOLTEN_FLAVOUR;
  for (const bool sleeps : {false, true}) {
    const Scene scene = busy_scene(Dim, sleeps);
    auto whole = busy_state<Dim, Real>(scene);
    const std::int64_t first = diagnose(whole).particles;
    std::int64_t left = 0;
    for (int piece = 0; piece < 16; ++piece) {
      auto other = busy_state<Dim, Real>(scene);
      MemoryArchive checkpoint = saved(whole);
      other.archive(checkpoint);
      for (int k = 0; k < 9; ++k) {
        const std::int64_t before = diagnose(whole).particles;
        step(whole), step(other);
        left += diagnose(whole).particles < before;
      }
      ASSERT_TRUE(archived(whole) == archived(other)) << "from step " << 9 * piece;
    }
    EXPECT_GT(diagnose(whole).particles, first) << "or no vent was open";
    EXPECT_GT(left, 0) << "or nothing flowed out";
    EXPECT_NE(whole.bodies.motion(1).velocity[Dim - 1], -1) << "or nothing was hit";
    EXPECT_EQ(whole.sleep.asleep > 0, sleeps);
  }
}

TYPED_TEST(Moving, WallsAndVentsGiveTheSameBitsForAnyNumberOfThreads) {
  MOLTEN_FLAVOUR;
  const auto after = [&](const Scene& scene, int threads) {
    const int before = omp_get_max_threads();
    omp_set_num_threads(threads);
    auto s = busy_state<Dim, Real>(scene);
    for (int k = 0; k < 100; ++k) step(s);
    omp_set_num_threads(before);
    return archived(s);
  };
  for (const bool sleeps : {false, true}) {
    const Scene scene = busy_scene(Dim, sleeps);
    const auto one = after(scene, 1);
    EXPECT_TRUE(one == after(scene, 2));
    EXPECT_TRUE(one == after(scene, 3));
  }
}

// ---- sleep ----------------------------------------------------------------------------------------------------------

/// A slab at rest with its right end at `wide`.
struct Slab {
  Scene scene;
  Start start;
  double wide, high;
};
Slab sleepy_slab(int dim) {
  Slab slab{plain_scene(dim), {}, (dim == 2 ? 100 : 44) * spacing, (dim == 2 ? 10 : 5) * spacing};
  slab.scene.numerics.artificial_viscosity = 0.5;
  slab.scene.numerics.sleep.emplace();
  slab.scene.numerics.sleep->speed = 0.01;
  slab.scene.numerics.sleep->after = 0.005;
  slab.start = start_of(slab.scene, lattice(dim == 2 ? std::vector{100, 10} : std::vector{44, 5, 5}, spacing), spacing);
  return slab;
}

/// `far` from the slab's right end, half-way up.
template <int Dim> Point<Dim> beside(const Slab& slab, double far) {
  Point<Dim> x = Point<Dim>::Constant(slab.high / 2);
  x[0] = slab.wide + far;
  return x;
}

template <int Dim, class Real> double rightmost_sleeper(const State<Dim, Real>& s) {
  double x = -1e300;
  for (std::size_t slot = 0; slot < s.neighbours.first_slot(Block::active); ++slot)
    if (!s.particles.is_padding(slot)) x = std::max(x, s.particles[position][0][slot]);
  return x;
}

template <int Dim, class Real> void run_until(State<Dim, Real>& s, double time) {
  while (s.clock.time < time) step(s);
}

template <int Dim, class Real>
State<Dim, Real> slab_and_block(const Slab& slab, const PrescribedMotion<Dim>& motion, double mass = 0) {
  std::vector<Wall<Dim>> walls;
  std::vector<RigidBody<Dim>> bodies;
  const double half = 0.75 * slab.high;
  add_body(walls, bodies, half);
  bodies[0].centre = beside<Dim>(slab, half + 0.7 * spacing);
  bodies[0].prescribed = motion;
  if (mass > 0) set_free(bodies[0], mass, half);
  return state_in<Dim, Real>(slab.scene, slab.start, surroundings<Dim>(walls, bodies, {}));
}

TYPED_TEST(Moving, AWallThatSetsOutWakesWhatItMeets) {
  MOLTEN_FLAVOUR;
  Slab slab = sleepy_slab(Dim);
  PrescribedMotion<Dim> motion;
  motion.key_frames = {{0.04, Point<Dim>::Zero(), Spin<Dim>::Zero()}, {1.04, along_x<Dim>(-0.5), Spin<Dim>::Zero()}};
  auto s = slab_and_block<Dim, Real>(slab, motion);
  run_until(s, 0.04);
  EXPECT_EQ(s.sleep.asleep, static_cast<std::int64_t>(s.particles.count())) << "beside a wall at rest";
  run_until(s, 0.06);
  EXPECT_LT(rightmost_sleeper(s), slab.wide - 2.6 * spacing);
  run_until(s, 0.1);
  EXPECT_GT(s.sleep.asleep, 0);
  slab.scene.numerics.sleep.reset();
  auto twin = slab_and_block<Dim, Real>(slab, motion);
  run_until(twin, s.clock.time);
  const Diagnostics here = diagnose(s), there = diagnose(twin);
  EXPECT_LT(there.upper[0], slab.wide - 0.5 * spacing) << "or it was not pushed";
  EXPECT_NEAR(here.upper[0], there.upper[0], 0.05 * spacing);
  EXPECT_NEAR(here.momentum[0], there.momentum[0], 0.05 * std::abs(there.momentum[0]));
}

TYPED_TEST(Moving, AFreeBodyKeepsWhatItTouchesAwake) {
  MOLTEN_FLAVOUR;
  const Slab slab = sleepy_slab(Dim);
  auto s = slab_and_block<Dim, Real>(slab, {}, 1000 * std::pow(1.5 * slab.high, Dim));
  run_until(s, 0.04);
  EXPECT_GT(s.sleep.asleep, static_cast<std::int64_t>(s.particles.count()) / 2);
  EXPECT_LT(rightmost_sleeper(s), slab.wide - 2.6 * spacing);
}

TYPED_TEST(Moving, AVentWakesWhatItReaches) {
  MOLTEN_FLAVOUR;
  const Slab slab = sleepy_slab(Dim);
  const auto with_vent = [&](double far) {
    return state_in<Dim, Real>(
        slab.scene, slab.start,
        surroundings<Dim>({}, {}, {small_vent<Dim>(beside<Dim>(slab, far), along_x<Dim>(-1), 0.5)}));
  };
  auto s = with_vent(0.1);
  run_until(s, 0.04);
  EXPECT_GT(s.sleep.asleep, static_cast<std::int64_t>(s.particles.count()) / 2);
  const double beside_it = rightmost_sleeper(s);
  run_until(s, 0.16);
  EXPECT_GT(s.sleep.asleep, 0);
  EXPECT_LT(rightmost_sleeper(s), beside_it) << "what came out has reached the slab";
}

}  // namespace
}  // namespace molten::moving_test
