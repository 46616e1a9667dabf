#include <fmt/format.h>

#include "io/scene/scene_sections.h"
#include "io/scene/scene_shapes.h"

namespace molten {
namespace {

const TomlReader::Keys rheology_keys = {"model",
                                        "viscosity",
                                        "n",
                                        "jump_number",
                                        "yield_stress",
                                        "consistency",
                                        "dimensionless",
                                        "regularisation",
                                        "fast_viscosity",
                                        "relaxation_time",
                                        "largest_viscosity",
                                        "arrhenius",
                                        "vft"};
const TomlReader::Keys heat_keys = {"diffusivity", "melting_range", "initial"};

const Range diffusivities{0, 1e6, false, "m²/s"};

void read_velocity(const TomlReader& keys, int dimensions, Body& body) {
  keys.vector("velocity", body.velocity, dimensions, Range::any("m/s"));
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
  for (const TomlReader& table : fluid.tables("body", with_shape_keys({"velocity", "temperature", "diffusivity"}))) {
    Body& body = bodies.emplace_back();
    body.shape = read_shape(table, dimensions, ShapeUse::fluid);
    read_velocity(table, dimensions, body);
    table.number("temperature", body.temperature, Range::any("the scene's temperature unit"));
    table.number("diffusivity", body.diffusivity, diffusivities);
    for (const std::string_view key : {"temperature", "diffusivity"})
      if (table.has(key) && !fluid.has("heat")) table.fail(key, "needs heat; add [fluid.heat]");
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
  for (const std::string_view key :
       {"viscosity", "regularisation", "fast_viscosity", "relaxation_time", "largest_viscosity", "arrhenius", "vft"}) {
    if (keys.has(key)) keys.fail(key, "belongs to model \"newtonian\" and others; smd has jump_number");
  }
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

using Model = Rheology::Model;

/// The keys of each model beside those of all but smd.
const std::vector<std::pair<Model, TomlReader::Keys>> keys_of_models = {
    {Model::newtonian, {"viscosity"}},
    {Model::power_law, {"n", "consistency"}},
    {Model::bingham, {"viscosity", "yield_stress", "regularisation"}},
    {Model::herschel_bulkley, {"n", "consistency", "yield_stress", "regularisation"}},
    {Model::cross, {"viscosity", "fast_viscosity", "relaxation_time", "n"}},
    {Model::carreau, {"viscosity", "fast_viscosity", "relaxation_time", "n"}}};

void read_thermal(const TomlReader& keys, Rheology& rheology) {
  if (keys.has("arrhenius") && keys.has("vft")) keys.fail("vft", "stands beside arrhenius; keep one of the two");
  ThermalViscosity thermal;
  if (const auto table = keys.table("arrhenius", {"activation_temperature", "reference_temperature"})) {
    for (const char* key : {"activation_temperature", "reference_temperature"}) table->require(key, "give it in K");
    table->number("activation_temperature", thermal.activation_temperature, Range::not_negative("K"));
    table->number("reference_temperature", thermal.reference_temperature, Range::positive("K"));
    rheology.thermal = thermal;
  }
  if (const auto table = keys.table("vft", {"a", "b", "c"})) {
    thermal.kind = ThermalViscosity::Kind::vft;
    for (const char* key : {"a", "b", "c"}) table->require(key, "log10 of the factor is a + b/(T - c)");
    table->number("a", thermal.a, Range::any(""));
    table->number("b", thermal.b, Range::any("the scene's temperature unit"));
    table->number("c", thermal.c, Range::any("the scene's temperature unit"));
    rheology.thermal = thermal;
  }
  if (rheology.thermal) keys.require("largest_viscosity", "give the viscosity (Pa s) that cold fluid does not exceed");
}

/// All models but smd.
void read_flow_curve(const TomlReader& keys, Rheology& rheology) {
  const auto& own = *std::find_if(keys_of_models.begin(), keys_of_models.end(),
                                  [&](const auto& m) { return m.first == rheology.model; });
  const auto belongs = [&](std::string_view key) {
    return std::find(own.second.begin(), own.second.end(), key) != own.second.end();
  };
  for (const std::string_view key : {"n", "jump_number", "yield_stress", "consistency", "dimensionless"}) {
    if (!belongs(key) && keys.has(key))
      keys.fail(key, "belongs to model \"smd\" and others, not to this one; add that model or leave it out");
  }
  for (const std::string_view key : {"viscosity", "regularisation", "fast_viscosity", "relaxation_time"}) {
    if (!belongs(key) && keys.has(key)) keys.fail(key, "does not belong to this model; leave it out");
  }
  for (const std::string_view key : own.second) keys.require(key, "this model needs it; see docs/scenes.md");
  keys.number("viscosity", rheology.viscosity, Range::not_negative("Pa s"));
  keys.number("n", rheology.flow_index, Range{0, 2, false, ""});
  keys.number("consistency", rheology.consistency, Range::positive("Pa s^n"));
  keys.number("yield_stress", rheology.yield_stress, Range::not_negative("Pa"));
  keys.number("regularisation", rheology.regularisation, Range::positive("s"));
  keys.number("fast_viscosity", rheology.fast_viscosity, Range::not_negative("Pa s"));
  keys.number("relaxation_time", rheology.relaxation_time, Range::positive("s"));
  const bool unbounded = belongs("consistency") && rheology.flow_index < 1;
  if (unbounded) keys.require("largest_viscosity", "give the viscosity (Pa s) that fluid at rest does not exceed");
  keys.number("largest_viscosity", rheology.largest_viscosity, Range::positive("Pa s"));
  read_thermal(keys, rheology);
}

Rheology read_rheology(const TomlReader& fluid) {
  const auto keys = fluid.table("rheology", rheology_keys);
  Rheology rheology;
  if (!keys) return rheology;
  keys->choice<Rheology::Model>("model", rheology.model,
                                {{"newtonian", Model::newtonian},
                                 {"smd", Model::smd},
                                 {"power_law", Model::power_law},
                                 {"bingham", Model::bingham},
                                 {"herschel_bulkley", Model::herschel_bulkley},
                                 {"cross", Model::cross},
                                 {"carreau", Model::carreau}});
  if (rheology.model == Rheology::Model::smd) {
    read_smd(*keys, rheology);
  } else {
    read_flow_curve(*keys, rheology);
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
  keys->number("diffusivity", heat.diffusivity, diffusivities);
  std::array<double, 2> melting{};
  if (keys->numbers("melting_range", melting, Range::any("the scene's temperature unit"))) {
    if (melting[0] >= melting[1]) keys->fail("melting_range", "does not rise; give [T low, T high]");
    heat.melting_range = melting;
  }
  if (keys->has("initial") || !all_bodies_have_one) read_initial(*keys, heat);
  return heat;
}

}  // namespace

Fluid read_fluid(const TomlReader& root, int dimensions) {
  root.require("fluid", "add [fluid] with a shape and particles or spacing");
  const TomlReader keys = *root.table("fluid", with_shape_keys({"body", "particles", "spacing", "density", "velocity",
                                                                "hydrostatic", "rheology", "heat"}));
  Fluid fluid;
  fluid.place = keys.place();
  fluid.bodies = read_bodies(keys, dimensions, root.has("vent"));
  read_amount(keys, fluid);
  keys.number("density", fluid.density, Range::positive("kg/m³"));
  keys.flag("hydrostatic", fluid.hydrostatic);
  fluid.rheology = read_rheology(keys);
  bool all_have_temperature = true;  // without bodies, the vents have theirs
  for (const Body& body : fluid.bodies) all_have_temperature = all_have_temperature && body.temperature.has_value();
  fluid.heat = read_heat(keys, all_have_temperature);
  return fluid;
}

}  // namespace molten
