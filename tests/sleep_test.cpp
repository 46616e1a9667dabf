// Sleep: who falls asleep and who wakes, that it takes no more than it states, repeats and survives a restart.
#include "core/sleep.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>

#include "core/diagnostics.h"
#include "core/error.h"
#include "tests/clouds.h"
#include "tests/memory_archive.h"
#include "tests/with_threads.h"

namespace molten::sleep_test {
namespace {

using namespace particle_sets;

constexpr double spacing = 0.02;

/// A long slab at rest, on springs of its own pressure alone, and a small block that flies at its left end.
Start slab_and_drop(const Scene& scene, double speed) {
  const bool flat = scene.dimensions == 2;
  Points points = lattice(flat ? std::vector{100, 10} : std::vector{44, 5, 5}, spacing);
  const std::size_t resting = points.size();
  for (auto p : lattice(flat ? std::vector{6, 6} : std::vector{4, 4, 4}, spacing)) {
    p[0] -= (flat ? 9 : 7) * spacing;
    points.push_back(p);
  }
  Start start = start_of(scene, points, spacing);
  for (std::size_t k = resting; k < points.size(); ++k) start.velocity[k] = {speed, 0, 0};
  return start;
}

Scene sleepy_scene(int dim) {
  Scene scene = plain_scene(dim);
  scene.numerics.artificial_viscosity = 0.5;
  scene.numerics.sleep.emplace();
  scene.numerics.sleep->speed = 0.01;
  scene.numerics.sleep->after = 0.005;
  return scene;
}

Scene hot_sleepy_scene(int dim) {
  Scene scene = sleepy_scene(dim);
  scene.fluid.rheology = {Rheology::Model::smd, 0, 0.5, {15, 150}, 0.6, 0.2};
  scene.fluid.heat = Heat{1e-2, std::array<double, 2>{40, 60}, 20, 90};
  scene.numerics.integrator = IntegratorKind::symplectic_euler;
  return scene;
}

/// A column's value of every particle, by id.
template <class F, int Dim, class Real>
std::map<std::int64_t, double> by_id(const State<Dim, Real>& s, F field, int k) {
  std::map<std::int64_t, double> values;
  for (std::size_t slot = 0; slot < s.particles.slots(); ++slot)
    if (!s.particles.is_padding(slot)) values[s.particles[id][0][slot]] = s.particles[field][k][slot];
  return values;
}

template <int Dim, class Real> void run_until(State<Dim, Real>& s, double time) {
  while (s.clock.time < time) step(s);
}

template <class F> class SleepOf : public testing::Test {};
TYPED_TEST_SUITE(SleepOf, Flavours, FlavourNames);
TYPED_TEST(SleepOf, WhatRestsFallsAsleepWhereItIs) {
  MOLTEN_FLAVOUR;
  const Scene scene = sleepy_scene(Dim);
  auto s = state_of<Dim, Real>(scene, slab_and_drop(scene, 0.1));
  const auto before = by_id(s, position, 0);
  EXPECT_EQ(s.sleep.asleep, 0);
  run_until(s, 0.03);
  const auto n = static_cast<std::int64_t>(s.particles.count());
  EXPECT_EQ(n, static_cast<std::int64_t>(before.size()));
  EXPECT_GT(s.sleep.asleep, n / 2);
  EXPECT_LT(s.sleep.asleep, n - 36) << "the drop flies";
  EXPECT_EQ(diagnose(s).asleep, s.sleep.asleep);
  const std::size_t end = s.neighbours.first_slot(Block::active);
  ASSERT_GT(end, 0u);
  std::int64_t asleep = 0;
  for (std::size_t slot = 0; slot < end; ++slot) {
    if (s.particles.is_padding(slot)) continue;
    ++asleep;
    EXPECT_EQ(s.particles[position][0][slot], before.at(s.particles[id][0][slot]));
    for (int d = 0; d < Dim; ++d) EXPECT_EQ(s.particles[velocity][d][slot], 0);
  }
  EXPECT_EQ(asleep, s.sleep.asleep);
  EXPECT_LE(s.sleep.taken_energy, asleep * s.parameters.particle_mass * 0.01 * 0.01 / 2);
}

TYPED_TEST(SleepOf, TheReachOfAListAroundWhatMovesIsAwake) {
  MOLTEN_FLAVOUR;
  const Scene scene = sleepy_scene(Dim);
  auto s = state_of<Dim, Real>(scene, slab_and_drop(scene, 1.5));
  const double reach = s.parameters.support_radius + s.parameters.skin;
  double nearest = 1e300;
  while (s.clock.time < 0.1) {
    for (int k = 0; k < 7; ++k) step(s);
    s.sleep.travel = 1;  // m; it is time for a look
    wake_and_rest(s);
    const std::size_t end = s.neighbours.first_slot(Block::active);
    for_each_particle(s.particles, [&](std::size_t i, const auto& xi) {
      if (i < end || s.particles[rest_time][0][i] >= static_cast<Real>(s.parameters.rest->after)) return;
      for_each_particle(s.particles, [&](std::size_t j, const auto& xj) {
        if (j < end) nearest = std::min(nearest, std::hypot(xi[0] - xj[0], xi[1] - xj[1], xi[2] - xj[2]));
      });
    });
  }
  EXPECT_GT(nearest, reach);
  EXPECT_LT(nearest, 4 * reach) << "no more than that is awake around it";
}

TYPED_TEST(SleepOf, TakesTheEnergyOfWhatFallsAsleepAndNoMore) {
  MOLTEN_FLAVOUR;
  const Scene scene = sleepy_scene(Dim);
  Start start = slab_and_drop(scene, 0.008);
  for (auto& v : start.velocity) v = {0.008, 0, 0};
  auto s = state_of<Dim, Real>(scene, start);
  run_until(s, 0.01);
  const auto n = static_cast<double>(s.particles.count());
  EXPECT_EQ(s.sleep.asleep, n) << "slower than the bound is at rest";
  EXPECT_EQ(diagnose(s).kinetic_energy, 0);
  const double bound = n * s.parameters.particle_mass * 0.01 * 0.01 / 2;
  EXPECT_LE(s.sleep.taken_energy, bound);
  EXPECT_NEAR(s.sleep.taken_energy, n * s.parameters.particle_mass * 0.008 * 0.008 / 2, 0.02 * bound);
  const auto before = by_id(s, position, 0);
  run_until(s, 0.02);
  EXPECT_EQ(before, by_id(s, position, 0));
}

TYPED_TEST(SleepOf, ADropWakesWhatItHits) {
  MOLTEN_FLAVOUR;
  Scene scene = sleepy_scene(Dim);
  const Start start = slab_and_drop(scene, 1.0);
  auto s = state_of<Dim, Real>(scene, start);
  scene.numerics.sleep.reset();
  auto twin = state_of<Dim, Real>(scene, start);
  std::int64_t most = 0;
  while (s.clock.time < 0.12) {
    step(s);
    most = std::max(most, s.sleep.asleep);
  }
  run_until(twin, s.clock.time);
  const auto n = static_cast<double>(s.particles.count());
  EXPECT_GT(most, 0.5 * n);
  EXPECT_LT(s.sleep.asleep, most) << "woken";
  // All the slab's left end moves as without sleep; all in all no particle is denied more than m v of momentum.
  const auto x = by_id(s, position, 0), same = by_id(twin, position, 0);
  double furthest = 0;
  for (const auto& [number, where] : x) furthest = std::max(furthest, std::abs(where - same.at(number)));
  EXPECT_LT(furthest, 0.01 * (s.clock.time + 1e-3) + 0.05 * spacing);
  const double momentum = diagnose(s).momentum[0], whole = diagnose(twin).momentum[0];
  EXPECT_LT(std::abs(momentum - whole), n * s.parameters.particle_mass * 0.01);
  EXPECT_GT(std::abs(whole), n * s.parameters.particle_mass * 0.01) << "or the bound says nothing";
}

TYPED_TEST(SleepOf, NobodySleepsAtTheTopOfAThrow) {
  // |v| stays below the bound on speed for 0.08 s there, ten times as long as sound takes for its 40 smoothing lengths.
  MOLTEN_FLAVOUR;
  Scene scene = sleepy_scene(Dim);
  scene.gravity[Dim - 1] = -10;
  scene.numerics.sound_speed = 100;
  scene.numerics.sleep->speed = 0.4;
  scene.numerics.sleep->after.reset();
  Start start = start_of(scene, cube<Dim>(2, spacing), spacing);
  for (auto& v : start.velocity) v[Dim - 1] = 0.5;
  auto s = state_of<Dim, Real>(scene, start);
  const double height = by_id(s, position, Dim - 1).at(0);
  while (s.clock.time < 0.1) {
    step(s);
    ASSERT_EQ(s.sleep.asleep, 0) << "at " << s.clock.time << " s";
  }
  const double t = s.clock.time;
  EXPECT_NEAR(by_id(s, position, Dim - 1).at(0), height + 0.5 * t - 5 * t * t, 1e-5);
}

// ---- heat -----------------------------------------------------------------------------------------------------------

/// A slab at rest, its left half hot.
Start half_hot(const Scene& scene) {
  const bool flat = scene.dimensions == 2;
  Start start = start_of(scene, lattice(flat ? std::vector{100, 10} : std::vector{60, 5, 5}, spacing), spacing);
  for (std::size_t k = 0; k < start.position.size(); ++k)
    start.temperature[k] = start.position[k][0] < (flat ? 50 : 30) * spacing ? 90 : 20;
  return start;
}

Scene conducting_scene(int dim) {
  Scene scene = sleepy_scene(dim);
  scene.fluid.heat = Heat{1e-2, std::nullopt, 20, 90};
  scene.numerics.sleep->temperature_rate = 0.5;
  return scene;
}

TYPED_TEST(SleepOf, HeatFlowsWhereNothingMoves) {
  MOLTEN_FLAVOUR;
  Scene scene = conducting_scene(Dim);
  const Start start = half_hot(scene);
  auto s = state_of<Dim, Real>(scene, start);
  scene.numerics.sleep.reset();
  auto twin = state_of<Dim, Real>(scene, start);
  const auto n = static_cast<std::int64_t>(s.particles.count());
  run_until(s, 0.1);
  EXPECT_EQ(s.sleep.asleep, n);
  EXPECT_GT(s.sleep.warm, n / 20);
  EXPECT_LT(s.sleep.warm, 9 * n / 10);
  const std::int64_t narrow = s.sleep.warm;
  run_until(s, 0.2);
  EXPECT_EQ(s.sleep.asleep, n) << "heat alone wakes nobody whose viscosity is constant";
  EXPECT_GE(s.sleep.warm, narrow);
  run_until(twin, s.clock.time);
  conduct_at_rest(s);  // for the few steps that have waited
  const auto T = by_id(s, temperature, 0), true_T = by_id(twin, temperature, 0);
  double furthest = 0, flowed = 0;
  for (const auto& [number, value] : T) {
    furthest = std::max(furthest, std::abs(value - true_T.at(number)));
    flowed = std::max(flowed, std::abs(value - start.temperature[static_cast<std::size_t>(number)]));
  }
  EXPECT_LT(furthest, 0.5 * 0.2 + 0.1) << "the bound on the rate for so long, and that of longer time steps";
  EXPECT_GT(flowed, 20);
  EXPECT_NEAR(diagnose(s).heat / diagnose(twin).heat, 1, 1e-4);
}

// The bound of a scene that gives none must let heat flow as long as it crosses the fluid, not a smoothing length.
TYPED_TEST(SleepOf, HeatCrossesAllOfTheFluid) {
  MOLTEN_FLAVOUR;
  Scene scene = conducting_scene(Dim);
  Start start = start_of(scene, lattice(Dim == 2 ? std::vector{100, 4} : std::vector{100, 2, 2}, spacing), spacing);
  for (std::size_t k = 0; k < start.position.size(); ++k)
    start.temperature[k] = start.position[k][0] < 50 * spacing ? 90 : 20;
  const double h = scene.numerics.smoothing_ratio * spacing, end = 400 * h * h / scene.fluid.heat->diffusivity;
  const auto temperatures = [&](std::optional<double> bound) {
    scene.numerics.sleep->temperature_rate = bound;
    auto s = state_of<Dim, Real>(scene, start);
    run_until(s, end);
    EXPECT_EQ(s.sleep.asleep, static_cast<std::int64_t>(s.particles.count()));
    return by_id(s, temperature, 0);
  };
  const auto bounded = temperatures({}), never = temperatures(0);
  double furthest = 0;
  for (const auto& [number, value] : bounded) furthest = std::max(furthest, std::abs(value - never.at(number)));
  this->RecordProperty("furthest", fmt::format("{:.3g}", furthest));
  EXPECT_LT(furthest, 0.2) << "of 70";
  EXPECT_GT(never.at(0), 20) << "so far in the hot half";
  EXPECT_LT(never.at(0), 88) << "heat has come from all over";
}

TYPED_TEST(SleepOf, HeatAtRestIsConductedAsOftenAsItMust) {
  MOLTEN_FLAVOUR;
  Scene scene = conducting_scene(Dim);
  scene.fluid.heat->diffusivity = 1e-3;
  auto s = state_of<Dim, Real>(scene, half_hot(scene));
  const auto n = static_cast<std::int64_t>(s.particles.count());
  while (s.sleep.asleep < n && s.clock.time < 0.1) step(s);
  ASSERT_EQ(s.sleep.asleep, n);
  ASSERT_GT(s.sleep.warm, 0);
  const double begin = s.clock.time, limit = conduction_limit(s.parameters);
  int conducted = 0, steps = 0;
  for (double waited = s.sleep.warm_time; s.clock.time < begin + 5 * limit; waited = s.sleep.warm_time) {
    step(s);
    conducted += s.sleep.warm_time < waited;
    ++steps;
  }
  EXPECT_GT(steps, 100) << "or the count says nothing";
  EXPECT_GE(conducted, 8);
  EXPECT_LE(conducted, 10) << "every half limit";
}

TYPED_TEST(SleepOf, WhatMeltsWakes) {
  MOLTEN_FLAVOUR;
  Scene scene = conducting_scene(Dim);
  scene.fluid.rheology = {Rheology::Model::smd, 0, 0.5, {15, 150}, 0.6, 0.2};
  scene.fluid.heat->melting_range = std::array<double, 2>{40, 60};
  scene.fluid.heat->diffusivity = 2e-3;
  scene.numerics.sleep->temperature = 5;
  auto s = state_of<Dim, Real>(scene, half_hot(scene));
  const auto n = static_cast<std::int64_t>(s.particles.count());
  while (s.sleep.asleep < n && s.clock.time < 0.1) step(s);
  EXPECT_EQ(s.sleep.asleep, n);
  const auto asleep_at = by_id(s, temperature, 0);
  while (s.sleep.asleep == n && s.clock.time < 0.2) step(s);
  EXPECT_LT(s.sleep.asleep, n);
  double change = 0;
  for (const auto& [number, T] : by_id(s, temperature, 0))
    change = std::max(change, std::abs(T - asleep_at.at(number)));
  EXPECT_GE(change, 5);
  EXPECT_LT(change, 7);
}

template <int Dim, class Real> auto archived_after(const Scene& scene, const Start& start, int threads, int steps) {
  const WithThreads set(threads);
  auto s = state_of<Dim, Real>(scene, start);
  for (int k = 0; k < steps; ++k) step(s);
  EXPECT_GT(s.sleep.asleep, 0);
  return archived(s);
}

TYPED_TEST(SleepOf, GivesTheSameBitsForAnyNumberOfThreads) {
  MOLTEN_FLAVOUR;
  for (const Scene& scene : {sleepy_scene(Dim), hot_sleepy_scene(Dim)}) {
    const Start start = scene.fluid.heat ? half_hot(scene) : slab_and_drop(scene, 1.0);
    EXPECT_TRUE((archived_after<Dim, Real>(scene, start, 1, 120) == archived_after<Dim, Real>(scene, start, 3, 120)));
  }
}

TYPED_TEST(SleepOf, SurvivesARestartBitForBit) {
  MOLTEN_FLAVOUR;
  for (const Scene& scene : {sleepy_scene(Dim), hot_sleepy_scene(Dim)}) {
    const Start start = scene.fluid.heat ? half_hot(scene) : slab_and_drop(scene, 1.0);
    auto whole = state_of<Dim, Real>(scene, start);
    bool slept = false;
    for (int piece = 0; piece < 20; ++piece) {
      auto other = state_of<Dim, Real>(scene, start);
      MemoryArchive checkpoint = saved(whole);
      other.archive(checkpoint);
      for (int k = 0; k < 8; ++k) step(whole), step(other);
      ASSERT_TRUE(archived(whole) == archived(other)) << "from step " << 8 * piece;
      slept |= whole.sleep.asleep > 0;
    }
    EXPECT_TRUE(slept);
  }
}

// ---- order and list in blocks ---------------------------------------------------------------------------------------

template <int Dim, class Real> std::vector<Block> left_of(const Particles<Dim, Real>& p, double x) {
  std::vector<Block> blocks(p.slots(), Block::active);
  for_each_particle(p, [&](std::size_t slot, const auto& at) {
    if (at[0] < x) blocks[slot] = Block::asleep;
  });
  return blocks;
}

/// Every pair within the support of which the first is active is listed once, none of which it is asleep. (In a small
/// periodic box a pair may be listed again by an image out of reach.)
template <int Dim, class Real> void expect_lists_of_active(const clouds::Cloud<Dim, Real>& c) {
  const std::size_t first = c.neighbours.first_slot(Block::active);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> listed;
  const double reach = 1.0001 * c.settings.support_radius;  // rounding: pairs beyond the support are not asked for
  clouds::for_each_listed(c, [&](std::uint32_t i, std::uint32_t j, const auto& x) {
    EXPECT_GE(i, first);
    double r2 = 0;
    for (int d = 0; d < Dim; ++d) r2 += double(x[d]) * x[d];
    if (r2 < reach * reach) ++listed[{i, j}];
  });
  std::size_t across = 0;
  for (const auto& pair : naive_pairs(c.particles, c.domain.periodic, c.settings.support_radius)) {
    if (pair.first < first) continue;
    across += pair.second < first;
    EXPECT_EQ(listed[pair], 1) << pair.first << " with " << pair.second;
  }
  EXPECT_GT(across, 0u);
}

TYPED_TEST(SleepOf, ActiveParticlesFindNeighboursInAllBlocks) {
  MOLTEN_FLAVOUR;
  const int cells = Dim == 2 ? 24 : 9;
  clouds::Cloud<Dim, Real> c(cube<Dim>(cells, 0.1, 0.3), 0.1,
                             clouds::domain_between<Dim>(0, cells * 0.1, {false, true, false}));
  c.neighbours.rebuild(c.particles, left_of(c.particles, 0.05 * cells));
  expect_lists_of_active(c);
  const std::size_t end = c.neighbours.first_slot(Block::active), count = c.particles.count();
  const std::vector<std::int64_t> ids(c.particles[id][0], c.particles[id][0] + end);
  const std::vector<Real> local(c.particles[local_position][0], c.particles[local_position][0] + end);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> move(-0.08, 0.08);
  for (int again = 0; again < 3; ++again) {
    const auto x = c.particles[position];
    for (std::size_t slot = end; slot < c.particles.slots(); ++slot)
      for (int d = 0; d < Dim; ++d) x[d][slot] = std::clamp(x[d][slot] + move(random), 0.0, 0.0999 * cells);
    ASSERT_TRUE(c.neighbours.covers_active(c.particles));
    c.neighbours.rebuild_active(c.particles);
    EXPECT_EQ(c.neighbours.first_slot(Block::active), end);
    EXPECT_EQ(c.particles.count(), count);
    EXPECT_EQ(ids, (std::vector<std::int64_t>(c.particles[id][0], c.particles[id][0] + end)));
    EXPECT_EQ(local, (std::vector<Real>(c.particles[local_position][0], c.particles[local_position][0] + end)));
    expect_lists_of_active(c);
  }
  c.particles[position][0][c.particles.slots() - cluster_size] = 100;
  EXPECT_FALSE(c.neighbours.covers_active(c.particles));
}

}  // namespace
}  // namespace molten::sleep_test
