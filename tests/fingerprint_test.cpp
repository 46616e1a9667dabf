// The hash that tells a changed scene: every key of a scene file but those of [run] and [output] must change it.
#include <gtest/gtest.h>

#include <set>
#include <sstream>

#include "io/geometry/assemble.h"
#include "tests/scene_texts.h"

namespace molten::fingerprint_test {
namespace {

using namespace scene_texts;
using Overrides = std::vector<std::string>;

const std::string small = R"([scene]
domain = { min = [-2, -2, -2], max = [2, 2, 2] }
[fluid]
box = { min = [0, 0, 0], max = [0.4, 0.4, 0.4] }
spacing = 0.1
[fluid.rheology]
model = "newtonian"
viscosity = 1.0
[fluid.heat]
diffusivity = 1e-4
initial = 20
[[boundary]]
plane = { point = [0, 0, 0], normal = [0, 0, 1] }
[run]
end_time = 1
)";

std::string print_of(const Overrides& overrides) {
  // What "molten" takes depends on gravity and viscosity; here one key is to change and nothing else.
  Overrides all{"numerics.preset=\"basic\""};
  all.insert(all.end(), overrides.begin(), overrides.end());
  const Scene scene = parse_scene(small, "s.toml", all);
  return fingerprint(scene, fill_bodies(scene, features_of(scene)));
}

/// One key changed, in a scene with more keys set.
struct Change {
  std::string key_and_value;
  Overrides with = {};
};

const std::string smd =
    "fluid.rheology={ model = \"smd\", n = 0.5, jump_number = 15, yield_stress = 60, consistency = 20 }";
const std::string smd_that_melts =
    "fluid.rheology={ model = \"smd\", n = 0.5, jump_number = [15, 150], yield_stress = 60, consistency = 20 }";
const std::string bingham =
    "fluid.rheology={ model = \"bingham\", viscosity = 1, yield_stress = 2, regularisation = 3, largest_viscosity = 9 "
    "}";
const std::string cross =
    "fluid.rheology={ model = \"cross\", viscosity = 1, fast_viscosity = 0.1, relaxation_time = 3, n = 0.5 }";
const std::string carreau =
    "fluid.rheology={ model = \"carreau\", viscosity = 1, fast_viscosity = 0.1, relaxation_time = 3, n = 0.5 }";
const std::string arrhenius =
    "fluid.rheology={ model = \"newtonian\", viscosity = 1, largest_viscosity = 9, arrhenius = { "
    "activation_temperature = 900, reference_temperature = 300 } }";
const std::string vft =
    "fluid.rheology={ model = \"newtonian\", viscosity = 1, largest_viscosity = 9, vft = { a = 1, b = 2, c = 3 } }";
const std::string support = "numerics.wall_support=true", summation = "numerics.density=\"summation\"";
const std::string ground = "boundary.0.ground={ diffusivity = 1, thickness = 1 }";
const std::string ball = "boundary.0={ sphere = { center = [0, 0, -3], radius = 1 } }";
const std::string key_frames = "boundary.0.motion={ key_frames = [[0, 0, 0, 0], [1, 0, 1, 0]] }";
const std::string mouth = "disc = { centre = [2, 0, 1], normal = [1, 0, 0], radius = 0.3 }";
const std::string vent = "vent=[{ " + mouth + ", rate = 0.01, temperature = 20 }]";
const std::string vent_by_table = "vent=[{ " + mouth + ", table = [[0, 0.01, 20], [1, 0.02, 20]] }]";
const std::string outflow = "outflow=[{ plane = { point = [2, 0, 0], normal = [1, 0, 0] } }]";

const std::vector<Change> changes = {
    {"scene.gravity=[0, 0, -9]"},
    {"scene.periodic=[\"x\"]"},
    {"scene.domain={ min = [-2, -2, -2], max = [2, 2, 3] }"},
    {"fluid.spacing=0.05"},
    {"fluid.density=1001"},
    {"fluid.velocity=[0, 0, 1]"},
    {"fluid.hydrostatic=true"},
    {"fluid.box.max=[0.4, 0.4, 0.5]"},
    {smd},
    {"fluid.rheology.viscosity=2"},
    {"fluid.rheology.n=0.4", {smd}},
    {"fluid.rheology.jump_number=16", {smd}},
    {"fluid.rheology.jump_number=[15, 160]", {smd_that_melts, "fluid.heat.melting_range=[40, 60]"}},
    {"fluid.rheology.yield_stress=61", {smd}},
    {"fluid.rheology.consistency=21", {smd}},
    {"fluid.rheology.regularisation=4", {bingham}},
    {"fluid.rheology.largest_viscosity=8", {bingham}},
    {"fluid.rheology.fast_viscosity=0.2", {cross}},
    {"fluid.rheology.relaxation_time=4", {cross}},
    {"fluid.rheology.model=\"carreau\"", {cross}},
    {"fluid.rheology.arrhenius.activation_temperature=800", {arrhenius}},
    {"fluid.rheology.arrhenius.reference_temperature=301", {arrhenius}},
    {"fluid.rheology.vft.a=2", {vft}},
    {"fluid.rheology.vft.b=3", {vft}},
    {"fluid.rheology.vft.c=4", {vft}},
    {"fluid.heat.diffusivity=2e-4"},
    {"fluid.heat.initial=21"},
    {"fluid.heat.melting_range=[40, 61]", {smd, "fluid.heat.melting_range=[40, 60]"}},
    {"boundary.0.slip=0.5"},
    {"boundary.0.restitution=0.5"},
    {"boundary.0.plane.point=[0, 0, -1]"},
    {"boundary.0={ sphere = { center = [0, 0, 0], radius = 2.5 }, inside = true }"},
    {"boundary.0.friction=0.5"},
    {"boundary.0.yield_stress=5"},
    {"boundary.0.velocity=[1, 0, 0]"},
    {"boundary.0.two_sided=true", {ball}},
    {"boundary.0.motion={ velocity = [1, 0, 0] }", {ball}},
    {"boundary.0.motion.velocity=[0, 1, 0]", {ball, "boundary.0.motion={ velocity = [1, 0, 0] }"}},
    {"boundary.0.motion.spin=[0, 1, 0]", {ball, "boundary.0.motion={ spin = [1, 0, 0] }"}},
    {"boundary.0.motion.centre=[0, 1, 0]", {ball, "boundary.0.motion={ spin = [1, 0, 0] }"}},
    {"boundary.0.motion.key_frames=[[0, 0, 0, 0], [2, 0, 1, 0]]", {ball, key_frames}},
    {"boundary.0.body={ density = 500 }", {ball}},
    {"boundary.0.body.density=600", {ball, "boundary.0.body={ density = 500 }"}},
    {"boundary.0.body.velocity=[1, 0, 0]", {ball, "boundary.0.body={ density = 500 }"}},
    {"boundary.0.body.spin=[1, 0, 0]", {ball, "boundary.0.body={ density = 500 }"}},
    {vent},
    {"vent.0.rate=0.02", {vent}},
    {"vent.0.temperature=30", {vent}},
    {"vent.0.disc.radius=0.2", {vent}},
    {"vent.0.table=[[0, 0.01, 20], [2, 0.02, 20]]", {vent_by_table}},
    {outflow},
    {"outflow.0.plane.point=[3, 0, 0]", {outflow}},
    {"boundary.0.temperature=21", {support, "boundary.0.temperature=20"}},
    {"boundary.0.ground.diffusivity=2", {support, "boundary.0.temperature=20", ground}},
    {"boundary.0.ground.thickness=2", {support, "boundary.0.temperature=20", ground}},
    {"numerics.preset=\"paiva\""},
    {"numerics.precision=\"double\""},
    {"numerics.resort=\"each_step\""},
    {"numerics.kernel=\"gaussian\""},
    {"numerics.smoothing_ratio=1.4"},
    {"numerics.skin=0.4"},
    {"numerics.integrator=\"midpoint\""},
    {"numerics.state_equation=\"linear\""},
    {"numerics.gamma=6"},
    {"numerics.sound_speed=30"},
    {"numerics.stiffness=30", {"numerics.state_equation=\"ideal_gas\""}},
    {"numerics.artificial_viscosity=0.2"},
    {"numerics.particle_sound_speed=true"},
    {"numerics.viscosity_form=\"muller\""},
    {"numerics.viscosity_form=\"monaghan\""},
    {"numerics.stress_form=\"pairwise\""},
    {"numerics.laplacian=\"consistent\"", {"numerics.gradient_correction=true"}},
    {"numerics.tensile_correction=true"},
    {"numerics.internal_energy=true"},
    {"numerics.half_pressure=true"},
    {"numerics.energy_surplus=false", {"numerics.integrator=\"energy_bounded_euler\""}},
    {"numerics.xsph.form=\"velocity\"", {"numerics.xsph={}"}},
    {"numerics.xsph.epsilon=0.4", {"numerics.xsph={}"}},
    {"numerics.xsph.density=\"neighbour\"", {"numerics.xsph={}"}},
    {summation},
    {"numerics.density_kernel=\"poly6\"", {summation}},
    {"numerics.density_filter.kind=\"mls\"", {"numerics.density_filter={}"}},
    {"numerics.density_filter.every=20", {"numerics.density_filter={}"}},
    {"numerics.gradient_correction=true"},
    {"numerics.shifting=true", {"numerics.gradient_correction=true"}},
    {"numerics.shifting.strength=3", {"numerics.gradient_correction=true", "numerics.shifting={}"}},
    {"numerics.shifting.coupling=0.5", {"numerics.gradient_correction=true", "numerics.shifting={}"}},
    {"numerics.courant.sound=0.1"},
    {"numerics.courant.viscous=0.05"},
    {"numerics.courant.force=0.1"},
    {"numerics.courant.conduction=0.1"},
    {"numerics.density_diffusion=0.1"},
    {"numerics.boundary_particles={ kind = \"repulsive\" }", {ball}},
    {support},
    {"numerics.fixed_dt=1e-5"},
    {"numerics.time_step_levels=3", {smd}},
    {"numerics.sleep={}"},
    {"numerics.sleep.speed=0.1", {"numerics.sleep={}"}},
    {"numerics.sleep.density_rate=0.1", {"numerics.sleep={}"}},
    {"numerics.sleep.temperature_rate=0.1", {"numerics.sleep={}"}},
    {"numerics.sleep.temperature=0.1", {"numerics.sleep={}"}},
    {"numerics.sleep.after=10", {"numerics.sleep={}"}}};

TEST(Fingerprint, EveryChangeOfTheSceneChangesIt) {
  for (const Change& change : changes) {
    Overrides after = change.with;
    after.push_back(change.key_and_value);
    EXPECT_NE(print_of(change.with), print_of(after)) << change.key_and_value;
  }
}

TEST(Fingerprint, RunOutputAndTitleDoNotChangeIt) {
  const std::string before = print_of({});
  EXPECT_EQ(print_of({}), before);
  for (const char* change : {"scene.title=\"another\"", "run.end_time=2", "run.max_steps=7",
                             "output.frames_per_second=3", "output.checkpoint_every=7", "fluid.density=1000.0"})
    EXPECT_EQ(print_of({change}), before) << change;
}

/// The keys that the reader knows in a table, as it says itself when it meets one that it does not.
std::vector<std::string> known_keys(const std::string& table, const Overrides& with = {}) {
  Overrides overrides = with;
  overrides.push_back(table + ".zzzzzzzzzzzzzzzzzzzz=1");
  const std::string message = complaint(small, overrides), before = "; known: ";
  const std::size_t at = message.find(before);
  EXPECT_NE(at, std::string::npos) << message;
  std::vector<std::string> keys;
  std::istringstream list(message.substr(at + before.size()));
  for (std::string key; std::getline(list >> std::ws, key, ',');) keys.push_back(table + '.' + key);
  return keys;
}

TEST(Fingerprint, NoKeyIsForgottenAbove) {
  // What acts through where the particles and the walls are, of which one each is above; what sets other keys.
  const std::set<std::string> through_others = {"scene.title",
                                                "scene.dimensions",
                                                "fluid.body",
                                                "fluid.particles",
                                                "fluid.rheology.dimensionless",
                                                "fluid.mesh",
                                                "fluid.sphere",
                                                "fluid.cylinder",
                                                "fluid.cone",
                                                "fluid.polygon",
                                                "fluid.text",
                                                "fluid.plane",
                                                "fluid.terrain",
                                                "fluid.height",
                                                "fluid.position",
                                                "fluid.rotation",
                                                "fluid.cell_size",
                                                "fluid.scale",
                                                "fluid.origin",
                                                "vent.0.mesh",
                                                "vent.0.height",
                                                "vent.0.position",
                                                "vent.0.rotation",
                                                "boundary.0.mesh",
                                                "boundary.0.sphere",
                                                "boundary.0.box",
                                                "boundary.0.cone",
                                                "boundary.0.inside",
                                                "boundary.0.polygon",
                                                "boundary.0.text",
                                                "boundary.0.terrain",
                                                "boundary.0.height",
                                                "boundary.0.scale",
                                                "boundary.0.position",
                                                "boundary.0.origin",
                                                "boundary.0.cylinder",
                                                "boundary.0.rotation",
                                                "boundary.0.cell_size"};
  const std::vector<std::pair<std::string, Overrides>> tables = {
      {"scene", {}},
      {"fluid", {}},
      {"fluid.rheology", {}},
      {"fluid.rheology.arrhenius", {arrhenius}},
      {"fluid.rheology.vft", {vft}},
      {"fluid.heat", {}},
      {"boundary.0", {}},
      {"boundary.0.ground", {support, "boundary.0.temperature=20"}},
      {"boundary.0.motion", {ball}},
      {"boundary.0.body", {ball}},
      {"vent.0", {vent}},
      {"outflow.0", {outflow}},
      {"numerics", {}},
      {"numerics.xsph", {}},
      {"numerics.density_filter", {}},
      {"numerics.shifting", {"numerics.gradient_correction=true"}},
      {"numerics.courant", {}},
      {"numerics.sleep", {}}};
  for (const auto& [table, with] : tables)
    for (const std::string& key : known_keys(table, with)) {
      const bool changed = std::any_of(changes.begin(), changes.end(), [&](const Change& change) {
        const std::string& text = change.key_and_value;
        return text.starts_with(key) && (text[key.size()] == '=' || text[key.size()] == '.');
      });
      EXPECT_TRUE(changed || through_others.contains(key)) << key;
    }
}

}  // namespace
}  // namespace molten::fingerprint_test
