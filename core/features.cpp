#include "core/features.h"

#include <algorithm>

#include "core/runge_kutta.h"

namespace molten {

namespace {

/// Single precision holds conductivities over the scene's, and resistances, that far apart.
void require_sensible_conduction(const Scene& scene) {
  constexpr double furthest = 1e12;
  for (std::size_t k = 0; scene.fluid.heat && k < scene.fluid.bodies.size(); ++k) {
    const double ratio =
        scene.fluid.bodies[k].diffusivity.value_or(scene.fluid.heat->diffusivity) / scene.fluid.heat->diffusivity;
    if (!(ratio <= furthest && ratio >= 1 / furthest))
      refuse(scene, "fluid.body." + std::to_string(k) + ".diffusivity",
             "is further than a factor of 10^12 from that of [fluid.heat]; bring them closer");
  }
}

void require_sensible_fluid(const Scene& scene) {
  const Rheology& r = scene.fluid.rheology;
  const bool smd = r.model == Rheology::Model::smd;
  const bool melts = scene.fluid.heat && scene.fluid.heat->melting_range;
  if (smd && r.jump_number[0] != r.jump_number[1] && !melts)
    refuse(scene, "fluid.rheology.jump_number",
           "differs between hot and cold, but nothing melts; add melting_range to [fluid.heat] or give one value");
  if (melts && !smd)
    refuse(scene, "fluid.heat.melting_range",
           "acts on the jump_number of model \"smd\" alone; leave it out or use that model");
  if (r.thermal && !scene.fluid.heat)
    refuse(scene, "fluid.rheology", "a viscosity that varies with temperature needs [fluid.heat]; add it");
  for (int d = 0; d < scene.dimensions; ++d)
    if (scene.periodic[d] && !scene.domain)
      refuse(scene, "scene.periodic", "needs the size of the period; add domain = { min, max } to [scene]");
}

/// A density by summation follows from the places alone.
void require_sensible_density(const Scene& scene) {
  const Numerics& n = scene.numerics;
  if (n.density != DensityForm::summation) {
    if (n.density_kernel)
      refuse(scene, "numerics.density_kernel", "is that of density = \"summation\"; add it or leave this out");
    return;
  }
  const auto require_absent = [&](bool there, const char* key, const char* why) {
    if (there) refuse(scene, key, std::string(why) + " density = \"summation\"; leave one of the two out");
  };
  require_absent(n.density_filter.has_value(), "numerics.density_filter", "has nothing to do for");
  require_absent(n.density_diffusion > 0, "numerics.density_diffusion", "acts on the density's rate, not on");
  require_absent(n.wall_support, "numerics.wall_support", "makes up for the density's rate at walls, not for");
  require_absent(scene.fluid.hydrostatic, "fluid.hydrostatic", "sets a density at the start that is lost to");
}

void require_sensible_laplacian(const Scene& scene) {
  const Numerics& n = scene.numerics;
  const std::string key = "numerics.laplacian";
  if (!n.gradient_correction)
    refuse(scene, key, "\"consistent\" needs corrected gradients; add gradient_correction = true to [numerics]");
  if (n.viscosity_form != ViscosityForm::morris)
    refuse(scene, key, "\"consistent\" is one with viscosity_form \"morris\"; leave one of the two out");
  for (const Body& body : scene.fluid.bodies)
    if (body.diffusivity)
      refuse(scene, key, "\"consistent\" takes one diffusivity for all; leave it or the bodies' own out");
  if (n.wall_support && !scene.boundaries.empty())
    refuse(scene, key, "\"consistent\" knows nothing of the support of walls; leave it or wall_support out");
}

void require_sensible_numerics(const Scene& scene) {
  const Numerics& n = scene.numerics;
  if (n.particle_sound_speed && (n.state_equation != StateEquation::tait || n.gamma != 7))
    refuse(scene, "numerics.particle_sound_speed",
           "is that of state_equation \"tait\" with gamma = 7; use them or leave it out");
  if (n.shifting && !n.gradient_correction)
    refuse(scene, "numerics.shifting", "needs corrected gradients; add gradient_correction = true to [numerics]");
  if (n.stress_form == StressForm::pairwise && !scene.fluid.rheology.constant() && !n.gradient_correction)
    refuse(scene, "numerics.stress_form",
           "\"pairwise\" needs corrected gradients; add gradient_correction = true to [numerics]");
  if (n.laplacian == LaplacianForm::consistent) require_sensible_laplacian(scene);
  if (n.internal_energy && n.integrator == IntegratorKind::energy_bounded_euler)
    refuse(scene, "numerics.internal_energy",
           "takes up the work of whole forces, and energy_bounded_euler lets parts of them act; leave it out or choose "
           "another integrator");
}

void require_sensible_sleep(const Scene& scene) {
  const Numerics& n = scene.numerics;
  if (!n.sleep) return;
  const bool two_step = n.integrator == IntegratorKind::leap_frog || n.integrator == IntegratorKind::symplectic_euler;
  if (!two_step || n.density_filter || n.density == DensityForm::summation || n.gradient_correction ||
      n.internal_energy)
    refuse(scene, "numerics.sleep",
           "goes with the integrators leap_frog and symplectic_euler and a density by continuity, without "
           "density_filter, gradient_correction or internal_energy; leave one of the two out");
  if (n.sleep->temperature_rate && !scene.fluid.heat)
    refuse(scene, "numerics.sleep.temperature_rate", "this scene has no [fluid.heat]; leave the key out or add heat");
  for (std::size_t k = 0; k < scene.boundaries.size(); ++k)
    if (scene.boundaries[k].velocity != std::array<double, 3>{})
      refuse(scene, "boundary." + std::to_string(k) + ".velocity",
             "a wall in motion keeps the fluid beside it awake; leave it out, or numerics.sleep");
}

void require_sensible_levels(const Scene& scene) {
  const Numerics& n = scene.numerics;
  if (n.time_step_levels == 0) return;
  if (scene.fluid.rheology.constant())
    refuse(scene, "numerics.time_step_levels",
           "tells regions apart by their viscosity, and here it is the same everywhere; leave it out");
  const bool two_step = n.integrator == IntegratorKind::leap_frog || n.integrator == IntegratorKind::symplectic_euler;
  if (!two_step || n.gradient_correction || n.wall_support || n.internal_energy || n.sleep || n.boundary_particles)
    refuse(scene, "numerics.time_step_levels",
           "goes with the integrators leap_frog and symplectic_euler, without gradient_correction, wall_support, "
           "internal_energy, sleep or boundary_particles; leave one of the two out");
}

void require_sensible_walls(const Scene& scene) {
  const Numerics& n = scene.numerics;
  if (!n.wall_support) return;
  const bool closes = std::find(scene.periodic.begin(), scene.periodic.end(), true) != scene.periodic.end();
  for (std::size_t k = 0; closes && k < scene.boundaries.size(); ++k)
    if (!scene.boundaries[k].shape.plane)
      refuse(scene, "boundary." + std::to_string(k),
             "wall support of a wall that is no plane ends at a periodic axis; take planes, or leave scene.periodic or "
             "numerics.wall_support out");
}

void require_sensible_integrator(const Scene& scene) {
  const IntegratorKind kind = scene.numerics.integrator;
  if (kind == IntegratorKind::leap_frog || kind == IntegratorKind::symplectic_euler) return;
  const bool moves = std::any_of(scene.boundaries.begin(), scene.boundaries.end(),
                                 [](const Boundary& b) { return b.motion || b.body; });
  if (moves || !scene.vents.empty() || !scene.outflows.empty())
    refuse(
        scene, "numerics.integrator",
        std::string(name_of(kind)) + " knows no walls that move, vents or outflow; use leap_frog or symplectic_euler");
}

void require_sensible_boundary_particles(const Scene& scene) {
  const Numerics& n = scene.numerics;
  if (!n.boundary_particles || scene.boundaries.empty()) return;
  const std::string cure = ", or set numerics.boundary_particles = false";
  const bool dynamic = n.boundary_particles->kind == BoundaryParticles::Kind::dynamic;
  for (std::size_t k = 0; k < scene.boundaries.size(); ++k) {
    const Boundary& b = scene.boundaries[k];
    const std::string key = "boundary." + std::to_string(k);
    if (b.shape.plane)
      refuse(scene, key, "a plane has no end to put boundary particles on; take a box or polygon" + cure);
    if (b.body) refuse(scene, key + ".body", "a free body cannot be made of boundary particles; leave it out" + cure);
    if (b.motion && !dynamic)
      refuse(scene, key + ".motion", "repulsive boundary particles stay in place; choose dynamic ones" + cure);
  }
  const auto require_absent = [&](bool there, const char* key) {
    if (there) refuse(scene, key, "does not go together with dynamic boundary particles; leave it out" + cure);
  };
  require_absent(n.wall_support, "numerics.wall_support");
  if (!dynamic) return;
  require_absent(scene.fluid.heat.has_value(), "fluid.heat");
  require_absent(!scene.vents.empty(), "vent");
  require_absent(!scene.outflows.empty(), "outflow");
  require_absent(n.sleep.has_value(), "numerics.sleep");
  require_absent(n.shifting.has_value(), "numerics.shifting");
  require_absent(n.density == DensityForm::summation, "numerics.density");
  require_absent(n.integrator == IntegratorKind::energy_bounded_euler, "numerics.integrator");
}

/// What no rates pass has together.
void require_one_pass(const Scene& scene, const Features& f) {
  if (!f.any_seldom()) return;
  for (const auto& [there, key] : {std::pair{f.wall_support, "numerics.wall_support"},
                                   std::pair{f.density_diffusion, "numerics.density_diffusion"},
                                   std::pair{f.consistent_laplacian, "numerics.laplacian"}})
    if (there)
      refuse(scene, key, "does not go together with the methods kept for replication; leave one of the two out");
}

/// Where there are walls or a surface. A fluid that closes on itself along all axes has no source at its borders.
bool has_border(const Scene& scene) {
  return !scene.boundaries.empty() || std::find(scene.periodic.begin(), scene.periodic.begin() + scene.dimensions,
                                                false) != scene.periodic.begin() + scene.dimensions;
}

}  // namespace

const char* name_of(IntegratorKind kind) {
  switch (kind) {
    case IntegratorKind::leap_frog:
      return "leap-frog";
    case IntegratorKind::symplectic_euler:
      return "symplectic-euler";
    case IntegratorKind::explicit_euler:
      return "explicit-euler";
    case IntegratorKind::midpoint:
      return "midpoint";
    case IntegratorKind::predictor_corrector:
      return "predictor-corrector";
    case IntegratorKind::runge_kutta_4:
      return "runge-kutta-4";
    case IntegratorKind::energy_bounded_euler:
      return "energy-bounded-euler";
  }
  return "";
}

Features features_of(const Scene& scene) {
  require_sensible_fluid(scene);
  require_sensible_conduction(scene);
  require_sensible_density(scene);
  require_sensible_numerics(scene);
  require_sensible_sleep(scene);
  require_sensible_levels(scene);
  require_sensible_walls(scene);
  require_sensible_integrator(scene);
  require_sensible_boundary_particles(scene);
  Features f;
  f.heat = scene.fluid.heat.has_value();
  f.varied_conduction = f.heat && std::any_of(scene.fluid.bodies.begin(), scene.fluid.bodies.end(),
                                              [](const Body& b) { return b.diffusivity.has_value(); });
  f.stress = !scene.fluid.rheology.constant();
  f.smd = scene.fluid.rheology.model == Rheology::Model::smd;
  f.laminar = !f.stress && scene.fluid.rheology.viscosity > 0;
  f.artificial_viscosity = scene.numerics.artificial_viscosity > 0;
  f.xsph = scene.numerics.xsph && scene.numerics.xsph->epsilon > 0;
  f.particle_sound_speed = f.artificial_viscosity && scene.numerics.particle_sound_speed;
  f.tensile_correction = scene.numerics.tensile_correction;
  f.monaghan_viscosity = f.laminar && scene.numerics.viscosity_form == ViscosityForm::monaghan;
  f.muller_viscosity = f.laminar && scene.numerics.viscosity_form == ViscosityForm::muller;
  f.half_pressure = scene.numerics.half_pressure;
  f.internal_energy = scene.numerics.internal_energy;
  f.density_sum = scene.numerics.density == DensityForm::summation;
  f.density_filter = scene.numerics.density_filter.has_value();
  f.gradient_correction = scene.numerics.gradient_correction;
  f.consistent_laplacian = scene.numerics.laplacian == LaplacianForm::consistent && (f.heat || f.laminar);
  f.shifting = scene.numerics.shifting.has_value();
  f.density_coupling = f.shifting && scene.numerics.shifting->coupling > 0 && has_border(scene);
  f.contact = !scene.boundaries.empty();
  f.wall_support = f.contact && scene.numerics.wall_support;
  f.density_diffusion = scene.numerics.density_diffusion > 0;
  f.sleep = scene.numerics.sleep.has_value();
  f.levels = scene.numerics.time_step_levels > 0;
  if (f.contact && scene.numerics.boundary_particles) {
    f.boundary_particles = scene.numerics.boundary_particles->kind == BoundaryParticles::Kind::dynamic;
    f.repulsion = !f.boundary_particles;
  }
  f.bodies = std::any_of(scene.boundaries.begin(), scene.boundaries.end(),
                         [](const Boundary& b) { return b.motion || b.body; });
  f.vents = !scene.vents.empty();
  f.outflow = !scene.outflows.empty();
  f.integrator = scene.numerics.integrator;
  f.pairwise_stress = f.stress && scene.numerics.stress_form == StressForm::pairwise && !f.any_seldom();
  require_one_pass(scene, f);
  return f;
}

int Features::stages() const { return tableau_of(integrator).stages; }

FieldSet Features::columns() const {
  FieldSet s = field_set(
      FieldList<Id, Position, LocalPosition, Velocity, Compression, PressureTerm, Acceleration, CompressionRate>{});
  if (integrator == IntegratorKind::leap_frog)
    s |= field_set(FieldList<HalfVelocity, HalfCompression, PreviousCompressionRate>{});
  if (integrator == IntegratorKind::symplectic_euler)
    s |= field_set(FieldList<PreviousCompressionRate, OlderCompressionRate>{});
  if (integrator == IntegratorKind::energy_bounded_euler) s |= field_set(FieldList<EnergyShare>{});
  if (stages() > 1) s |= field_set(FieldList<BasePosition, BaseVelocity, BaseCompression>{});
  if (stages() > 1 && heat) s |= field_set(FieldList<BaseTemperature>{});
  if (stages() > 2) s |= field_set(FieldList<PositionSlope, VelocitySlope, CompressionSlope>{});
  if (stages() > 2 && heat) s |= field_set(FieldList<TemperatureSlope>{});
  if (heat) s |= field_set(FieldList<Temperature, LocalTemperature, TemperatureRate>{});
  if (varied_conduction) s |= field_set(FieldList<Conductivity, InterfaceDistance, InterfaceResistance>{});
  if (heat_at_walls()) s |= field_set(FieldList<HeatCompletion>{});
  if (stress) s |= field_set(FieldList<Viscosity>{});
  if (stress && !pairwise_stress) s |= field_set(FieldList<Stress>{});
  if (pairwise_stress) s |= field_set(FieldList<StrainRate, Vorticity, Thinning, Inner>{});
  if (xsph) s |= field_set(FieldList<XsphVelocity>{});
  if (internal_energy) s |= field_set(FieldList<InternalEnergy, InternalEnergyRate>{});
  if (density_filter) s |= field_set(FieldList<FilteredCompression>{});
  if (gradient_correction) s |= field_set(FieldList<Correction>{});
  const bool factors = pairwise_stress || (!consistent_laplacian && (heat || laminar));
  if (gradient_correction && factors) s |= field_set(FieldList<LaplacianCorrection>{});
  if (consistent_laplacian) s |= field_set(FieldList<LaplacianTilt, LaplacianBend>{});
  if (shifting) s |= field_set(FieldList<ShiftVelocity>{});
  if (density_coupling) s |= field_set(FieldList<CouplingRate>{});
  if (sleep) s |= field_set(FieldList<RestTime>{});
  if (sleep && heat) s |= field_set(FieldList<HeatRestTime>{});
  if (sleep && heat && stress) s |= field_set(FieldList<RestTemperature>{});
  if (levels) s |= field_set(FieldList<StiffAcceleration, StageChange, EarlierChange>{});
  if (levels && integrator == IntegratorKind::symplectic_euler) s |= field_set(FieldList<StartVelocity>{});
  if (vents) s |= field_set(FieldList<Inlet>{});
  if (boundary_particles) s |= field_set(FieldList<Held>{});
  return s;
}

std::vector<std::string> Features::passes() const {
  std::vector<std::string> p;
  if (density_filter) p.push_back("density filter");
  if (density_sum) p.push_back("density");
  if (gradient_correction) p.push_back("corrections");
  if (sleep) p.push_back("wake and rest");
  if (varied_conduction) p.push_back("interfaces");
  if (twice_at_walls()) p.push_back("walls");
  if (stress) p.push_back("viscosity");
  p.push_back(heat ? "forces and heat" : "forces");
  if (levels) p.push_back("stages");
  p.push_back(contact ? "integrate and collide" : "integrate");
  return p;
}

std::vector<std::string> Features::names() const {
  const std::pair<bool, const char*> all[] = {{heat, "heat"},
                                              {varied_conduction, "varied-conduction"},
                                              {stress, smd ? "smd-viscosity" : "varying-viscosity"},
                                              {laminar, "laminar-viscosity"},
                                              {artificial_viscosity, "artificial-viscosity"},
                                              {xsph, "xsph"},
                                              {particle_sound_speed, "particle-sound-speed"},
                                              {tensile_correction, "tensile-correction"},
                                              {monaghan_viscosity, "monaghan-viscosity"},
                                              {muller_viscosity, "muller-viscosity"},
                                              {pairwise_stress, "pairwise-stress"},
                                              {half_pressure, "half-pressure"},
                                              {internal_energy, "internal-energy"},
                                              {density_sum, "density-summation"},
                                              {density_filter, "density-filter"},
                                              {gradient_correction, "gradient-correction"},
                                              {consistent_laplacian, "consistent-laplacian"},
                                              {shifting, "shifting"},
                                              {density_coupling, "density-coupling"},
                                              {contact, "contact"},
                                              {wall_support, "wall-support"},
                                              {boundary_particles, "dynamic-boundary-particles"},
                                              {repulsion, "repulsive-boundary-particles"},
                                              {bodies, "moving-bodies"},
                                              {vents, "vents"},
                                              {outflow, "outflow"},
                                              {density_diffusion, "density-diffusion"},
                                              {sleep, "sleep"},
                                              {levels, "time-step-levels"}};
  std::vector<std::string> n;
  for (const auto& [on, name] : all)
    if (on) n.emplace_back(name);
  n.emplace_back(name_of(integrator));
  return n;
}

}  // namespace molten
