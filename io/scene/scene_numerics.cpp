#include <fmt/format.h>

#include "core/levels.h"
#include "io/scene/presets.h"
#include "io/scene/scene_sections.h"

namespace molten {
namespace {

const TomlReader::Keys numerics_keys = {"preset",
                                        "precision",
                                        "resort",
                                        "kernel",
                                        "smoothing_ratio",
                                        "skin",
                                        "integrator",
                                        "state_equation",
                                        "gamma",
                                        "sound_speed",
                                        "artificial_viscosity",
                                        "xsph",
                                        "courant",
                                        "fixed_dt",
                                        "time_step_levels",
                                        "gradient_correction",
                                        "laplacian",
                                        "shifting",
                                        "density",
                                        "density_filter",
                                        "particle_sound_speed",
                                        "tensile_correction",
                                        "internal_energy",
                                        "viscosity_form",
                                        "stress_form",
                                        "half_pressure",
                                        "energy_surplus",
                                        "density_kernel",
                                        "stiffness",
                                        "wall_support",
                                        "boundary_particles",
                                        "density_diffusion",
                                        "sleep"};

Numerics read_preset(const TomlReader& keys, const Scene& scene) {
  // What sleeps, and what stands on a wall of particles, knows no corrections or no shifting.
  std::string name = keys.has("sleep") || keys.has("boundary_particles") ? "basic" : "molten";
  keys.choice<std::string>("preset", name,
                           {{"molten", "molten"},
                            {"basic", "basic"},
                            {"internal", "internal"},
                            {"paiva", "paiva"},
                            {"queiroz", "queiroz"},
                            {"dias", "dias"}});
  return *find_preset(name, scene);
}

const std::vector<std::pair<std::string_view, KernelKind>> kernels = {{"gaussian", KernelKind::gaussian},
                                                                      {"quadratic", KernelKind::quadratic},
                                                                      {"cubic_spline", KernelKind::cubic_spline},
                                                                      {"wendland_c2", KernelKind::wendland_c2},
                                                                      {"lucy", KernelKind::lucy},
                                                                      {"poly6", KernelKind::poly6},
                                                                      {"spiky", KernelKind::spiky}};

void read_choices(const TomlReader& keys, Numerics& numerics) {
  keys.choice<Precision>("precision", numerics.precision,
                         {{"single", Precision::single}, {"double", Precision::double_}});
  keys.choice<Resort>("resort", numerics.resort, {{"when_due", Resort::when_due}, {"each_step", Resort::each_step}});
  keys.choice<KernelKind>("kernel", numerics.kernel, kernels);
  if (keys.has("density_kernel")) {
    KernelKind kernel = numerics.kernel;
    keys.choice<KernelKind>("density_kernel", kernel, kernels);
    numerics.density_kernel = kernel;
  }
  keys.choice<IntegratorKind>("integrator", numerics.integrator,
                              {{"leap_frog", IntegratorKind::leap_frog},
                               {"symplectic_euler", IntegratorKind::symplectic_euler},
                               {"explicit_euler", IntegratorKind::explicit_euler},
                               {"midpoint", IntegratorKind::midpoint},
                               {"predictor_corrector", IntegratorKind::predictor_corrector},
                               {"runge_kutta_4", IntegratorKind::runge_kutta_4},
                               {"energy_bounded_euler", IntegratorKind::energy_bounded_euler}});
  keys.choice<StateEquation>(
      "state_equation", numerics.state_equation,
      {{"linear", StateEquation::linear}, {"tait", StateEquation::tait}, {"ideal_gas", StateEquation::ideal_gas}});
  keys.choice<DensityForm>("density", numerics.density,
                           {{"continuity", DensityForm::continuity}, {"summation", DensityForm::summation}});
  // That of a preset goes with its density.
  if (numerics.density != DensityForm::summation && !keys.has("density_kernel")) numerics.density_kernel.reset();
}

void read_xsph(const TomlReader& keys, Numerics& numerics) {
  const toml::node* node = keys.node("xsph");
  if (node == nullptr) return;
  if (node->is_boolean()) {
    if (*node->value<bool>()) keys.fail("xsph", "true says too little; give { form = \"position\", epsilon = 0.5 }");
    numerics.xsph.reset();
    return;
  }
  const TomlReader table = *keys.table("xsph", {"form", "epsilon", "density"});
  Xsph xsph = numerics.xsph.value_or(Xsph{});
  table.choice<Xsph::Form>("form", xsph.form, {{"velocity", Xsph::Form::velocity}, {"position", Xsph::Form::position}});
  table.choice<bool>("density", xsph.neighbour_density, {{"mean", false}, {"neighbour", true}});
  table.number("epsilon", xsph.epsilon, Range{0, 1, false, ""});
  numerics.xsph = xsph;
}

void read_density_filter(const TomlReader& keys, Numerics& numerics) {
  const toml::node* node = keys.node("density_filter");
  if (node == nullptr) return;
  if (node->is_boolean()) {
    if (*node->value<bool>()) keys.fail("density_filter", "true says too little; give { kind = \"mls\", every = 30 }");
    numerics.density_filter.reset();
    return;
  }
  const TomlReader table = *keys.table("density_filter", {"kind", "every"});
  DensityFilter filter = numerics.density_filter.value_or(DensityFilter{});
  table.choice<DensityFilter::Kind>("kind", filter.kind,
                                    {{"shepard", DensityFilter::Kind::shepard}, {"mls", DensityFilter::Kind::mls}});
  table.whole("every", filter.every, 1, 1000000);
  numerics.density_filter = filter;
}

void read_boundary_particles(const TomlReader& keys, Numerics& numerics) {
  const toml::node* node = keys.node("boundary_particles");
  if (node == nullptr) return;
  if (node->is_boolean()) {
    if (*node->value<bool>())
      keys.fail("boundary_particles", "true says too little; give { kind = \"dynamic\" } or { kind = \"repulsive\" }");
    numerics.boundary_particles.reset();
    return;
  }
  using Kind = BoundaryParticles::Kind;
  const TomlReader table = *keys.table("boundary_particles", {"kind", "every"});
  table.require("kind", "give \"dynamic\" or \"repulsive\"");
  BoundaryParticles particles;
  table.choice<Kind>("kind", particles.kind, {{"dynamic", Kind::dynamic}, {"repulsive", Kind::repulsive}});
  if (particles.kind == Kind::repulsive && table.has("every"))
    table.fail("every", "is for the density of dynamic ones; leave it out");
  table.whole("every", particles.every, 1, 1000000);
  numerics.boundary_particles = particles;
}

void read_state_equation(const TomlReader& keys, Numerics& numerics) {
  if (numerics.state_equation != StateEquation::tait && keys.has("gamma"))
    keys.fail("gamma", "has no effect with state_equation other than \"tait\"; leave it out");
  keys.number("gamma", numerics.gamma, Range{1, 100, true, ""});
  const bool gas = numerics.state_equation == StateEquation::ideal_gas;
  if (gas && keys.has("sound_speed"))
    keys.fail("sound_speed", "of an ideal gas is the root of stiffness; leave it out");
  if (!gas && keys.has("stiffness")) keys.fail("stiffness", "belongs to state_equation \"ideal_gas\"; leave it out");
  keys.number("stiffness", numerics.stiffness, Range::positive("m²/s²"));
  keys.number("sound_speed", numerics.sound_speed, Range::positive("m/s"));
}

void read_seldom(const TomlReader& keys, Numerics& numerics) {
  keys.flag("particle_sound_speed", numerics.particle_sound_speed);
  keys.flag("tensile_correction", numerics.tensile_correction);
  keys.flag("internal_energy", numerics.internal_energy);
  keys.flag("half_pressure", numerics.half_pressure);
  if (keys.has("energy_surplus") && numerics.integrator != IntegratorKind::energy_bounded_euler)
    keys.fail("energy_surplus", "belongs to integrator \"energy_bounded_euler\"; leave it out");
  keys.flag("energy_surplus", numerics.energy_surplus);
  keys.choice<ViscosityForm>(
      "viscosity_form", numerics.viscosity_form,
      {{"morris", ViscosityForm::morris}, {"monaghan", ViscosityForm::monaghan}, {"muller", ViscosityForm::muller}});
  keys.choice<StressForm>("stress_form", numerics.stress_form,
                          {{"summed", StressForm::summed}, {"pairwise", StressForm::pairwise}});
}

void read_shifting(const TomlReader& keys, Numerics& numerics) {
  const toml::node* node = keys.node("shifting");
  if (node == nullptr) return;
  if (node->is_boolean()) {
    numerics.shifting.reset();
    if (*node->value<bool>()) numerics.shifting.emplace();
  } else {
    const TomlReader table = *keys.table("shifting", {"strength", "coupling"});
    Shifting shifting = numerics.shifting.value_or(Shifting{});
    table.number("strength", shifting.strength, Range{0, 100, false, ""});
    table.number("coupling", shifting.coupling, Range{0, 10, true, ""});
    numerics.shifting = shifting;
  }
}

void read_courant(const TomlReader& keys, Numerics& numerics) {
  const auto table = keys.table("courant", {"sound", "viscous", "force", "conduction"});
  if (!table) return;
  table->number("sound", numerics.courant_sound, Range::positive(""));
  table->number("viscous", numerics.courant_viscous, Range::positive(""));
  table->number("force", numerics.courant_force, Range::positive(""));
  table->number("conduction", numerics.courant_conduction, Range::positive(""));
}

void read_sleep(const TomlReader& keys, Numerics& numerics) {
  const auto table = keys.table("sleep", {"speed", "density_rate", "temperature_rate", "temperature", "after"});
  if (!table) return;
  SleepBounds& bounds = numerics.sleep.emplace();
  table->number("speed", bounds.speed, Range::positive("m/s"));
  table->number("density_rate", bounds.density_rate, Range::positive("1/s"));
  table->number("temperature_rate", bounds.temperature_rate, Range::not_negative("K/s"));
  table->number("temperature", bounds.temperature, Range::not_negative("K"));
  table->number("after", bounds.after, Range::positive("s"));
}

}  // namespace

Numerics read_numerics(const TomlReader& root, const Scene& scene) {
  const auto keys = root.table("numerics", numerics_keys);
  if (!keys) return *find_preset("molten", scene);
  Numerics numerics = read_preset(*keys, scene);
  read_choices(*keys, numerics);
  keys->number("smoothing_ratio", numerics.smoothing_ratio, Range{0.5, 10, true, "spacings"});
  keys->number("skin", numerics.skin, Range{0, 10, true, "spacings"});
  read_state_equation(*keys, numerics);
  read_density_filter(*keys, numerics);
  keys->number("artificial_viscosity", numerics.artificial_viscosity, Range::not_negative(""));
  read_seldom(*keys, numerics);
  read_xsph(*keys, numerics);
  keys->flag("gradient_correction", numerics.gradient_correction);
  keys->choice<LaplacianForm>(
      "laplacian", numerics.laplacian,
      {{"conservative", LaplacianForm::conservative}, {"consistent", LaplacianForm::consistent}});
  read_shifting(*keys, numerics);
  read_courant(*keys, numerics);
  keys->flag("wall_support", numerics.wall_support);
  read_boundary_particles(*keys, numerics);
  keys->number("density_diffusion", numerics.density_diffusion, Range{0, 1, true, ""});
  keys->number("fixed_dt", numerics.fixed_dt, Range::positive("s"));
  keys->whole("time_step_levels", numerics.time_step_levels, 0, most_levels);
  read_sleep(*keys, numerics);
  return numerics;
}

}  // namespace molten
