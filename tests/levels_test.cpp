// Time steps by region: conserves, repeats, survives a restart, is the ordinary step where nothing is stiff, and
// follows the solution with the small step everywhere.
#include "core/levels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <random>

#include "core/diagnostics.h"
#include "tests/memory_archive.h"
#include "tests/particle_sets.h"
#include "tests/with_threads.h"

namespace molten::levels_test {
namespace {

using namespace particle_sets;

constexpr double spacing = 0.02;

/// A free blob, cold and stiff at its left end, at 30 times the step's stable viscosity, and hot and thin elsewhere.
Scene crusted_scene(int dim, IntegratorKind integrator = IntegratorKind::leap_frog) {
  Scene scene = plain_scene(dim);
  scene.fluid.rheology = {Rheology::Model::smd, 0, 0.5, {0, 150}, 2000, 200};
  scene.fluid.heat = Heat{1e-3, std::array<double, 2>{40, 60}, 20, 90};
  scene.numerics.integrator = integrator;
  scene.numerics.artificial_viscosity = 0.1;
  scene.numerics.time_step_levels = 6;
  return scene;
}

/// Sheared, so that all of it deforms.
Start blob(const Scene& scene) {
  const bool flat = scene.dimensions == 2;
  Start start = start_of(scene, lattice(flat ? std::vector{30, 12} : std::vector{16, 8, 8}, spacing, 0.1), spacing);
  for (std::size_t k = 0; k < start.position.size(); ++k) {
    const auto& x = start.position[k];
    start.temperature[k] = x[0] < (flat ? 8 : 5) * spacing ? 20 : x[0] < (flat ? 12 : 7) * spacing ? 50 : 90;
    start.velocity[k] = {2 * x[1], 0.1 + x[0], flat ? 0 : -x[1]};
  }
  return start;
}

/// The floor below it, which stops what it meets.
template <int Dim> std::vector<Wall<Dim>> floor() {
  Wall<Dim> wall;
  wall.is_plane = true;
  wall.plane_normal[Dim - 1] = 1;
  wall.response = {0, 0};
  return {wall};
}

/// Falls on the floor and slides along it, stiff below and thin above.
Start falling_block(const Scene& scene) {
  const bool flat = scene.dimensions == 2;
  Start start = start_of(scene, lattice(flat ? std::vector{20, 12} : std::vector{8, 8, 8}, spacing, 0.1), spacing);
  for (std::size_t k = 0; k < start.position.size(); ++k) {
    start.temperature[k] = start.position[k][scene.dimensions - 1] < 5 * spacing ? 20 : 90;
    start.velocity[k] = {0.3, 0, 0};
    start.velocity[k][scene.dimensions - 1] = -0.3;
  }
  return start;
}

template <int Dim, class Real> void run_until(State<Dim, Real>& s, double time) {
  while (s.clock.time < time) {
    s.clock.stop = time;
    step(s);
  }
}

template <int Dim, class Real> std::array<double, 3> angular_momentum(const State<Dim, Real>& s) {
  std::array<double, 3> sum{};
  for_each_particle(s.particles, [&](std::size_t k, const std::array<double, 3>& x) {
    std::array<double, 3> v{};
    for (int d = 0; d < Dim; ++d) v[d] = s.particles[velocity][d][k];
    for (int d = 0; d < 3; ++d)
      sum[d] += s.parameters.particle_mass * (x[(d + 1) % 3] * v[(d + 2) % 3] - x[(d + 2) % 3] * v[(d + 1) % 3]);
  });
  return sum;
}

template <class F> class LevelsOf : public testing::Test {};
TYPED_TEST_SUITE(LevelsOf, Flavours, FlavourNames);

TYPED_TEST(LevelsOf, TakesStepsThatAreTooLongForWhatIsStiff) {
  MOLTEN_FLAVOUR;
  const Scene scene = crusted_scene(Dim);
  auto s = state_of<Dim, Real>(scene, blob(scene));
  step(s), step(s);  // leap-frog's first kick is for half a step
  EXPECT_EQ(s.clock.limit, Limit::sound);
  const Levels& levels = s.levels;
  EXPECT_EQ(std::accumulate(levels.particles.begin(), levels.particles.end(), std::int64_t{0}),
            static_cast<std::int64_t>(s.particles.count()));
  EXPECT_GT(levels.particles[0], static_cast<std::int64_t>(s.particles.count() / 3));
  EXPECT_GT(levels.particles[5] + levels.particles[6], static_cast<std::int64_t>(s.particles.count() / 10));
  EXPECT_EQ(levels.stages, 5) << "5² + 5 ≥ 29.9 (2-D), 28.7";
  for (const PartialChunk& chunk : levels.stiff)
    for (const auto& row : chunk.rows) EXPECT_GT(levels.of[row.cluster], 0);
  for (const PartialChunk& chunk : levels.beside)
    for (const auto& row : chunk.rows) {
      EXPECT_EQ(levels.of[row.cluster], 0);
      for (std::uint32_t k = row.first_entry; k < row.end_entry; ++k)
        EXPECT_GT(levels.of[s.neighbours.shifts().cluster(chunk.entries[k])], 0);
    }
}

TYPED_TEST(LevelsOf, BoundsTheStepByTheirNumber) {
  MOLTEN_FLAVOUR;
  Scene scene = crusted_scene(Dim);
  scene.numerics.time_step_levels = 2;
  auto s = state_of<Dim, Real>(scene, blob(scene));
  step(s), step(s);
  EXPECT_EQ(s.clock.limit, Limit::viscous);
  EXPECT_NEAR(s.clock.dt / viscous_limit(s, s.extremes.kinematic_viscosity), 4, 1e-9);
  EXPECT_EQ(s.levels.stages, 2) << "2² + 2 ≥ 1.25 × 4";
  EXPECT_EQ(s.levels.particles[3], 0);
  EXPECT_GT(s.levels.particles[2], 0);
}

TYPED_TEST(LevelsOf, AreNotWhereTheyWouldNotPay) {
  MOLTEN_FLAVOUR;
  Scene scene = crusted_scene(Dim);
  scene.fluid.rheology.jump_number = {0, 6};  // the sound limit is twice the viscous one
  const Start start = blob(scene);
  auto s = state_of<Dim, Real>(scene, start);
  for (int k = 0; k < 3; ++k) {
    step(s);
    EXPECT_EQ(s.clock.limit, Limit::viscous);
    EXPECT_EQ(s.clock.dt, viscous_limit(s, s.extremes.kinematic_viscosity));
    EXPECT_EQ(s.levels.stages, 0);
  }
}

TYPED_TEST(LevelsOf, ConserveMomentumAndHeat) {
  MOLTEN_FLAVOUR;
  for (const auto integrator : {IntegratorKind::leap_frog, IntegratorKind::symplectic_euler}) {
    const Scene scene = crusted_scene(Dim, integrator);
    auto s = state_of<Dim, Real>(scene, blob(scene));
    const Diagnostics before = diagnose(s);
    double scale = 0;
    for_each_particle(s.particles, [&](std::size_t k, const auto&) {
      for (int d = 0; d < Dim; ++d) scale += s.parameters.particle_mass * std::abs(double(s.particles[velocity][d][k]));
    });
    for (int k = 0; k < 40; ++k) step(s);
    EXPECT_GT(s.levels.stages, 0);
    const Diagnostics after = diagnose(s);
    const double tolerance = sizeof(Real) == 8 ? 1e-12 : 2e-6;
    for (int d = 0; d < Dim; ++d) EXPECT_NEAR(after.momentum[d] / scale, before.momentum[d] / scale, tolerance);
    EXPECT_NEAR(after.heat / before.heat, 1, tolerance);
  }
}

/// The largest difference of velocities between runs, over the largest velocity at the start.
template <int Dim, class Real> double furthest(const State<Dim, Real>& a, const State<Dim, Real>& b, double scale) {
  std::map<std::int64_t, std::size_t> slot_of;
  for_each_particle(b.particles, [&](std::size_t k, const auto&) { slot_of[b.particles[id][0][k]] = k; });
  double most = 0;
  for_each_particle(a.particles, [&](std::size_t k, const auto&) {
    for (int d = 0; d < Dim; ++d)
      most = std::max(most, std::abs(double(a.particles[velocity][d][k]) -
                                     b.particles[velocity][d][slot_of.at(a.particles[id][0][k])]));
  });
  return most / scale;
}

TYPED_TEST(LevelsOf, FollowTheSolutionWithTheSmallStepEverywhere) {
  MOLTEN_FLAVOUR;
  for (const auto integrator : {IntegratorKind::leap_frog, IntegratorKind::symplectic_euler}) {
    Scene scene = crusted_scene(Dim, integrator);
    const Start start = blob(scene);
    auto s = state_of<Dim, Real>(scene, start);
    scene.numerics.time_step_levels = 0;
    auto fine = state_of<Dim, Real>(scene, start);
    const double spin = angular_momentum(s)[2];
    run_until(s, 0.01);
    run_until(fine, 0.01);
    EXPECT_LT(25 * s.clock.step, fine.clock.step);
    EXPECT_LT(furthest(s, fine, 0.7), 0.006);
    const double drift = std::abs(angular_momentum(s)[2] / spin - 1);
    EXPECT_LT(drift, 2 * std::abs(angular_momentum(fine)[2] / spin - 1) + 1e-4);
  }
}

TYPED_TEST(LevelsOf, AreHeldByWallsAsBySmallSteps) {
  MOLTEN_FLAVOUR;
  for (const auto integrator : {IntegratorKind::leap_frog, IntegratorKind::symplectic_euler}) {
    Scene scene = crusted_scene(Dim, integrator);
    const Start start = falling_block(scene);
    auto s = state_of<Dim, Real>(scene, start, floor<Dim>());
    scene.numerics.time_step_levels = 0;
    auto fine = state_of<Dim, Real>(scene, start, floor<Dim>());
    run_until(s, 0.02);
    run_until(fine, 0.02);
    EXPECT_LT(25 * s.clock.step, fine.clock.step);
    EXPECT_LT(furthest(s, fine, 0.3), 0.06);
    // The floor takes more than half; by contact alone it would take 0.02 to 0.04 less.
    const double left = diagnose(fine).momentum[0],
                 before = 0.3 * fine.parameters.particle_mass * start.position.size();
    EXPECT_LT(left, 0.5 * before);
    EXPECT_NEAR(diagnose(s).momentum[0] / before, left / before, 0.005);
  }
}

TYPED_TEST(LevelsOf, WithoutWhatIsStiffAreTheOrdinaryStepBitForBit) {
  MOLTEN_FLAVOUR;
  for (const auto integrator : {IntegratorKind::leap_frog, IntegratorKind::symplectic_euler}) {
    Scene scene = crusted_scene(Dim, integrator);
    scene.fluid.rheology.jump_number = {0, 2};
    const Start start = blob(scene);
    auto s = state_of<Dim, Real>(scene, start);
    scene.numerics.time_step_levels = 0;
    auto ordinary = state_of<Dim, Real>(scene, start);
    for (int k = 0; k < 20; ++k) step(s), step(ordinary);
    EXPECT_EQ(s.levels.particles[0], static_cast<std::int64_t>(s.particles.count()));
    EXPECT_EQ(s.clock.time, ordinary.clock.time);
    for_each_field([&]<class F>(F field) {
      if (!ordinary.particles.has(field)) return;
      for (int k = 0; k < components<F, Dim>; ++k) {
        const auto* a = s.particles[field][k];
        EXPECT_TRUE(std::equal(a, a + s.particles.slots(), ordinary.particles[field][k])) << F::name;
      }
    });
  }
}

/// The fastest rate (1/s) at which viscous forces alone damp a wave, by power iteration.
template <int Dim> double fastest_damping(State<Dim, double>& s) {
  const auto norm = [&](const auto& column) {
    double sum = 0;
    for_each_particle(s.particles, [&](std::size_t k, const auto&) {
      for (int d = 0; d < Dim; ++d) sum += column[d][k] * column[d][k];
    });
    return std::sqrt(sum);
  };
  double rate = 0;
  for (int k = 0; k < 100; ++k) {
    find_all_rates(s);
    const auto v = s.particles[velocity];
    const auto a = s.particles[acceleration];
    const double size = norm(a);
    rate = size / norm(v);
    for_each_particle(s.particles, [&](std::size_t slot, const auto&) {
      for (int d = 0; d < Dim; ++d) v[d][slot] = -a[d][slot] / size;
    });
  }
  return rate;
}

/// λ of viscous forces times the viscous limit, in a periodic cube.
template <int Dim> double damping_over_limit(StressForm form, const Points& points) {
  const int cells = static_cast<int>(std::lround(std::pow(points.size(), 1.0 / Dim)));
  Scene scene = plain_scene(Dim);
  scene.fluid.rheology = {Rheology::Model::bingham, 100, 1, {0, 0}, 1e-9, 1, 1};  // all but Newtonian
  scene.numerics.stress_form = form;
  scene.numerics.gradient_correction = form == StressForm::pairwise;
  make_periodic(scene, cells * spacing);
  auto s = state_of<Dim, double>(scene, points, spacing);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> of(-1, 1);
  set_velocity(s, [&](const auto&) { return std::array<double, 3>{of(random), of(random), of(random)}; });
  return fastest_damping(s) * viscous_limit(s, 100.0 / 1000);
}

template <int Dim> Points jittered(double part) { return cube<Dim>(Dim == 2 ? 16 : 8, spacing, part); }

/// Layers that a flow has pressed together two by two, 0.4 spacings apart.
template <int Dim> Points paired() {
  Points points = jittered<Dim>(0);
  for (auto& x : points) x[Dim - 1] += (std::lround(x[Dim - 1] / spacing - 0.5) % 2 == 0 ? 0.3 : -0.3) * spacing;
  return points;
}

template <int Dim> void expect_damping_within_the_limit() {
  for (const StressForm form : {StressForm::summed, StressForm::pairwise}) {
    EXPECT_GT(damping_over_limit<Dim>(form, jittered<Dim>(0)), 0.5);
    for (const double part : {0.0, 0.2, 0.4}) EXPECT_LT(damping_over_limit<Dim>(form, jittered<Dim>(part)), 1) << part;
    EXPECT_LT(damping_over_limit<Dim>(form, paired<Dim>()), 1);
  }
}

/// Leap-frog, whose forces take velocities from two steps, is stable up to 1.
TEST(Levels, NoWaveIsDampedFasterThanTheViscousLimitIsFor) {
  expect_damping_within_the_limit<2>();
  expect_damping_within_the_limit<3>();
}

template <int Dim, class Real> auto archived_after(const Scene& scene, int threads) {
  const WithThreads set(threads);
  auto s = state_of<Dim, Real>(scene, falling_block(scene), floor<Dim>());
  for (int k = 0; k < 8; ++k) step(s);
  EXPECT_GT(s.levels.stages, 0);
  return archived(s);
}

TYPED_TEST(LevelsOf, GiveTheSameBitsForAnyNumberOfThreads) {
  MOLTEN_FLAVOUR;
  for (const auto integrator : {IntegratorKind::leap_frog, IntegratorKind::symplectic_euler}) {
    const Scene scene = crusted_scene(Dim, integrator);
    const auto one = archived_after<Dim, Real>(scene, 1);
    EXPECT_TRUE((one == archived_after<Dim, Real>(scene, 2)));
    EXPECT_TRUE((one == archived_after<Dim, Real>(scene, 3)));
  }
}

TYPED_TEST(LevelsOf, SurviveARestartBitForBit) {
  MOLTEN_FLAVOUR;
  for (const auto integrator : {IntegratorKind::leap_frog, IntegratorKind::symplectic_euler}) {
    const Scene scene = crusted_scene(Dim, integrator);
    const Start start = falling_block(scene);
    auto whole = state_of<Dim, Real>(scene, start, floor<Dim>());
    for (int piece = 0; piece < 8; ++piece) {
      auto other = state_of<Dim, Real>(scene, start, floor<Dim>());
      MemoryArchive checkpoint = saved(whole);
      other.archive(checkpoint);
      for (int k = 0; k < 6; ++k) step(whole), step(other);
      ASSERT_TRUE(archived(whole) == archived(other)) << "from step " << 6 * piece;
    }
    EXPECT_GT(whole.levels.stages, 0);
  }
}

}  // namespace
}  // namespace molten::levels_test
