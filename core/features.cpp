#include "core/features.h"

#include <algorithm>

#include "core/error.h"
#include "core/runge_kutta.h"

namespace molten {

namespace {

[[noreturn]] void refuse(const Scene& scene, const std::string& why) {
  throw Error(ExitCode::usage, scene.file + ": " + why);
}

void require_sense(const Scene& scene) {
  const Rheology& r = scene.fluid.rheology;
  const bool two_jumps = r.model == Rheology::Model::smd && r.jump_number[0] != r.jump_number[1];
  const bool melts = scene.fluid.heat && scene.fluid.heat->melting_range;
  if (two_jumps && !melts)
    refuse(scene,
           "fluid.rheology.jump_number: two values need [fluid.heat] with melting_range; give one value or add them");
  if (melts && r.model != Rheology::Model::smd)
    refuse(scene, "fluid.heat.melting_range: only model = \"smd\" melts; choose it or remove the range");
  if (scene.numerics.particle_sound_speed &&
      (scene.numerics.state_equation != StateEquation::tait || scene.numerics.gamma != 7))
    refuse(scene,
           "numerics.particle_sound_speed: needs state_equation \"tait\" with gamma = 7; use them or leave it out");
  if (scene.numerics.density_kernel && scene.numerics.density != DensityForm::summation)
    refuse(scene, "numerics.density_kernel: is that of a density by summation; choose it or leave it out");
  if (scene.numerics.density_filter && scene.numerics.density == DensityForm::summation)
    refuse(scene, "numerics.density_filter: a density by summation needs no filter; leave one of the two out");
  if (scene.numerics.shifting && !scene.numerics.gradient_correction)
    refuse(scene, "numerics.shifting: needs corrected gradients; add gradient_correction = true to [numerics]");
  if (r.thermal && !scene.fluid.heat)
    refuse(scene, "fluid.rheology: a viscosity that varies with temperature needs [fluid.heat]; add it");
  const Numerics& n = scene.numerics;
  const bool two_step = n.integrator == IntegratorKind::leap_frog || n.integrator == IntegratorKind::symplectic_euler;
  if (n.sleep && (!two_step || n.density_filter || n.density == DensityForm::summation || n.gradient_correction ||
                  n.internal_energy))
    refuse(scene,
           "numerics.sleep: goes with the integrators leap_frog and symplectic_euler and a density by continuity, "
           "without density_filter, gradient_correction or internal_energy; leave one of the two out");
  if (n.sleep && n.sleep->temperature_rate && !scene.fluid.heat)
    refuse(scene, "numerics.sleep.temperature_rate: this scene has no [fluid.heat]; leave the key out or add heat");
  const bool moves = std::any_of(scene.boundaries.begin(), scene.boundaries.end(),
                                 [](const Boundary& b) { return b.motion || b.body; });
  if (!two_step && (moves || !scene.vents.empty() || !scene.outflows.empty()))
    refuse(scene, std::string("numerics.integrator: ") + name_of(n.integrator) +
                      " knows no walls that move, vents or outflow; use leap_frog or symplectic_euler");
  for (int d = 0; d < scene.dimensions; ++d)
    if (scene.periodic[d] && !scene.domain)
      refuse(scene, "scene.periodic: a periodic axis needs scene.domain for its length");
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
  require_sense(scene);
  Features f;
  f.heat = scene.fluid.heat.has_value();
  f.stress = !scene.fluid.rheology.constant();
  f.smd = scene.fluid.rheology.model == Rheology::Model::smd;
  f.laminar = !f.stress && scene.fluid.rheology.viscosity > 0;
  f.artificial_viscosity = scene.numerics.artificial_viscosity > 0;
  f.xsph = scene.numerics.xsph && scene.numerics.xsph->epsilon > 0;
  f.particle_sound_speed = f.artificial_viscosity && scene.numerics.particle_sound_speed;
  f.tensile_correction = scene.numerics.tensile_correction;
  f.muller_viscosity = f.laminar && scene.numerics.muller_viscosity;
  f.half_pressure = scene.numerics.half_pressure;
  f.internal_energy = scene.numerics.internal_energy;
  f.density_sum = scene.numerics.density == DensityForm::summation;
  f.density_filter = scene.numerics.density_filter.has_value();
  f.gradient_correction = scene.numerics.gradient_correction;
  f.shifting = scene.numerics.shifting.has_value();
  f.contact = !scene.boundaries.empty();
  f.wall_support = f.contact && scene.numerics.wall_support;
  f.density_diffusion = scene.numerics.density_diffusion > 0;
  f.sleep = scene.numerics.sleep.has_value();
  f.bodies = std::any_of(scene.boundaries.begin(), scene.boundaries.end(),
                         [](const Boundary& b) { return b.motion || b.body; });
  f.vents = !scene.vents.empty();
  f.outflow = !scene.outflows.empty();
  f.integrator = scene.numerics.integrator;
  if ((f.wall_support || f.density_diffusion) && (f.gradient_correction || f.any_seldom()))
    refuse(scene, std::string("numerics.") + (f.wall_support ? "wall_support" : "density_diffusion") +
                      ": does not go together with gradient_correction or with the methods kept for replication; leave "
                      "one of the two out");
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
  if (stress) s |= field_set(FieldList<Viscosity, Stress>{});
  if (xsph) s |= field_set(FieldList<XsphVelocity>{});
  if (internal_energy) s |= field_set(FieldList<InternalEnergy, InternalEnergyRate>{});
  if (density_filter) s |= field_set(FieldList<FilteredCompression>{});
  if (gradient_correction) s |= field_set(FieldList<Correction>{});
  if (gradient_correction && (heat || laminar)) s |= field_set(FieldList<LaplacianCorrection>{});
  if (shifting) s |= field_set(FieldList<ShiftVelocity>{});
  if (sleep) s |= field_set(FieldList<RestTime>{});
  if (sleep && heat) s |= field_set(FieldList<HeatRestTime>{});
  if (sleep && heat && stress) s |= field_set(FieldList<RestTemperature>{});
  if (vents) s |= field_set(FieldList<Inlet>{});
  return s;
}

std::vector<std::string> Features::passes() const {
  std::vector<std::string> p;
  if (density_filter) p.push_back("density filter");
  if (density_sum) p.push_back("density");
  if (gradient_correction) p.push_back("corrections");
  if (sleep) p.push_back("wake and rest");
  if (stress) p.push_back("viscosity");
  p.push_back(heat ? "forces and heat" : "forces");
  p.push_back(contact ? "integrate and collide" : "integrate");
  return p;
}

std::vector<std::string> Features::names() const {
  std::vector<std::string> n;
  if (heat) n.push_back("heat");
  if (stress) n.push_back(smd ? "smd-viscosity" : "varying-viscosity");
  if (laminar) n.push_back("laminar-viscosity");
  if (artificial_viscosity) n.push_back("artificial-viscosity");
  if (xsph) n.push_back("xsph");
  if (particle_sound_speed) n.push_back("particle-sound-speed");
  if (tensile_correction) n.push_back("tensile-correction");
  if (muller_viscosity) n.push_back("muller-viscosity");
  if (half_pressure) n.push_back("half-pressure");
  if (internal_energy) n.push_back("internal-energy");
  if (density_sum) n.push_back("density-summation");
  if (density_filter) n.push_back("density-filter");
  if (gradient_correction) n.push_back("gradient-correction");
  if (shifting) n.push_back("shifting");
  if (contact) n.push_back("contact");
  if (wall_support) n.push_back("wall-support");
  if (bodies) n.push_back("moving-bodies");
  if (vents) n.push_back("vents");
  if (outflow) n.push_back("outflow");
  if (density_diffusion) n.push_back("density-diffusion");
  if (sleep) n.push_back("sleep");
  n.push_back(name_of(integrator));
  return n;
}

}  // namespace molten
