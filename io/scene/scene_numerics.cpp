#include <fmt/format.h>

#include "io/scene/presets.h"
#include "io/scene/scene_sections.h"

namespace molten {
namespace {

const TomlReader::Keys numerics_keys = {
    "preset",     "precision",      "resort",       "kernel",           "smoothing_ratio",      "skin",
    "integrator", "state_equation", "gamma",        "sound_speed",      "artificial_viscosity", "xsph",
    "courant",    "fixed_dt",       "wall_support", "density_diffusion"};

Numerics read_preset(const TomlReader& keys) {
  std::string name = "molten";
  keys.choice<std::string>("preset", name,
                           {{"molten", "molten"}, {"paiva", "paiva"}, {"queiroz", "queiroz"}, {"dias", "dias"}});
  const std::optional<Numerics> preset = find_preset(name);
  if (!preset) {
    keys.fail("preset", fmt::format("\"{}\" is not available in this version; use \"molten\" or \"paiva\"", name));
  }
  return *preset;
}

void read_choices(const TomlReader& keys, Numerics& numerics) {
  keys.choice<Precision>("precision", numerics.precision,
                         {{"single", Precision::single}, {"double", Precision::double_}});
  keys.choice<Resort>("resort", numerics.resort, {{"when_due", Resort::when_due}, {"each_step", Resort::each_step}});
  keys.choice<KernelKind>("kernel", numerics.kernel,
                          {{"gaussian", KernelKind::gaussian},
                           {"quadratic", KernelKind::quadratic},
                           {"cubic_spline", KernelKind::cubic_spline},
                           {"wendland_c2", KernelKind::wendland_c2},
                           {"lucy", KernelKind::lucy},
                           {"poly6", KernelKind::poly6},
                           {"spiky", KernelKind::spiky}});
  keys.choice<IntegratorKind>(
      "integrator", numerics.integrator,
      {{"leap_frog", IntegratorKind::leap_frog}, {"symplectic_euler", IntegratorKind::symplectic_euler}});
  keys.choice<StateEquation>("state_equation", numerics.state_equation,
                             {{"linear", StateEquation::linear}, {"tait", StateEquation::tait}});
}

void read_xsph(const TomlReader& keys, Numerics& numerics) {
  const toml::node* node = keys.node("xsph");
  if (node == nullptr) return;
  if (node->is_boolean()) {
    if (*node->value<bool>()) keys.fail("xsph", "true says too little; give { form = \"position\", epsilon = 0.5 }");
    numerics.xsph.reset();
    return;
  }
  const TomlReader table = *keys.table("xsph", {"form", "epsilon"});
  Xsph xsph = numerics.xsph.value_or(Xsph{});
  table.choice<Xsph::Form>("form", xsph.form, {{"velocity", Xsph::Form::velocity}, {"position", Xsph::Form::position}});
  table.number("epsilon", xsph.epsilon, Range{0, 1, false, ""});
  numerics.xsph = xsph;
}

void read_courant(const TomlReader& keys, Numerics& numerics) {
  const auto table = keys.table("courant", {"sound", "viscous", "force", "conduction"});
  if (!table) return;
  table->number("sound", numerics.courant_sound, Range::positive(""));
  table->number("viscous", numerics.courant_viscous, Range::positive(""));
  table->number("force", numerics.courant_force, Range::positive(""));
  table->number("conduction", numerics.courant_conduction, Range::positive(""));
}

}  // namespace

Numerics read_numerics(const TomlReader& root) {
  const auto keys = root.table("numerics", numerics_keys);
  if (!keys) return {};
  Numerics numerics = read_preset(*keys);
  read_choices(*keys, numerics);
  keys->number("smoothing_ratio", numerics.smoothing_ratio, Range{0.5, 10, true, "spacings"});
  keys->number("skin", numerics.skin, Range{0, 10, true, "spacings"});
  if (numerics.state_equation == StateEquation::linear && keys->has("gamma")) {
    keys->fail("gamma", "has no effect with state_equation \"linear\"; leave it out or use \"tait\"");
  }
  keys->number("gamma", numerics.gamma, Range{1, 100, true, ""});
  keys->number("sound_speed", numerics.sound_speed, Range::positive("m/s"));
  keys->number("artificial_viscosity", numerics.artificial_viscosity, Range::not_negative(""));
  read_xsph(*keys, numerics);
  read_courant(*keys, numerics);
  keys->flag("wall_support", numerics.wall_support);
  keys->number("density_diffusion", numerics.density_diffusion, Range{0, 1, true, ""});
  keys->number("fixed_dt", numerics.fixed_dt, Range::positive("s"));
  return numerics;
}

}  // namespace molten
