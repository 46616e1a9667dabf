// The energy-bounded two-step Euler method: its α by brute force, its surplus against the sum in sequence, its bound.
#include "core/energy_bound.h"

#include <gtest/gtest.h>

#include "core/diagnostics.h"
#include "tests/particle_sets.h"
#include "tests/with_threads.h"

namespace molten::energy_bound_test {
namespace {

using namespace particle_sets;

TEST(EnergyShare, IsTheLargestThatTheBoundAllows) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> of(-1, 1);
  for (int k = 0; k < 100000; ++k) {
    const double A = std::abs(of(random)), B = 2 * of(random), C = -std::abs(of(random)) * (k % 3 == 0 ? 1e-6 : 1);
    const double share = largest_share(A, B, C);
    const auto bound = [&](double a) { return A * a * a + B * a + C; };
    ASSERT_GE(share, 0);
    ASSERT_LE(share, 1);
    EXPECT_LE(bound(share), 1e-12);
    if (share == 1) continue;
    EXPECT_GT(bound(share + 1e-6 * (1 + share)), 0) << "A " << A << " B " << B << " C " << C;
  }
}

TEST(EnergyShare, WhereTheRootNearestOneIsTheWrongOne) {
  // v = (1, 0, 0), a = (−5, 0, 0), Δt = 1e-3, no gravity: braking loses energy, so all of it may act.
  EXPECT_EQ(largest_share(0.5e-6 * 25, -5e-3, 0), 1);
  EXPECT_EQ(largest_share(0, 0, 0), 1);
  EXPECT_EQ(largest_share(1, 1, 0), 0);
}

Scene bounded_scene(int dim, double dt) {
  Scene scene = plain_scene(dim);
  scene.gravity = dim == 2 ? std::array<double, 3>{0, -9.81, 0} : std::array<double, 3>{0, 0, -9.81};
  scene.numerics.integrator = IntegratorKind::energy_bounded_euler;
  scene.numerics.fixed_dt = dt;
  scene.numerics.density = DensityForm::summation;
  return scene;
}

/// A block that is pressed together, its particles' distances less by a part, and about to burst.
template <int Dim, class Real> State<Dim, Real> pressed(const Scene& scene, double part) {
  const double spacing = 0.1;
  Start start = start_of(scene, cube<Dim>(Dim == 2 ? 40 : 12, spacing, 0.1), spacing);
  for (auto& x : start.position)
    for (int d = 0; d < Dim; ++d) x[d] *= 1 - part;
  auto s = state_of<Dim, Real>(scene, start);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> of(-1, 1);
  for_each_particle(s.particles, [&](std::size_t k, const auto&) {
    for (int d = 0; d < Dim; ++d) s.particles[velocity][d][k] = Real(0.5 * of(random));
  });
  prepare(s);
  return s;
}

template <class F> class EnergyBoundOf : public testing::Test {};
TYPED_TEST_SUITE(EnergyBoundOf, Flavours, FlavourNames);

/// Round-off of an energy or of a share of it.
template <class Real> constexpr double digits = sizeof(Real) == 4 ? 1e-6 : 1e-14;

/// α particle by particle in the order of the slots, the surplus handed on as it is left.
template <int Dim, class Real>
std::vector<double> shares_in_sequence(const State<Dim, Real>& s, double dt, bool hand_on) {
  std::vector<double> shares;
  double surplus = 0;
  for_each_particle(s.particles, [&](std::size_t k, const auto&) {
    double A = 0, B = 0, C = -surplus;
    for (int d = 0; d < Dim; ++d) {
      const double g = s.parameters.gravity[d], a = s.particles[acceleration][d][k] - g;
      A += dt * dt / 2 * a * a, B += dt * a * s.particles[velocity][d][k], C -= dt * dt / 2 * g * g;
    }
    const double share = largest_share(A, B, C);
    shares.push_back(share);
    surplus = hand_on && share == 1 ? -(A + B + C) : 0;
  });
  return shares;
}

TYPED_TEST(EnergyBoundOf, SurplusByBlocksIsThatInSequence) {
  MOLTEN_FLAVOUR;
  for (const bool hand_on : {true, false}) {
    Scene scene = bounded_scene(Dim, 4e-3);
    scene.numerics.energy_surplus = hand_on;
    auto s = pressed<Dim, Real>(scene, 0.02);
    ASSERT_GT(s.particles.slots(), 1024u) << "more than one block";
    find_all_rates(s);
    const auto expected = shares_in_sequence(s, 4e-3, hand_on);
    choose_time_step(s);
    integrate_and_collide(s);
    std::size_t n = 0, bounded = 0;
    for_each_particle(s.particles, [&](std::size_t k, const auto&) {
      EXPECT_NEAR(s.particles[energy_share][0][k], expected[n], 10 * digits<Real>);
      bounded += expected[n++] < 1;
    });
    EXPECT_GT(bounded, n / 20);
    EXPECT_LT(bounded, n * 19 / 20);
  }
}

TYPED_TEST(EnergyBoundOf, EnergyNeverGrows) {
  MOLTEN_FLAVOUR;
  for (const double dt : {4e-3, 2e-2}) {
    auto s = pressed<Dim, Real>(bounded_scene(Dim, dt), 0.02);
    const auto energy = [&] { return diagnose(s).kinetic_energy + diagnose(s).potential_energy; };
    double before = energy();
    for (int k = 0; k < 50; ++k) {
      const double kinetic = diagnose(s).kinetic_energy;
      step(s);
      EXPECT_LE(energy(), before + digits<Real> * (kinetic + std::abs(before))) << "step " << k;
      before = energy();
    }
  }
}

TYPED_TEST(EnergyBoundOf, ShiftingMovesParticlesBesideTheirVelocity) {
  MOLTEN_FLAVOUR;
  const double dt = 1e-3;
  Scene scene = bounded_scene(Dim, dt);
  scene.numerics.gradient_correction = true;
  scene.numerics.shifting = Shifting{};
  scene.numerics.xsph = Xsph{Xsph::Form::position, 0.3};
  auto s = pressed<Dim, Real>(scene, 0.02);
  find_all_rates(s);
  choose_time_step(s);
  const auto x = s.particles[position];
  std::vector<std::array<double, Dim>> before(s.particles.slots());
  for_each_particle(s.particles, [&](std::size_t k, const auto&) {
    for (int d = 0; d < Dim; ++d) before[k][d] = x[d][k];
  });
  integrate_and_collide(s);
  double most = 0;
  for_each_particle(s.particles, [&](std::size_t k, const auto&) {
    for (int d = 0; d < Dim; ++d) {
      const double drift = s.particles[shift_velocity][d][k] + 0.3 * s.particles[xsph_velocity][d][k];
      const double rate = s.particles[velocity][d][k] + drift;
      EXPECT_NEAR(x[d][k] - before[k][d], dt * rate, 1e-6 * dt);
      most = std::max(most, std::abs(double(s.particles[shift_velocity][d][k])));
    }
  });
  EXPECT_GT(most, 1e-3) << "m/s, or it shows nothing";
}

TEST(EnergyShare, OfARunWithoutTheBoundIsOne) {
  auto s = state_of<2, float>(plain_scene(2), cube<2>(60, 0.1), 0.1);
  ASSERT_GT(s.particles.slots(), 3000u) << "more than one block";
  step(s);
  const Diagnostics d = diagnose(s);
  EXPECT_EQ(d.least_energy_share, 1);
  EXPECT_EQ(d.mean_energy_share, 1);
  EXPECT_EQ(d.largest_energy_share, 1);
}

TYPED_TEST(EnergyBoundOf, WithoutTheBoundItWouldGrow) {
  // So that the above is known to see it.
  MOLTEN_FLAVOUR;
  Scene scene = bounded_scene(Dim, 2e-2);
  scene.numerics.integrator = IntegratorKind::explicit_euler;
  auto s = pressed<Dim, Real>(scene, 0.02);
  const double before = diagnose(s).kinetic_energy + diagnose(s).potential_energy;
  for (int k = 0; k < 3; ++k) find_all_rates(s), choose_time_step(s), integrate_and_collide(s);
  EXPECT_GT(diagnose(s).kinetic_energy + diagnose(s).potential_energy, before * 1.1);
}

TYPED_TEST(EnergyBoundOf, SameBitsForAnyThreads) {
  MOLTEN_FLAVOUR;
  const auto run = [&](int threads) {
    const WithThreads set(threads);
    auto s = pressed<Dim, Real>(bounded_scene(Dim, 4e-3), 0.02);
    for (int k = 0; k < 20; ++k) step(s);
    return std::vector<Real>(s.particles[velocity][0], s.particles[velocity][0] + s.particles.slots());
  };
  const auto one = run(1);
  EXPECT_TRUE(one == run(2) && one == run(3));
}

}  // namespace
}  // namespace molten::energy_bound_test
