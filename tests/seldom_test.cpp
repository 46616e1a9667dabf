// Terms that few scenes ask for, each against a naive sum in double, and what they conserve.
#include <gtest/gtest.h>

#include <functional>
#include <numbers>

#include "core/diagnostics.h"
#include "core/physics/muller_viscosity.h"
#include "tests/particle_sets.h"

namespace molten::seldom_test {
namespace {

using namespace particle_sets;

constexpr double spacing = 0.1;

/// A jittered block, everything about it at random.
template <int Dim, class Real> State<Dim, Real> random_block(const Scene& scene) {
  auto s = state_of<Dim, Real>(scene, cube<Dim>(Dim == 2 ? 14 : 8, spacing, 0.2), spacing);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> of(-1, 1);
  for_each_particle(s.particles, [&](std::size_t k, const auto&) {
    for (int d = 0; d < Dim; ++d) s.particles[velocity][d][k] = Real(of(random));
    for (int d = 0; d < Dim && s.particles.has(half_velocity); ++d)
      s.particles[half_velocity][d][k] = s.particles[velocity][d][k];
    s.particles[compression][0][k] = Real(0.05 * of(random));
    if (s.particles.has(temperature)) s.particles[temperature][0][k] = 20 + 10 * of(random);
  });
  prepare(s);
  return s;
}

using Triple = std::array<double, 3>;

/// What the scene's rates have more than those of `without`, particle by particle, less Σ of(pair) by brute force; the
/// largest of it relative to the largest sum.
template <int Dim, class Real, class F> double worst_difference(const Scene& with, const Scene& without, F&& of) {
  auto s = random_block<Dim, Real>(with), plain = random_block<Dim, Real>(without);
  find_rates(s);
  find_rates(plain);
  std::vector<Triple> naive(s.particles.slots());
  for_each_pair(s, [&](const NaivePair& p) {
    const Triple a = of(s, p);
    for (int d = 0; d < Dim; ++d) naive[p.i][d] += a[d];
  });
  double worst = 0, largest = 0;
  for_each_particle(s.particles, [&](std::size_t k, const auto&) {
    for (int d = 0; d < Dim; ++d) {
      const double more = double(s.particles[acceleration][d][k]) - plain.particles[acceleration][d][k];
      worst = std::max(worst, std::abs(more - naive[k][d]));
      largest = std::max({largest, std::abs(naive[k][d]), std::abs(double(plain.particles[acceleration][d][k]))});
    }
  });
  EXPECT_GT(largest, 0);
  return worst / largest;
}

template <class F> class SeldomOf : public testing::Test {};
TYPED_TEST_SUITE(SeldomOf, Flavours, FlavourNames);

/// Round-off of such sums.
template <class Real> constexpr double digits = sizeof(Real) == 4 ? 2e-5 : 1e-10;

TYPED_TEST(SeldomOf, TensileCorrectionIsMonaghans) {
  MOLTEN_FLAVOUR;
  Scene with = plain_scene(Dim);
  with.numerics.tensile_correction = true;
  const double difference = worst_difference<Dim, Real>(with, plain_scene(Dim), [](const auto& s, const NaivePair& p) {
    const double at_spacing = kernel_at(s.parameters, spacing).mW;
    double R = 0;
    for (const std::size_t k : {p.i, p.j}) {
      const double term = s.particles[pressure_term][0][k];
      R += term > 0 ? 0.01 * term : 0.2 * -term;
    }
    const double f = p.mW / at_spacing, force = -R * std::pow(f, 4) * p.mF;
    return Triple{force * p.x[0], force * p.x[1], force * p.x[2]};
  });
  EXPECT_LT(difference, digits<Real>);
}

TYPED_TEST(SeldomOf, MullerViscosityIsTheSumOverItsKernel) {
  MOLTEN_FLAVOUR;
  Scene with = plain_scene(Dim);
  with.fluid.rheology.viscosity = 20;
  with.numerics.viscosity_form = ViscosityForm::muller;
  const double difference = worst_difference<Dim, Real>(with, plain_scene(Dim), [](const auto& s, const NaivePair& p) {
    const auto& q = s.parameters;
    const double pi = std::numbers::pi, h = q.support_radius;
    const double laplacian =
        Dim == 2 ? 40 * (1 - p.r / h) / (pi * std::pow(h, 4)) : 45 * (1 - p.r / h) / (pi * std::pow(h, 5));
    const double rho_i = 1000 * (1 + s.particles[compression][0][p.i]),
                 rho_j = 1000 * (1 + s.particles[compression][0][p.j]);
    Triple a{};
    for (int d = 0; d < Dim; ++d)
      a[d] = 20 * q.particle_mass / (rho_i * rho_j) * laplacian *
             (double(s.particles[velocity][d][p.j]) - s.particles[velocity][d][p.i]);
    return a;
  });
  EXPECT_LT(difference, digits<Real>);
}

TYPED_TEST(SeldomOf, HalfPressureIsQueirozs) {
  MOLTEN_FLAVOUR;
  Scene with = plain_scene(Dim), without = plain_scene(Dim);
  with.numerics.half_pressure = true;
  const double difference = worst_difference<Dim, Real>(with, without, [](const auto& s, const NaivePair& p) {
    double rho[2], pressure[2];
    int n = 0;
    for (const std::size_t k : {p.i, p.j}) {
      rho[n] = 1000 * (1 + s.particles[compression][0][k]);
      pressure[n++] = s.parameters.eos.pressure(s.particles[compression][0][k]);
    }
    const double half = -(pressure[0] + pressure[1]) / (2 * rho[0] * rho[1]);
    const double whole = -(pressure[0] / (rho[0] * rho[0]) + pressure[1] / (rho[1] * rho[1]));
    return Triple{(half - whole) * p.mF * p.x[0], (half - whole) * p.mF * p.x[1], (half - whole) * p.mF * p.x[2]};
  });
  EXPECT_LT(difference, digits<Real>);
}

TYPED_TEST(SeldomOf, ParticleSoundSpeedsAreTaits) {
  // Against the constant one: the pair's viscosity is as (c_i³ + c_j³)/2 with c_i = 1 + δ_i.
  MOLTEN_FLAVOUR;
  Scene with = plain_scene(Dim);
  with.numerics.artificial_viscosity = 0.3;
  Scene without = with;
  with.numerics.particle_sound_speed = true;
  const double difference = worst_difference<Dim, Real>(with, without, [](const auto& s, const NaivePair& p) {
    const auto& q = s.parameters;
    const double c_i = 1 + s.particles[compression][0][p.i], c_j = 1 + s.particles[compression][0][p.j];
    double approach = 0;
    for (int d = 0; d < Dim; ++d)
      approach += (double(s.particles[velocity][d][p.i]) - s.particles[velocity][d][p.j]) * p.x[d];
    const double h = q.smoothing_length, mu = h * std::min(approach, 0.0) / (p.r * p.r + 0.01 * h * h);
    const double more = (std::pow(c_i, 3) + std::pow(c_j, 3)) / 2 - 1;
    const double force = 0.3 * 10 * more * mu / (1000 * (c_i + c_j) / 2) * p.mF;
    return Triple{force * p.x[0], force * p.x[1], force * p.x[2]};
  });
  EXPECT_LT(difference, digits<Real>);
}

TYPED_TEST(SeldomOf, TheSeldomPassHasWhatTheOthersHave) {
  // Internal energy changes no motion: all other rates stay, with and without corrected gradients.
  MOLTEN_FLAVOUR;
  for (const bool corrected : {false, true}) {
    Scene without = plain_scene(Dim);
    without.fluid.rheology.viscosity = 10;
    without.fluid.heat = Heat{0.01, std::nullopt, 20, 20};
    without.numerics.artificial_viscosity = 0.2;
    without.numerics.xsph = Xsph{};
    without.numerics.gradient_correction = corrected;
    if (corrected) without.numerics.shifting = Shifting{};
    Scene with = without;
    with.numerics.internal_energy = true;
    auto a = random_block<Dim, Real>(with), b = random_block<Dim, Real>(without);
    find_all_rates(a);
    find_all_rates(b);
    for_each_particle(a.particles, [&](std::size_t k, const auto&) {
      for (int d = 0; d < Dim; ++d) {
        EXPECT_NEAR(a.particles[acceleration][d][k], b.particles[acceleration][d][k], 50 * digits<Real>);
        EXPECT_NEAR(a.particles[xsph_velocity][d][k], b.particles[xsph_velocity][d][k], digits<Real>);
      }
      EXPECT_NEAR(a.particles[compression_rate][0][k], b.particles[compression_rate][0][k], 100 * digits<Real>);
      EXPECT_NEAR(a.particles[temperature_rate][0][k], b.particles[temperature_rate][0][k], 50 * digits<Real>);
    });
  }
}

TYPED_TEST(SeldomOf, InternalEnergyTakesUpAllWorkToRoundOff) {
  // Σ m (v·a + e') = 0, whatever the forces.
  MOLTEN_FLAVOUR;
  for (int which = 0; which < 4; ++which) {
    Scene scene = plain_scene(Dim);
    scene.numerics.internal_energy = true;
    scene.numerics.artificial_viscosity = 0.2;
    if (which == 1) scene.fluid.rheology.viscosity = 10;
    if (which == 2) scene.fluid.rheology.model = Rheology::Model::smd;
    if (which == 3) scene.numerics.tensile_correction = true;
    auto s = random_block<Dim, Real>(scene);
    find_all_rates(s);
    double sum = 0, sizes = 0;
    for_each_particle(s.particles, [&](std::size_t k, const auto&) {
      double power = s.particles[internal_energy_rate][0][k];
      for (int d = 0; d < Dim; ++d) power += double(s.particles[velocity][d][k]) * s.particles[acceleration][d][k];
      sum += power;
      sizes += std::abs(s.particles[internal_energy_rate][0][k]);
    });
    EXPECT_LT(std::abs(sum), sizes * (std::is_same_v<Real, float> ? 2e-6 : 1e-14)) << which;
  }
}

TYPED_TEST(SeldomOf, EnergyIsKeptThroughARun) {
  // Kinetic and internal energy of a free block that collides with itself; leap-frog and Runge-Kutta.
  MOLTEN_FLAVOUR;
  for (const auto integrator : {IntegratorKind::leap_frog, IntegratorKind::runge_kutta_4}) {
    Scene scene = plain_scene(Dim);
    scene.numerics.internal_energy = true;
    scene.numerics.artificial_viscosity = 0.5;
    scene.numerics.integrator = integrator;
    const bool leap_frog = integrator == IntegratorKind::leap_frog;  // whose error is of order 2
    if (leap_frog) scene.numerics.courant_sound = 0.05;
    auto s = random_block<Dim, Real>(scene);
    const double before = diagnose(s).kinetic_energy;
    for (int k = 0; k < (leap_frog ? 240 : 60); ++k) step(s);
    const Diagnostics after = diagnose(s);
    EXPECT_LT(after.kinetic_energy, 0.5 * before) << "so that there is much to take up";
    EXPECT_NEAR((after.kinetic_energy + after.internal_energy) / before, 1, leap_frog ? 0.005 : 1e-3);
  }
}

}  // namespace
}  // namespace molten::seldom_test
