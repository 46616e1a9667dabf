#include <fmt/format.h>

#include "io/scene/scene_sections.h"
#include "io/scene/scene_shapes.h"

namespace molten {
namespace {

const TomlReader::Keys rheology_keys = {"model",       "viscosity",    "n", "jump_number", "yield_stress",
                                        "consistency", "dimensionless"};
const TomlReader::Keys heat_keys = {"diffusivity", "melting_range", "initial"};

void read_velocity(const TomlReader& keys, int dimensions, Body& body) {
  keys.numbers("velocity", std::span(body.velocity).first(static_cast<std::size_t>(dimensions)), Range::any("m/s"));
}

/// Either [fluid] itself has the shape, or its [[fluid.body]] tables have one each; with vents there need be none.
std::vector<Body> read_bodies(const TomlReader& fluid, int dimensions, bool has_vents) {
  std::vector<Body> bodies;
  if (has_vents && !has_shape(fluid) && !fluid.has("body")) {
    fluid.require("spacing", "give it in m: without a shape the fluid is what the vents let in");
    return bodies;
  }
  if (!fluid.has("body")) {
    Body& body = bodies.emplace_back();
    body.shape = read_shape(fluid, dimensions, ShapeUse::fluid);
    read_velocity(fluid, dimensions, body);
    return bodies;
  }
  if (has_shape(fluid)) fluid.fail("body", "stands beside a shape of [fluid]; move that shape into a [[fluid.body]]");
  if (fluid.has("velocity")) fluid.fail("velocity", "stands beside bodies; give each [[fluid.body]] its own");
  for (const TomlReader& table : fluid.tables("body", with_shape_keys({"velocity", "temperature"}))) {
    Body& body = bodies.emplace_back();
    body.shape = read_shape(table, dimensions, ShapeUse::fluid);
    read_velocity(table, dimensions, body);
    table.number("temperature", body.temperature, Range::any("the scene's temperature unit"));
    if (body.temperature && !fluid.has("heat")) table.fail("temperature", "needs heat; add [fluid.heat]");
  }
  if (bodies.empty()) fluid.fail("body", "is empty; add a [[fluid.body]] with a shape");
  return bodies;
}

void read_amount(const TomlReader& keys, Fluid& fluid) {
  constexpr long long most_particles = 2147483647;
  if (keys.has("particles") && keys.has("spacing")) {
    keys.fail("spacing", "stands beside particles, which fixes it; keep one of them");
  }
  if (!keys.has("particles") && !keys.has("spacing")) {
    keys.fail("particles", "missing; give particles (how many) or spacing (in m)");
  }
  long long particles = 0;
  if (keys.whole("particles", particles, 1, most_particles)) fluid.particles = particles;
  keys.number("spacing", fluid.spacing, Range::positive("m"));
}

// ---- rheology ----

void read_jump_number(const TomlReader& keys, Rheology& rheology) {
  const Range range{-1, 1e12, false, ""};
  keys.require("jump_number", "give J, or [J hot, J cold]");
  if (!keys.node("jump_number")->is_array()) {
    keys.number("jump_number", rheology.jump_number[0], range);
    rheology.jump_number[1] = rheology.jump_number[0];
    return;
  }
  keys.numbers("jump_number", rheology.jump_number, range);
  if (rheology.jump_number[0] >= rheology.jump_number[1]) {
    keys.fail("jump_number", "does not rise from hot to cold; give [hot, cold], the smaller one first, or one value");
  }
}

void read_smd(const TomlReader& keys, Rheology& rheology) {
  rheology.model = Rheology::Model::smd;
  if (keys.has("viscosity")) keys.fail("viscosity", "belongs to model \"newtonian\"; smd has jump_number");
  keys.number("n", rheology.flow_index, Range{0, 2, false, ""});
  read_jump_number(keys, rheology);
  bool dimensionless = false;
  keys.flag("dimensionless", dimensionless);
  for (const std::string_view key : {"yield_stress", "consistency"}) {
    if (dimensionless && keys.has(key)) keys.fail(key, "is 1 when dimensionless; leave one of the two out");
    if (!dimensionless) keys.require(key, "give it, or dimensionless = true for both to be 1");
  }
  keys.number("yield_stress", rheology.yield_stress, Range::positive("Pa"));
  keys.number("consistency", rheology.consistency, Range::positive("Pa s^n"));
}

void read_newtonian(const TomlReader& keys, Rheology& rheology) {
  for (const std::string_view key : {"n", "jump_number", "yield_stress", "consistency", "dimensionless"}) {
    if (keys.has(key)) keys.fail(key, "belongs to model \"smd\"; add model = \"smd\" or leave it out");
  }
  keys.require("viscosity", "give the dynamic viscosity in Pa s");
  keys.number("viscosity", rheology.viscosity, Range::not_negative("Pa s"));
}

Rheology read_rheology(const TomlReader& fluid) {
  const auto keys = fluid.table("rheology", rheology_keys);
  Rheology rheology;
  if (!keys) return rheology;
  keys->choice<Rheology::Model>("model", rheology.model,
                                {{"newtonian", Rheology::Model::newtonian}, {"smd", Rheology::Model::smd}});
  if (rheology.model == Rheology::Model::smd) {
    read_smd(*keys, rheology);
  } else {
    read_newtonian(*keys, rheology);
  }
  return rheology;
}

// ---- heat ----

void read_initial(const TomlReader& keys, Heat& heat) {
  const Range range = Range::any("the scene's temperature unit");
  keys.require("initial", "give a temperature, or { bottom, top } for one that is linear in height");
  if (!keys.node("initial")->is_table()) {
    keys.number("initial", heat.initial_bottom, range);
    heat.initial_top = heat.initial_bottom;
    return;
  }
  const TomlReader ends = *keys.table("initial", {"bottom", "top"});
  for (const std::string_view key : {"bottom", "top"}) ends.require(key, "give both bottom and top");
  ends.number("bottom", heat.initial_bottom, range);
  ends.number("top", heat.initial_top, range);
}

std::optional<Heat> read_heat(const TomlReader& fluid, bool all_bodies_have_one) {
  const auto keys = fluid.table("heat", heat_keys);
  if (!keys) return std::nullopt;
  Heat heat;
  keys->require("diffusivity", "give the thermal diffusivity in m²/s");
  keys->number("diffusivity", heat.diffusivity, Range{0, 1e6, false, "m²/s"});
  std::array<double, 2> melting{};
  if (keys->numbers("melting_range", melting, Range::any("the scene's temperature unit"))) {
    if (melting[0] >= melting[1]) keys->fail("melting_range", "does not rise; give [T low, T high]");
    heat.melting_range = melting;
  }
  if (keys->has("initial") || !all_bodies_have_one) read_initial(*keys, heat);
  return heat;
}

/// A melting range acts on a pair of jump numbers, and a pair needs one.
void check_melting(const TomlReader& keys, const Fluid& fluid) {
  const bool melts = fluid.heat && fluid.heat->melting_range;
  const auto& [hot, cold] = fluid.rheology.jump_number;
  if (hot != cold && !melts) {
    keys.table("rheology", rheology_keys)
        ->fail("jump_number", "differs between hot and cold, but nothing melts; add melting_range to [fluid.heat]");
  }
  if (melts && fluid.rheology.model != Rheology::Model::smd) {
    keys.table("heat", heat_keys)
        ->fail("melting_range", "acts on the jump_number of model \"smd\" alone; leave it out or use that model");
  }
}

}  // namespace

Fluid read_fluid(const TomlReader& root, int dimensions) {
  root.require("fluid", "add [fluid] with a shape and particles or spacing");
  const TomlReader keys = *root.table(
      "fluid", with_shape_keys({"body", "particles", "spacing", "density", "velocity", "rheology", "heat"}));
  Fluid fluid;
  fluid.place = keys.place();
  fluid.bodies = read_bodies(keys, dimensions, root.has("vent"));
  read_amount(keys, fluid);
  keys.number("density", fluid.density, Range::positive("kg/m³"));
  fluid.rheology = read_rheology(keys);
  bool all_have_temperature = true;  // without bodies, the vents have theirs
  for (const Body& body : fluid.bodies) all_have_temperature = all_have_temperature && body.temperature.has_value();
  fluid.heat = read_heat(keys, all_have_temperature);
  check_melting(keys, fluid);
  return fluid;
}

}  // namespace molten
