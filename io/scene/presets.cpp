#include "io/scene/presets.h"

#include <algorithm>
#include <numbers>

namespace molten {
namespace {

/// Paiva 2007 ([P]), chapter 6: pressure linear in density, leap-frog (6.4.3), artificial viscosity near 1 (6-15), XSPH
/// that overwrites the velocity (6-16) and the time step of 6-17: 0.1 of h/(|v| + c), 0.1/8 of h² rho/eta.
/// Not stated there and chosen here: kernel and smoothing length (cubic spline, 1.3 spacings) and epsilon (0.5 of its
/// [0, 1]). [P] has no force and no conduction limit; ours stay.
Numerics paiva() {
  Numerics numerics;
  numerics.preset = "paiva";
  numerics.kernel = KernelKind::cubic_spline;
  numerics.smoothing_ratio = 1.3;
  numerics.integrator = IntegratorKind::leap_frog;
  numerics.state_equation = StateEquation::linear;
  numerics.artificial_viscosity = 1;
  numerics.xsph = Xsph{Xsph::Form::velocity, 0.5};
  numerics.courant_sound = 0.1;
  numerics.courant_viscous = 0.1 / 8;
  return numerics;
}

/// Corrected gradients and shifting: for smooth flows, what gives the least error per run time
/// (tests/physics/taylor_green_test.cpp, scripts/study).
Numerics internal() {
  Numerics numerics;
  numerics.preset = "internal";
  numerics.smoothing_ratio = 1.7;
  numerics.state_equation = StateEquation::linear;
  numerics.artificial_viscosity = 0;
  numerics.stress_form = StressForm::pairwise;
  numerics.gradient_correction = true;
  numerics.shifting.emplace();
  numerics.courant_sound = 0.4;
  return numerics;
}

/// Queiroz 2008 ([Q]), chapters 3 and 4: Müller's kernels (poly6 for density, spiky for pressure, the viscosity
/// kernel), density by summation (4.2), ideal gas (4.7), the force of pressure as printed, which is half of the
/// gradient (4.3), Müller's viscosity (4.5), XSPH with 0.4 on the velocity and neighbours' densities, and the
/// energy-bounded two-step Euler method with its surplus (3.51-3.53). Not stated there and chosen here: the
/// support, 2.6 spacings. XSPH weighs with the spiky kernel here. Steps are fixed in [Q]: give fixed_dt.
Numerics queiroz() {
  Numerics numerics;
  numerics.preset = "queiroz";
  numerics.kernel = KernelKind::spiky;
  numerics.density_kernel = KernelKind::poly6;
  numerics.smoothing_ratio = 2.6;
  numerics.density = DensityForm::summation;
  numerics.state_equation = StateEquation::ideal_gas;
  numerics.half_pressure = true;
  numerics.viscosity_form = ViscosityForm::muller;
  numerics.artificial_viscosity = 0;
  numerics.xsph = Xsph{Xsph::Form::velocity, 0.4, true};
  numerics.integrator = IntegratorKind::energy_bounded_euler;
  return numerics;
}

/// Dias 2017 ([D]), chapters 4 to 6, made with SPHysics 2.2: Wendland kernel with h = 0.92 √2 spacings,
/// predictor-corrector, Tait with γ = 7 and the particles' own sound speeds, XSPH with 0.5 on positions, density
/// filtered every 30 steps (MLS; Shepard by density_filter.kind), Courant number 0.2 for sound and forces, artificial
/// viscosity 0.2 (0.1 to 0.3 there), no tensile correction; walls of dynamic boundary particles, as its numbers of
/// particles show, whose density follows its rate every 15th step.
Numerics dias() {
  Numerics numerics;
  numerics.preset = "dias";
  numerics.kernel = KernelKind::wendland_c2;
  numerics.smoothing_ratio = 0.92 * std::numbers::sqrt2;
  numerics.integrator = IntegratorKind::predictor_corrector;
  numerics.state_equation = StateEquation::tait;
  numerics.gamma = 7;
  numerics.particle_sound_speed = true;
  numerics.artificial_viscosity = 0.2;
  numerics.xsph = Xsph{Xsph::Form::position, 0.5};
  numerics.density_filter = DensityFilter{DensityFilter::Kind::mls, 30};
  numerics.boundary_particles = BoundaryParticles{BoundaryParticles::Kind::dynamic, 15};
  numerics.courant_sound = 0.2;
  numerics.courant_force = 0.2;
  return numerics;
}

/// Smooth flows, by what the scene says of them: nothing falls, the fluid fills its periods, or viscosity holds it
/// together. Else fluid splashes, or it melts and creeps, where short steps of many particles count more.
bool flows_smoothly(const Scene& scene) {
  const bool falls = scene.gravity != std::array<double, 3>{};
  const bool closes = std::find(scene.periodic.begin(), scene.periodic.end(), true) != scene.periodic.end();
  const Rheology& rheology = scene.fluid.rheology;
  return !falls || closes || (rheology.constant() && rheology.viscosity > 0);
}

/// Heat in a body at rest: nothing sets it in motion.
bool only_conducts(const Scene& scene) {
  const bool moves = std::any_of(scene.fluid.bodies.begin(), scene.fluid.bodies.end(),
                                 [](const Body& b) { return b.velocity != std::array<double, 3>{}; });
  return scene.fluid.heat && scene.gravity == std::array<double, 3>{} && !moves && scene.vents.empty();
}

Numerics best_for(const Scene& scene) {
  Numerics numerics;
  if (only_conducts(scene))
    numerics.gradient_correction = true;
  else if (flows_smoothly(scene))
    numerics = internal();
  numerics.preset = "molten";
  return numerics;
}

Numerics basic() {
  Numerics numerics;
  numerics.preset = "basic";
  return numerics;
}

}  // namespace

std::optional<Numerics> find_preset(std::string_view name, const Scene& scene) {
  if (name == "molten") return best_for(scene);
  if (name == "basic") return basic();
  if (name == "internal") return internal();
  if (name == "queiroz") return queiroz();
  if (name == "dias") return dias();
  if (name == "paiva") return paiva();
  return std::nullopt;
}

}  // namespace molten
