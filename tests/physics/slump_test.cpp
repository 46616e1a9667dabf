// A block is left to itself: on a floor it slumps as far as its rheology lets it, no faster than its energy allows, and
// never through the floor; what no force pushes sideways does not move sideways.
#include <fmt/format.h>

#include "tests/physics/case.h"

namespace molten::slump_test {
namespace {

using namespace physics_case;
constexpr double width = 0.4, height = 0.4, spacing = 0.02;
constexpr double gravity = 9.81, density = 1000;

Rheology newtonian(double viscosity) {
  Rheology r;
  r.viscosity = viscosity;
  return r;
}

/// The block weighs 2 kPa at its foot; a yield stress well above that holds it, one well below does not.
Rheology viscoplastic(double yield_stress) {
  Rheology r;
  r.model = Rheology::Model::smd;
  r.jump_number = {1000, 1000};
  r.yield_stress = yield_stress;
  r.consistency = yield_stress / 20;  // γ̇₁ = 400/s
  return r;
}

Scene block(const Rheology& rheology, double slip) {
  Scene scene = plain_scene(2);
  scene.gravity = {0, -gravity, 0};
  scene.fluid.density = density;
  scene.fluid.rheology = rheology;
  scene.numerics.artificial_viscosity = 0.1;
  scene.numerics.courant_viscous = 0.04;
  scene.numerics.sound_speed = 28;
  Boundary floor;
  floor.shape.plane = Plane{{0, 0, 0}, {0, 1, 0}};
  floor.slip = slip;
  scene.boundaries.push_back(floor);
  return scene;
}

Start block_start() {
  Start start = lattice(2, {int(width / spacing), int(height / spacing), 0}, spacing);
  jitter(start, 2, 0.05);
  for (Triple& x : start.position) x[1] += 0.1 * spacing;
  return start;
}

struct Slump {
  double width = 0, height = 0;  // m, at the end
  double energy_gain = -1;       // largest kinetic and potential energy over that of the start, less 1
  double lowest = 1e300;         // m, lowest particle at any time
  double sideways = 0;           // largest momentum along x over that of the block falling its own height
};

/// Momentum along x of the velocities that move the particles.
template <class Real> double sideways_momentum(const State<2, Real>& s) {
  double sum = 0;
  for_each_particle(s, [&](std::size_t slot) { sum += s.particles[half_velocity][0][slot]; });
  return sum * s.parameters.particle_mass;
}

template <class Real> Slump slump(const Scene& scene, double end_time) {
  const OneThread one;
  State<2, Real> s = state_of<2, Real>(scene, block_start());
  Slump found;
  const double start = diagnose(s).potential_energy;
  const double mass = s.parameters.particle_mass * static_cast<double>(s.particles.count());
  while (s.clock.time < end_time) {
    step(s);
    if (s.clock.step % 10 != 0 && s.clock.time < end_time) continue;
    const Diagnostics d = diagnose(s);
    found.energy_gain = std::max(found.energy_gain, (d.kinetic_energy + d.potential_energy) / start - 1);
    found.lowest = std::min(found.lowest, d.lower[1]);
    found.sideways =
        std::max(found.sideways, std::abs(sideways_momentum(s)) / (mass * std::sqrt(2 * gravity * height)));
    found.width = d.upper[0] - d.lower[0] + spacing;
    found.height = d.upper[1] - d.lower[1] + spacing;
  }
  EXPECT_EQ(s.neighbours.dropped(), 0u);
  const std::string text = fmt::format("width {:.4f} height {:.4f} energy {:+.2g} sideways {:.2g} steps {}",
                                       found.width, found.height, found.energy_gain, found.sideways, s.clock.step);
  ::testing::Test::RecordProperty("slump", text);
  return found;
}

/// What holds of every slump. Compressing the fluid stores energy, so what is left can only be less than at the start.
void expect_sound(const Slump& s, double round_off) {
  EXPECT_LT(s.energy_gain, round_off);
  EXPECT_GE(s.lowest, spacing / 2 * (1 - 1e-6));
  EXPECT_LT(s.sideways, 0.02);
}

TEST(Slump, NewtonianSpreadsTheMoreTheThinnerItIs) {
  const Slump thin = slump<double>(block(newtonian(1), 0), 0.3), thick = slump<double>(block(newtonian(200), 0), 0.3);
  expect_sound(thin, 1e-12);
  expect_sound(thick, 1e-12);
  EXPECT_GT(thin.width, 2.5 * width);
  EXPECT_GT(thick.width, 1.4 * width);
  EXPECT_LT(thick.width, 2 * width);
}

TEST(Slump, NewtonianSpreadsTheSameInSinglePrecision) {
  const Slump single = slump<float>(block(newtonian(50), 0), 0.15),
              twice = slump<double>(block(newtonian(50), 0), 0.15);
  expect_sound(single, 1e-7);
  EXPECT_NEAR(single.width / twice.width, 1, 0.02);
  EXPECT_NEAR(single.height / twice.height, 1, 0.02);
}

TEST(Slump, ViscoplasticSpreadsUnderALowYieldStressAndStandsUnderAHighOne) {
  const Slump soft = slump<double>(block(viscoplastic(100), 0), 0.15);
  const Slump stiff = slump<double>(block(viscoplastic(4000), 0), 0.15);
  expect_sound(soft, 1e-12);
  expect_sound(stiff, 1e-12);
  EXPECT_GT(soft.width, 1.15 * width);
  EXPECT_LT(stiff.width, 1.05 * width);
  EXPECT_GT(stiff.height, 0.95 * height);
}

TEST(Slump, NothingPushesItSidewaysOnASlipperyFloor) {
  for (const Rheology& rheology : {newtonian(20), viscoplastic(200)}) {
    const Slump found = slump<double>(block(rheology, 1), 0.3);
    EXPECT_LT(found.sideways, 1e-12);
    EXPECT_LT(found.energy_gain, 1e-12);
  }
}

// Before it meets anything the block falls as one stone, whatever it is made of.
TEST(Slump, FallsAsAStoneInTheAir) {
  const OneThread one;
  for (const Rheology& rheology : {newtonian(20), viscoplastic(200)}) {
    Scene scene = block(rheology, 0);
    scene.boundaries.clear();
    auto s = state_of<2, double>(scene, lattice(2, {20, 20, 0}, spacing));
    const double start = diagnose(s).potential_energy;
    run_until(s, 0.1);
    const Diagnostics d = diagnose(s);
    const double mass = s.parameters.particle_mass * 400;
    EXPECT_NEAR(d.momentum[1], -mass * gravity * 0.1, 1e-9 * mass);
    EXPECT_NEAR(d.momentum[0], 0, 1e-9 * mass);
    EXPECT_NEAR(d.potential_energy - start, -mass * gravity * gravity * 0.01 / 2, 1e-9 * start);
    EXPECT_NEAR(d.kinetic_energy, mass * gravity * gravity * 0.01 / 2, 1e-6 * start);
  }
}

TEST(SlowSlump, AHighYieldStressHoldsForLong) {
  const Slump stiff = slump<double>(block(viscoplastic(20000), 0), 0.5);
  expect_sound(stiff, 1e-12);
  EXPECT_LT(stiff.width, 1.02 * width);
  EXPECT_GT(stiff.height, 0.98 * height);
}

}  // namespace
}  // namespace molten::slump_test
