// Density by summation, and the Shepard and MLS filters: against naive sums, and what each must leave as it is.
#include <gtest/gtest.h>

#include <functional>

#include "core/physics/density_sums.h"
#include "core/runge_kutta.h"
#include "tests/particle_sets.h"

namespace molten::density_test {
namespace {

using namespace particle_sets;

constexpr double spacing = 0.1;
using X = std::array<double, 3>;

Scene filtered_scene(int dim, DensityFilter::Kind kind) {
  Scene scene = plain_scene(dim);
  scene.numerics.density_filter = DensityFilter{kind, 5};
  return scene;
}

/// A free jittered block with a compression.
template <int Dim, class Real>
State<Dim, Real> block(const Scene& scene, const std::function<double(const X&)>& delta) {
  auto s = state_of<Dim, Real>(scene, cube<Dim>(Dim == 2 ? 16 : 9, spacing, 0.2), spacing);
  for_each_particle(s.particles, [&](std::size_t k, const X& x) {
    s.particles[compression][0][k] = Real(delta(x));
    if (s.particles.has(half_compression)) s.particles[half_compression][0][k] = Real(delta(x));
  });
  prepare(s);
  return s;
}

/// Σ m W and Σ m W/(1 + δ_j), the particle itself included.
template <int Dim, class Real> std::vector<std::array<double, 2>> naive_sums(const State<Dim, Real>& s) {
  std::vector<std::array<double, 2>> sums(s.particles.slots());
  const auto add = [&](std::size_t i, std::size_t j, double mW) {
    sums[i][0] += mW;
    sums[i][1] += mW / (1 + s.particles[compression][0][j]);
  };
  const double own = kernel_at(s.parameters, 0).mW;
  for_each_particle(s.particles, [&](std::size_t k, const auto&) { add(k, k, own); });
  for_each_pair(s, [&](const NaivePair& p) { add(p.i, p.j, p.mW); });
  return sums;
}

template <class F> class DensityOf : public testing::Test {};
TYPED_TEST_SUITE(DensityOf, Flavours, FlavourNames);

/// Round-off of such sums.
template <class Real> constexpr double digits = sizeof(Real) == 4 ? 2e-6 : 1e-11;

double wavy(const X& x) { return 0.02 * std::sin(9 * x[0]) + 0.01 * x[1]; }

TYPED_TEST(DensityOf, SummationIsTheNaiveSum) {
  MOLTEN_FLAVOUR;
  Scene scene = plain_scene(Dim);
  scene.numerics.density = DensityForm::summation;
  auto s = block<Dim, Real>(scene, wavy);
  const auto naive = naive_sums(s);
  sum_density(s);
  for_each_particle(s.particles, [&](std::size_t k, const auto&) {
    EXPECT_NEAR(s.particles[compression][0][k], naive[k][0] / 1000 - 1, 10 * digits<Real>);
    EXPECT_NEAR(s.particles[pressure_term][0][k] / s.parameters.eos.term(s.particles[compression][0][k]), 1,
                digits<Real>);
  });
}

TYPED_TEST(DensityOf, SummationHoldsThroughASteppedRun) {
  MOLTEN_FLAVOUR;
  Scene scene = plain_scene(Dim);
  scene.numerics.density = DensityForm::summation;
  for (const auto integrator :
       {IntegratorKind::leap_frog, IntegratorKind::midpoint, IntegratorKind::symplectic_euler}) {
    scene.numerics.integrator = integrator;
    auto s = block<Dim, Real>(scene, wavy);
    for (int k = 0; k < 5; ++k) step(s);
    list_if_due(s);
    sum_density(s);
    std::vector<Real> before(s.particles[compression][0], s.particles[compression][0] + s.particles.slots());
    s.clock.dt = 0;  // a step of no time leaves the sum itself
    find_all_rates(s);
    for (int stage = 1; stage < s.features.stages(); ++stage) go_to_stage(s, stage);
    integrate_and_collide(s);
    for_each_particle(s.particles,
                      [&](std::size_t k, const auto&) { EXPECT_EQ(s.particles[compression][0][k], before[k]); });
  }
}

TYPED_TEST(DensityOf, ShepardIsTheNaiveMean) {
  MOLTEN_FLAVOUR;
  auto s = block<Dim, Real>(filtered_scene(Dim, DensityFilter::Kind::shepard), wavy);
  const auto naive = naive_sums(s);
  filter_density(s);
  for_each_particle(s.particles, [&](std::size_t k, const auto&) {
    EXPECT_NEAR(s.particles[compression][0][k], naive[k][0] / naive[k][1] - 1, 10 * digits<Real>);
  });
}

TYPED_TEST(DensityOf, FiltersLeaveAnEvenDensityAndMlsALinearOne) {
  MOLTEN_FLAVOUR;
  for (const auto kind : {DensityFilter::Kind::shepard, DensityFilter::Kind::mls}) {
    auto even = block<Dim, Real>(filtered_scene(Dim, kind), [](const X&) { return 0.03; });
    filter_density(even);
    for_each_particle(even.particles, [&](std::size_t k, const auto&) {
      EXPECT_NEAR(even.particles[compression][0][k], 0.03, digits<Real>);
    });
    const auto slope = [](const X& x) { return 0.01 + 0.02 * x[0] - 0.03 * x[1]; };
    auto linear = block<Dim, Real>(filtered_scene(Dim, kind), slope);
    filter_density(linear);
    double worst = 0;
    for_each_particle(linear.particles, [&](std::size_t k, const X& x) {
      worst = std::max(worst, std::abs(linear.particles[compression][0][k] - slope(x)));
    });
    if (kind == DensityFilter::Kind::mls) {
      EXPECT_LT(worst, 2 * digits<Real>) << "up to the edges of a disordered block";
    } else {
      EXPECT_GT(worst, 1e-4) << "Shepard flattens the density at edges";
    }
  }
}

TYPED_TEST(DensityOf, FiltersDampNoise) {
  MOLTEN_FLAVOUR;
  for (const auto kind : {DensityFilter::Kind::shepard, DensityFilter::Kind::mls}) {
    std::mt19937 random(3);
    std::normal_distribution<double> noise(0, 0.01);
    auto s = block<Dim, Real>(filtered_scene(Dim, kind), [&](const X&) { return noise(random); });
    const auto spread = [&] {
      double sum = 0;
      for_each_particle(s.particles,
                        [&](std::size_t k, const auto&) { sum += std::pow(s.particles[compression][0][k], 2); });
      return std::sqrt(sum / s.particles.count());
    };
    EXPECT_NEAR(spread(), 0.01, 0.001);
    filter_density(s);
    EXPECT_LT(spread(), 0.005);
  }
}

TYPED_TEST(DensityOf, LonelyParticlesKeepTheirDensity) {
  MOLTEN_FLAVOUR;
  for (const auto kind : {DensityFilter::Kind::shepard, DensityFilter::Kind::mls}) {
    auto s = state_of<Dim, Real>(filtered_scene(Dim, kind), cube<Dim>(2, 1.0), spacing);
    for_each_particle(s.particles,
                      [&](std::size_t k, const auto&) { s.particles[compression][0][k] = Real(0.01 * k); });
    filter_density(s);
    for_each_particle(s.particles, [&](std::size_t k, const auto&) {
      EXPECT_NEAR(s.particles[compression][0][k], 0.01 * k, digits<Real>);
    });
  }
}

TEST(Density, TheFilterWorksEverySoManySteps) {
  // Its pass is timed, so that the timer counts it.
  auto s = block<2, float>(filtered_scene(2, DensityFilter::Kind::shepard), wavy);
  const auto has_filtered = [&] {
    const auto& seconds = s.timer.seconds();
    return std::any_of(seconds.begin(), seconds.end(), [](const auto& p) { return p.first == "density filter"; });
  };
  for (int k = 0; k < 5; ++k) step(s);
  EXPECT_FALSE(has_filtered());
  step(s);
  EXPECT_TRUE(has_filtered());
}

TEST(Density, IdealGas) {
  Scene scene = plain_scene(2);
  scene.numerics.state_equation = StateEquation::ideal_gas;
  scene.numerics.stiffness = 9;
  const auto p = parameters_of<2>(scene, start_of(scene, cube<2>(4, spacing), spacing));
  EXPECT_EQ(p.eos.sound_speed, 3);
  EXPECT_NEAR(p.eos.pressure(0.01), 9 * 10, 1e-10);  // k (ρ − ρ0)
  EXPECT_NEAR(p.eos.compression(90), 0.01, 1e-14);
}

}  // namespace
}  // namespace molten::density_test
