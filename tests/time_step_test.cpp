// The time step and what bounds it, and how well the integrators follow exact solutions.
#include <gtest/gtest.h>

#include <numbers>

#include "core/diagnostics.h"
#include "core/error.h"
#include "core/runge_kutta.h"
#include "tests/particle_sets.h"

namespace molten::time_step_test {
namespace {

using namespace particle_sets;

constexpr double spacing = 0.1, smoothing_length = 1.3 * spacing;

/// The clock after one step of a lattice in a periodic square.
Clock clock_after_a_step(Scene scene, double stop = 1e300) {
  make_periodic(scene, 1.2);
  auto s = state_of<2, double>(scene, cube<2>(12, spacing), spacing);
  s.clock.stop = stop;
  step(s);
  return s.clock;
}

TEST(TimeStep, Sound) {
  const Clock clock = clock_after_a_step(plain_scene(2));
  EXPECT_EQ(clock.limit, Limit::sound);
  EXPECT_NEAR(clock.dt, 0.2 * smoothing_length / 10, 1e-15);
  EXPECT_EQ(clock.time, clock.dt);
}

TEST(TimeStep, SoundCountsTheFastestParticle) {
  const Scene scene = plain_scene(2);
  Start start = start_of(scene, cube<2>(12, spacing), spacing);
  start.velocity[7] = {3, 4, 0};
  auto s = state_of<2, double>(scene, start);
  step(s);
  EXPECT_NEAR(s.clock.dt, 0.2 * smoothing_length / 15, 1e-15);
}

TEST(TimeStep, Viscous) {
  Scene scene = plain_scene(2);
  scene.fluid.rheology.viscosity = 1e4;
  const Clock clock = clock_after_a_step(scene);
  EXPECT_EQ(clock.limit, Limit::viscous);
  EXPECT_NEAR(clock.dt, 0.1 * smoothing_length * smoothing_length * 1000 / 1e4, 1e-15);
}

TEST(TimeStep, ViscousOfTheTrueViscosity) {
  Scene scene = plain_scene(2);
  scene.fluid.rheology.model = Rheology::Model::smd;
  scene.fluid.rheology.jump_number = {150, 150};
  scene.fluid.rheology.yield_stress = 60;
  scene.fluid.rheology.consistency = 20;
  const Clock clock = clock_after_a_step(scene);
  const double eta0 = 151 * 60 / 9.0;  // at rest
  EXPECT_EQ(clock.limit, Limit::viscous);
  const double courant = 0.1 * 2 / 3;  // see step.cpp
  EXPECT_NEAR(clock.dt, courant * smoothing_length * smoothing_length * 1000 / eta0, 1e-12);
}

TEST(TimeStep, Force) {
  Scene scene = plain_scene(2);
  scene.gravity = {0, -1e5, 0};
  const Clock clock = clock_after_a_step(scene);
  EXPECT_EQ(clock.limit, Limit::force);
  EXPECT_NEAR(clock.dt, 0.25 * std::sqrt(smoothing_length / 1e5), 1e-12);
}

TEST(TimeStep, Conduction) {
  Scene scene = plain_scene(2);
  scene.fluid.heat = Heat{10, std::nullopt, 20, 20};
  const Clock clock = clock_after_a_step(scene);
  EXPECT_EQ(clock.limit, Limit::conduction);
  EXPECT_NEAR(clock.dt, 0.4 * smoothing_length * smoothing_length / (2 * 3.5 * 10), 1e-15);
}

TEST(TimeStep, DensityDiffusion) {
  Scene scene = plain_scene(2);
  scene.numerics.density_diffusion = 0.5;
  const Clock clock = clock_after_a_step(scene);
  EXPECT_EQ(clock.limit, Limit::density_diffusion);
  EXPECT_NEAR(clock.dt, 0.4 * smoothing_length / (2 * 3.5 * 0.5 * 10), 1e-15);

  scene.numerics.integrator = IntegratorKind::symplectic_euler;
  EXPECT_NEAR(clock_after_a_step(scene).dt, 0.64 * clock.dt, 1e-15);
}

TEST(TimeStep, Fixed) {
  Scene scene = plain_scene(2);
  scene.numerics.fixed_dt = 1e-4;
  const Clock clock = clock_after_a_step(scene);
  EXPECT_EQ(clock.limit, Limit::fixed);
  EXPECT_EQ(clock.dt, 1e-4);
}

TEST(TimeStep, Output) {
  const Clock clock = clock_after_a_step(plain_scene(2), 1e-3);
  EXPECT_EQ(clock.limit, Limit::output);
  EXPECT_EQ(clock.dt, 1e-3);
  EXPECT_EQ(clock.time, 1e-3);
}

TEST(TimeStep, LandsOnEveryStopWithoutSlivers) {
  for (const bool fixed : {false, true}) {
    Scene scene = plain_scene(2);
    make_periodic(scene, 1.2);
    if (fixed) scene.numerics.fixed_dt = 0.0026;
    auto s = state_of<2, float>(scene, cube<2>(12, spacing), spacing);
    for (int frame = 1; frame <= 60; ++frame) {
      s.clock.stop = frame / 60.0;
      int steps = 0;
      while (s.clock.time < s.clock.stop) {
        step(s);
        ASSERT_LE(s.clock.time, s.clock.stop);
        EXPECT_GT(s.clock.dt, 0.0026 / 2.01) << "no sliver before a frame";
        ++steps;
      }
      EXPECT_EQ(s.clock.time, frame / 60.0);
      EXPECT_LE(steps, 8);
    }
  }
}

// ---- free fall ------------------------------------------------------------------------------------------------------

/// One falling particle, 5 m/s upwards at first.
template <class Real> State<3, Real> falling(IntegratorKind integrator, std::optional<double> fixed_dt) {
  Scene scene = plain_scene(3);
  scene.gravity = {0, 0, -9.81};
  scene.numerics.integrator = integrator;
  scene.numerics.fixed_dt = fixed_dt;
  scene.domain = Box{{-100, -100, -100}, {100, 100, 100}};
  Start start = start_of(scene, {{0, 0, 0}}, spacing);
  start.velocity[0] = {1, 0, 5};
  return state_of<3, Real>(scene, start);
}

/// Its height's error (m) against v0 t + ½ g t².
template <class Real> double height_error(const State<3, Real>& s) {
  const double t = s.clock.time;
  return s.particles[position][2][0] - (5 * t - 9.81 / 2 * t * t);
}

template <class Real> double leap_frog_error() {
  auto s = falling<Real>(IntegratorKind::leap_frog, std::nullopt);
  for (int frame = 1; frame <= 20; ++frame)  // whose times cut the steps to unequal lengths
    for (s.clock.stop = 0.05 * frame; s.clock.time < s.clock.stop;) step(s);
  return height_error(s);
}

TEST(TimeStep, LeapFrogFallsOnTheParabola) {
  EXPECT_NEAR(leap_frog_error<double>(), 0, 1e-12);
  EXPECT_NEAR(leap_frog_error<float>(), 0, 2e-5);  // 400 roundings of a float velocity
}

TEST(TimeStep, SymplecticEulerFallsByItsFirstOrder) {
  // x = x0 + v0 t + ½ g t (t + dt): behind by ½ g t dt.
  for (const double dt : {0.01, 0.005}) {
    auto s = falling<double>(IntegratorKind::symplectic_euler, dt);
    for (int k = 0; k < 100; ++k) step(s);
    EXPECT_NEAR(height_error(s), -9.81 / 2 * s.clock.time * dt, 1e-10);
  }
}

TEST(TimeStep, AFixedStepThatDividesTheFramesStaysWhole) {
  // 0.01 + 0.01 + … misses 0.05 by round-off; that must not cost a step in two halves.
  auto s = falling<double>(IntegratorKind::leap_frog, 0.01);
  for (int frame = 1; frame <= 20; ++frame)
    for (s.clock.stop = 0.05 * frame; s.clock.time < s.clock.stop;) step(s);
  EXPECT_EQ(s.clock.step, 100);
}

// ---- two particles on their pressure as a spring -------------------------------------------------------------------

constexpr double pair_distance = 1.2 * spacing, pair_speed = 0.05, pair_time = 0.1;

/// Distance (m) of two particles that set out towards each other, by the run.
double distance_by_run(IntegratorKind integrator, double dt) {
  Scene scene = plain_scene(2);
  scene.numerics.state_equation = StateEquation::linear;
  scene.numerics.integrator = integrator;
  scene.numerics.fixed_dt = dt;
  scene.domain = Box{{-1, -1, 0}, {1, 1, 0}};
  Start start = start_of(scene, {{0, 0, 0}, {pair_distance, 0, 0}}, spacing);
  start.velocity = {{pair_speed / 2, 0, 0}, {-pair_speed / 2, 0, 0}};
  auto s = state_of<2, double>(scene, start);
  for (s.clock.stop = pair_time; s.clock.time < s.clock.stop;) step(s);
  return std::abs(s.particles[position][0][0] - s.particles[position][0][1]);
}

/// The same by Runge-Kutta 4 on r'' = −4 m p/ρ² W'(r), with ρ = ρ0 + m (W(r) − W(r0)).
double distance_by_runge_kutta() {
  const double mass = 1000 * spacing * spacing;
  const auto kernel = [&](double r) {
    return with_kernel<double>(KernelKind::wendland_c2, 2, smoothing_length, mass, [&](const auto& k) {
      const auto v = k(Lanes<double, 1>(r));
      return std::pair{v.w.v, v.slope.v * r};
    });
  };
  const double w0 = kernel(pair_distance).first;
  const auto pull = [&](double r) {
    const auto [w, slope] = kernel(r);
    const double density = 1000 + w - w0;
    return -4 * 100 * (w - w0) / (density * density) * slope;
  };
  double r = pair_distance, v = -pair_speed;
  constexpr int steps = 20000;
  const double dt = pair_time / steps;
  for (int k = 0; k < steps; ++k) {
    const double a1 = pull(r), v2 = v + dt / 2 * a1, a2 = pull(r + dt / 2 * v), v3 = v + dt / 2 * a2;
    const double a3 = pull(r + dt / 2 * v2), v4 = v + dt * a3, a4 = pull(r + dt * v3);
    r += dt / 6 * (v + 2 * v2 + 2 * v3 + v4);
    v += dt / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  return r;
}

TEST(TimeStep, OrdersOfTheIntegrators) {
  const double exact = distance_by_runge_kutta();
  const auto order = [&](IntegratorKind integrator, double dt) {
    const double coarse = distance_by_run(integrator, dt) - exact, fine = distance_by_run(integrator, dt / 4) - exact;
    EXPECT_LT(std::abs(coarse), 1e-4 * spacing);
    return std::log2(std::abs(coarse / fine)) / 2;
  };
  EXPECT_NEAR(order(IntegratorKind::leap_frog, 1e-3), 2, 0.1);
  EXPECT_NEAR(order(IntegratorKind::midpoint, 1e-3), 2, 0.1);
  EXPECT_NEAR(order(IntegratorKind::predictor_corrector, 1e-3), 2, 0.1);
  EXPECT_NEAR(order(IntegratorKind::runge_kutta_4, 4e-3), 4, 0.2);
  EXPECT_NEAR(order(IntegratorKind::explicit_euler, 6.25e-5), 1, 0.1);
  // Its first-order part shows at smaller steps only.
  EXPECT_NEAR(order(IntegratorKind::symplectic_euler, 6.25e-5), 1, 0.2);
}

// ---- an oscillator --------------------------------------------------------------------------------------------------

/// One particle on a spring of angular frequency 1 after two thirds of a period, driven step by step: distance (m) from
/// where it should be.
double oscillator_error(IntegratorKind integrator, int steps) {
  Scene scene = plain_scene(2);
  scene.numerics.integrator = integrator;
  scene.domain = Box{{-9, -9, 0}, {9, 9, 0}};
  auto s = state_of<2, double>(scene, {{1, 0, 0}}, spacing);
  const auto pull = [&] {
    if (s.neighbours.is_due()) sort_and_list(s);
    for (int d = 0; d < 2; ++d) s.particles[acceleration][d][0] = -s.particles[position][d][0];
  };
  const double time = 2 * std::numbers::pi * 2 / 3;
  for (; s.clock.step < steps; ++s.clock.step) {
    if (!s.features.reuses_rates() || s.clock.step == 0) pull();
    s.clock.previous_dt = s.clock.dt;
    s.clock.dt = time / steps;
    for (int stage = 1; stage < s.features.stages(); ++stage) go_to_stage(s, stage), pull();
    integrate_and_collide(s);
  }
  return std::abs(s.particles[position][0][0] - std::cos(time));
}

TEST(TimeStep, OrdersOfTheIntegratorsOnAnOscillator) {
  const std::pair<IntegratorKind, int> orders[] = {
      {IntegratorKind::explicit_euler, 1}, {IntegratorKind::symplectic_euler, 1},
      {IntegratorKind::midpoint, 2},       {IntegratorKind::leap_frog, 2},
      {IntegratorKind::runge_kutta_4, 4},  {IntegratorKind::predictor_corrector, 2}};
  for (const auto& [integrator, order] : orders) {
    const double coarse = oscillator_error(integrator, 400), fine = oscillator_error(integrator, 800);
    EXPECT_NEAR(std::log2(coarse / fine), order, 0.03) << name_of(integrator);
  }
}

TEST(TimeStep, RungeKuttaMethodsFallOnTheParabola) {
  for (const auto integrator :
       {IntegratorKind::midpoint, IntegratorKind::predictor_corrector, IntegratorKind::runge_kutta_4}) {
    auto s = falling<double>(integrator, 0.01);
    for (int k = 0; k < 100; ++k) step(s);
    EXPECT_NEAR(height_error(s), 0, 1e-12) << name_of(integrator);
  }
}

// ---- runs that blow up ----------------------------------------------------------------------------------------------

TEST(TimeStep, AStageThatBlowsUpIsCaughtAtOnce) {
  // Half a step presses the lattice until the pressure is beyond the numbers.
  for (const auto integrator : {IntegratorKind::midpoint, IntegratorKind::runge_kutta_4}) {
    Scene scene = plain_scene(2);
    scene.numerics.integrator = integrator;
    scene.numerics.fixed_dt = 1e10;
    scene.numerics.gamma = 50;
    scene.domain = Box{{-1e12, -1e12, 0}, {1e12, 1e12, 0}};
    Start start = start_of(scene, cube<2>(8, spacing), spacing);
    for (std::size_t k = 0; k < start.position.size(); ++k)
      for (int d = 0; d < 2; ++d) start.velocity[k][d] = -1e-3 * (start.position[k][d] - 4 * spacing);
    auto s = state_of<2, float>(scene, start);
    try {
      step(s);
      ADD_FAILURE() << "taken by " << name_of(integrator);
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ExitCode::diverged);
      EXPECT_NE(std::string(e.what()).find("particle "), std::string::npos) << e.what();
      EXPECT_EQ(s.clock.step, 0);
    }
  }
}

// ---- a standing wave ------------------------------------------------------------------------------------------------

/// Kinetic and elastic energy per mass of small motions, J/kg: Σ (v² + c² δ²)/2.
template <class Real> double wave_energy(const State<2, Real>& s) {
  double sum = 0;
  for_each_particle(s.particles, [&](std::size_t k, const auto&) {
    for (int d = 0; d < 2; ++d) sum += std::pow(s.particles[velocity][d][k], 2) / 2;
    sum += 100 * std::pow(s.particles[compression][0][k], 2) / 2;
  });
  return sum / s.particles.count();
}

/// Energy after 2000 steps over that at the start, for a wave of `length` spacings in a periodic box.
template <class Real> double energy_kept(IntegratorKind integrator, int length, double artificial_viscosity) {
  Scene scene = plain_scene(2);
  scene.domain = Box{{0, 0, 0}, {32 * spacing, 8 * spacing, 0}};
  scene.periodic = {true, true, false};
  scene.numerics.state_equation = StateEquation::linear;
  scene.numerics.integrator = integrator;
  scene.numerics.artificial_viscosity = artificial_viscosity;
  Start start = start_of(scene, lattice({32, 8}, spacing), spacing);
  for (std::size_t k = 0; k < start.position.size(); ++k)
    start.velocity[k][0] = 1e-3 * std::sin(2 * std::numbers::pi * start.position[k][0] / (length * spacing));
  auto s = state_of<2, Real>(scene, start);
  const double before = wave_energy(s);
  for (int k = 0; k < 2000; ++k) step(s);
  return wave_energy(s) / before;
}

class StandingWave : public testing::TestWithParam<IntegratorKind> {};
INSTANTIATE_TEST_SUITE_P(Integrators, StandingWave,
                         testing::Values(IntegratorKind::leap_frog, IntegratorKind::symplectic_euler));

TEST_P(StandingWave, ResolvedKeepsItsEnergy) {
  // Without any viscosity; 2000 steps are 12 periods. Leap-frog keeps 1.008 of it, symplectic Euler 1.029.
  const double kept = energy_kept<double>(GetParam(), 32, 0);
  EXPECT_LT(kept, 1.05);
  EXPECT_GT(kept, 0.95);
}

TEST_P(StandingWave, ArtificialViscosityDampsEveryLength) {
  for (const int length : {32, 16, 8, 4}) EXPECT_LT(energy_kept<double>(GetParam(), length, 0.1), 0.7) << length;
}

TEST_P(StandingWave, NoLengthGrows) {
  for (const int length : {16, 8, 4}) EXPECT_LT(energy_kept<double>(GetParam(), length, 0), 1.05) << length;
}

}  // namespace
}  // namespace molten::time_step_test
