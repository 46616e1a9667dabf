// Every mistake in a scene file ends in one line with its place and a remedy.
#include <gtest/gtest.h>

#include "tests/scene_texts.h"

namespace molten::scene_mistakes_test {
namespace {

using namespace scene_texts;

struct Mistake {
  const char* from;
  const char* to;
  const char* fragment;
};

const std::vector<Mistake> mistakes = {
    // unknown keys, wrong types
    {"density = 1200.0", "densty = 1200.0", "s.toml:10:1: fluid.densty: unknown key; did you mean density?"},
    {"[output]", "[outputs]", "s.toml:45:2: outputs: unknown key; did you mean output?"},
    {"slip = 0.5", "sticky = 0.5", "s.toml:34:1: boundary.0.sticky: unknown key; known: "},
    {"radius = 0.9", "radios = 0.9", "s.toml:37:32: boundary.1.cylinder.radios: unknown key"},
    {"title = \"A good scene\"", "title = 7", "s.toml:3:9: scene.title: is a number; give a string"},
    {"title = \"A good scene\"", "title = \"\"", "scene.title: is empty"},
    {"title = \"A good scene\"", "title = \"a\\nb\"", "control characters"},
    {"density = 1200.0", "density = \"heavy\"",
     "s.toml:10:11: fluid.density: is a string; give a number above 0 in kg/m³"},
    {"density = 1200.0", "density = true", "is true or false"},
    {"density = 1200.0", "density = 2020-01-01", "is a date"},
    {"inside = true", "inside = 1", "boundary.1.inside: is a number; give true or false"},
    {"[run]", "[[run]]", "run: stands more than once"},
    {"[[boundary]]\nplane = { point = [0, 0, 0], normal = [0, 0, 1] }\nslip = 0.5\n\n[[boundary]]", "[boundary]",
     "write [[boundary]]"},
    {"courant = { sound = 0.15 }", "density_diffusion = 2", "numerics.density_diffusion: 2 is out of range"},
    {"courant = { sound = 0.15 }", "courant = 0.15", "courant: is a number; give a table: sound"},
    // numbers out of range
    {"density = 1200.0", "density = 0", "fluid.density: 0 is out of range"},
    {"density = 1200.0", "density = -1", "fluid.density: -1 is out of range; give a number above 0 in kg/m³"},
    {"density = 1200.0", "density = nan", "nan is out of range"},
    {"density = 1200.0", "density = inf", "inf is out of range"},
    {"density = 1200.0", "density = 1e200", "out of range"},
    {"particles = 1000", "particles = 0", "give a whole number from 1"},
    {"particles = 1000", "particles = -5", "-5 does not do"},
    {"particles = 1000", "particles = 10.5", "10.5 does not do"},
    {"particles = 1000", "particles = 3000000000", "give a whole number"},
    {"end_time = 0.4", "end_time = 0.0", "s.toml:42:12: run.end_time: 0 is out of range"},
    {"end_time = 0.4", "end_time = -inf", "run.end_time: -inf"},
    {"max_steps = 100", "max_steps = 0", "run.max_steps"},
    {"slip = 0.5", "slip = 1.5", "at least 0 and at most 1"},
    {"restitution = 0.2", "restitution = -0.1", "s.toml:39:15: boundary.1.restitution"},
    {"restitution = 0.2", "friction = -0.1", "boundary.1.friction"},
    {"restitution = 0.2", "yield_stress = -1", "boundary.1.yield_stress"},
    {"slip = 0.5", "slip = 0.5\nfriction = 0.5", "boundary.0.slip: stands beside friction or yield_stress"},
    {"slip = 0.5", "two_sided = true", "boundary.0.two_sided: is for surfaces that end"},
    {"slip = 0.5", "body = { density = 1 }", "boundary.0.body: is for closed shapes with the fluid outside"},
    {"slip = 0.5", "body = { velocity = [0, 0, 1] }\nmotion = {}", "stands beside motion"},
    {"slip = 0.5", "motion = { key_frames = [[0, 0, 0]] }", "key_frames: row 0 has another form; give [t, x, y, z]"},
    {"slip = 0.5", "motion = { key_frames = [[1, 0, 0, 0], [1, 0, 0, 1]] }", "row 1 is not later"},
    {"slip = 0.5", "motion = { key_frames = [[1, 0, 0, 0]], spin = [0, 0, 1] }", "stands beside velocity or spin"},
    {"slip = 0.5", "motion = {}", "boundary.0.motion: says nothing of how it moves; give velocity, spin or key_frames"},
    {"slip = 0.5", "motion = { spin = [0, 0, 1] }\nvelocity = [1, 0, 0]",
     "boundary.0.velocity: is for walls that stay in place"},
    {"slip = 0.5", "motion = { speed = 3 }", "boundary.0.motion.speed: unknown key"},
    {"[run]", "[[vent]]\nrate = 1\n[run]", "vent.0.disc: give either a disc or a mesh"},
    {"[run]", "[[vent]]\ndisc = { centre = [0, 0, 0], normal = [0, 0, 0], radius = 1 }\n[run]",
     "normal: has no length"},
    {"[run]", "[[vent]]\ndisc = { centre = [0, 0, 0], normal = [0, 0, 1], radius = 1 }\n[run]", "vent.0.rate: missing"},
    {"[run]", "[[vent]]\ndisc = { centre = [0, 0, 0], normal = [0, 0, 1], radius = 1 }\nrate = 1\n[run]",
     "vent.0.temperature: missing"},
    {"[run]",
     "[[vent]]\ndisc = { centre = [0, 0, 0], normal = [0, 0, 1], radius = 1 }\ntable = [[1, 1, 1], [1, 1, 1]]\n[run]",
     "the time 1 is not later"},
    {"[run]", "[[outflow]]\nplane = { point = [0, 0, 0] }\n[run]", "outflow.0.plane.normal: missing"},
    {"frames_per_second = 50", "frames_per_second = -1", "output.frames_per_second"},
    {"frames_per_second = 50", "frames_per_second = 1e30",
     "output.frames_per_second: makes more than ten million frames"},
    {"radius = 0.5", "radius = 0", "fluid.body.0.sphere.radius: 0 is out of range"},
    {"density = 1200.0", "density = 1e31", "1e+31 is out of range; give a number above 0 in kg/m³, at most 1e+30"},
    {"n = 0.5", "n = 0", "fluid.rheology.n: 0 is out of range"},
    {"n = 0.5", "n = 2.1", "give a number above 0 and at most 2"},
    {"jump_number = [15, 150]", "jump_number = -1", "jump_number: -1 is out of range; give a number above -1"},
    {"jump_number = [15, 150]", "jump_number = [-2, 150]", "-2 is out of range"},
    {"yield_stress = 60.0", "yield_stress = 0", "yield_stress: 0 is out of range"},
    {"diffusivity = 1e-4", "diffusivity = -1e-4", "fluid.heat.diffusivity"},
    {"temperature = 80", "temperature = 80\ndiffusivity = 0", "fluid.body.0.diffusivity: 0 is out of range"},
    {"courant = { sound = 0.15 }", "courant = { sound = 0 }", "numerics.courant.sound: 0"},
    {"xsph = { epsilon = 0.4 }", "xsph = { epsilon = 2 }", "numerics.xsph.epsilon: 2"},
    {"courant = { sound = 0.15 }", "time_step_levels = 17", "numerics.time_step_levels: 17"},
    {"courant = { sound = 0.15 }", "sleep = { speed = 0 }", "numerics.sleep.speed: 0 is out of range"},
    {"courant = { sound = 0.15 }", "sleep = true", "sleep: is true or false; give a table: speed"},
    {"courant = { sound = 0.15 }", "sleep = { velocity = 1 }", "velocity"},
    // vectors
    {"gravity = [0.0, 0.0, -9.81]", "gravity = [0.0, -9.81]",
     "s.toml:4:11: scene.gravity: has 2 entries; give 3 numbers"},
    {"gravity = [0.0, 0.0, -9.81]", "gravity = -9.81", "scene.gravity: is a number; give an array of 3"},
    {"gravity = [0.0, 0.0, -9.81]", "gravity = [0, 0, \"down\"]", "scene.gravity: is a string"},
    {"velocity = [0, 0, -1]", "velocity = [0, 0, nan]", "fluid.body.0.velocity: nan"},
    {"max = [2, 2, 2]", "max = [2, 0, 2]", "scene.domain.min: is not below max along y"},
    {"melting_range = [40, 60]", "melting_range = [60, 40]", "does not rise"},
    {"normal = [0, 0, 1]", "normal = [0, 0, 0]", "has no length"},
    // missing
    {"end_time = 0.4\n", "", "s.toml:41:1: run.end_time: missing; give the simulated time"},
    {"particles = 1000\n", "", "s.toml:8:1: fluid.particles: missing; give particles (how many) or spacing"},
    {"initial = { bottom = 20.0, top = 90.0 }", "", "fluid.heat.initial: missing"},
    {"initial = { bottom = 20.0, top = 90.0 }", "initial = { bottom = 20.0 }", "fluid.heat.initial.top: missing"},
    {"consistency = 20.0\n", "", "consistency: missing; give it, or dimensionless"},
    {"jump_number = [15, 150]\n", "", "jump_number: missing"},
    {"radius = 0.9, ", "", "boundary.1.cylinder.radius: missing"},
    {"plane = { point = [0, 0, 0], normal = [0, 0, 1] }\n", "",
     "s.toml:32:1: boundary.0: has no shape; add one of mesh, sphere"},
    {"domain = { min = [0, 0, 0], max = [2, 2, 2] }\n", "",
     "s.toml:5:12: scene.periodic: needs the size of the period"},
    // contradictions
    {"particles = 1000", "particles = 1000\nspacing = 0.1", "fluid.spacing: stands beside particles"},
    {"density = 1200.0", "density = 1200.0\nsphere = { center = [1, 1, 1], radius = 1 }", "stands beside a shape"},
    {"density = 1200.0", "density = 1200.0\nvelocity = [0, 0, 1]", "fluid.velocity: stands beside bodies"},
    {"slip = 0.5", "slip = 0.5\nbox = { min = [0, 0, 0], max = [1, 1, 1] }", "is a second shape beside"},
    {"slip = 0.5", "inside = true", "boundary.0.inside: is for closed shapes"},
    {"slip = 0.5", "temperature = 20", "boundary.0.temperature: has no effect without wall support"},
    {"slip = 0.5", "ground = { diffusivity = 1e-6, thickness = 1 }", "boundary.0.ground: leads to no temperature; add"},
    {"slip = 0.5", "temperature = 20\nground = { thickness = 1 }", "boundary.0.ground.diffusivity: missing"},
    {"slip = 0.5", "height = 0.5", "boundary.0.height: goes with mesh"},
    {"slip = 0.5", "cell_size = 0.5", "boundary.0.cell_size: goes with terrain"},
    {"sphere = { center = [1, 1, 1], radius = 0.5 }", "plane = { point = [0, 0, 0], normal = [0, 0, 1] }",
     "put it into a [[boundary]]"},
    {"model = \"smd\"\n", "", "s.toml:21:5: fluid.rheology.n: belongs to model \"smd\""},
    {"n = 0.5", "viscosity = 0.5", "viscosity: belongs to model \"newtonian\""},
    {"yield_stress = 60.0", "dimensionless = true", "consistency: is 1 when dimensionless"},
    {"jump_number = [15, 150]", "jump_number = [150, 15]", "does not rise from hot to cold"},
    {"melting_range = [40, 60]\n", "", "s.toml:23:15: fluid.rheology.jump_number: differs between hot and cold"},
    {"kernel = \"gaussian\"", "gamma = 7", "numerics.gamma: has no effect with state_equation"},
    {"xsph = { epsilon = 0.4 }", "xsph = true", "true says too little"},
    {"xsph = { epsilon = 0.4 }", "shifting = true", "numerics.shifting: needs corrected gradients; add gradient_cor"},
    {"xsph = { epsilon = 0.4 }", "gradient_correction = true\nshifting = { strength = 0 }",
     "numerics.shifting.strength: 0 is out of range"},
    {"xsph = { epsilon = 0.4 }", "gradient_correction = true\nshifting = { coupling = 11 }",
     "numerics.shifting.coupling: 11 is out of range"},
    {"xsph = { epsilon = 0.4 }", "density_filter = true", "numerics.density_filter: true says too little"},
    {"xsph = { epsilon = 0.4 }", "density_filter = { every = 0 }", "numerics.density_filter.every: 0"},
    {"xsph = { epsilon = 0.4 }", "density_filter = { every = 5 }\ndensity = \"summation\"", "has nothing to do"},
    {"xsph = { epsilon = 0.4 }", "state_equation = \"ideal_gas\"\nstiffness = 3\nsound_speed = 2",
     "numerics.sound_speed: of an ideal gas is the root"},
    {"xsph = { epsilon = 0.4 }", "stiffness = 3", "numerics.stiffness: belongs to state_equation \"ideal_gas\""},
    {"xsph = { epsilon = 0.4 }", "density = \"summation\"\nwall_support = true",
     "s.toml:55:16: numerics.wall_support: "},
    {"xsph = { epsilon = 0.4 }", "density_kernel = \"poly6\"",
     "s.toml:54:18: numerics.density_kernel: is that of density"},
    {"xsph = { epsilon = 0.4 }", "particle_sound_speed = true",
     "s.toml:54:24: numerics.particle_sound_speed: is that of"},
    {"xsph = { epsilon = 0.4 }", "wall_support = true",
     "s.toml:36:1: boundary.1: wall support of a wall that is no plane"},
    // choices
    {"model = \"smd\"", "model = \"smt\"", "unknown choice \"smt\"; did you mean smd?"},
    {"kernel = \"gaussian\"", "kernel = \"wendland\"", "did you mean wendland_c2?"},
    {"preset = \"paiva\"", "preset = \"sphysics\"",
     "unknown choice \"sphysics\"; known: molten, basic, internal, paiva"},
    {"precision = \"double\"", "precision = \"half\"", "unknown choice \"half\""},
    {"periodic = [\"x\"]", "periodic = [\"w\"]", "\"w\" is no axis; this scene has x, y, z"},
    {"periodic = [\"x\"]", "periodic = [\"x\", \"x\"]", "has \"x\" twice"},
    {"periodic = [\"x\"]", "periodic = true", "give an array of strings"},
    {"fields = [\"density\", \"temperature\"]", "fields = [\"Density!\"]", "\"Density!\" is no field"},
    {"checkpoint_every = \"5 min\"", "checkpoint_every = \"soon\"",
     "s.toml:48:20: output.checkpoint_every: \"soon\" is no duration"},
    {"checkpoint_every = \"5 min\"", "checkpoint_every = \"-5 min\"", "is no duration"},
    {"checkpoint_every = \"5 min\"", "checkpoint_every = \"nan s\"", "is no duration"},
    {"checkpoint_every = \"5 min\"", "checkpoints_kept = 0", "output.checkpoints_kept"},
    // polygons
    {"[[0, 0], [0, 1], [1, 1], [1, 0]]", "[[0, 0], [1, 1], [1, 0], [0, 1]]", "cross or touch; untangle them"},
    {"[[0, 0], [0, 1], [1, 1], [1, 0]]", "[[0, 0], [0, 1]]", "has 2 points"},
    {"[[0, 0], [0, 1], [1, 1], [1, 0]]", "[[0, 0], [0, 1], [1, 0], [0, 0]]", "stands twice in a row"},
    {"[[0, 0], [0, 1], [1, 1], [1, 0]]", "[[0, 0], [1, 1], [2, 2]]", "encloses nothing"},
    {"[[0, 0], [0, 1], [1, 1], [1, 0]]", "[[0, 0], [0, 1, 3], [1, 1]]", "no pair"},
    {"bottom = 0, top = 0.1", "bottom = 0.1, top = 0.1", "is not below top"},
    {"bottom = 0, top = 0.1", "top = 0.1", "polygon.bottom: missing"},
    // syntax
    {"density = 1200.0", "density = ", "s.toml:10:"},
    {"density = 1200.0", "density = 12,0", "not valid TOML"},
    {"density = 1200.0", "density = 1\ndensity = 2", "s.toml:11:"},
    {"title = \"A good scene\"", "title = A good scene", "s.toml:3:"},
    {"title = \"A good scene\"", "title = \"\xFF\xFE\"", "s.toml:3:"},
};

TEST(SceneMistakes, MistakesAreNamedWithPlaceAndRemedy) {
  for (const Mistake& mistake : mistakes) {
    SCOPED_TRACE(mistake.to);
    const std::string message = complaint(replaced(good, mistake.from, mistake.to));
    expect_complaint(message, mistake.fragment);
    EXPECT_EQ(message.rfind("s.toml:", 0), 0U) << message;
  }
}

TEST(SceneMistakes, MistakesInTwoDimensions) {
  const std::string box = "box = { min = [0, 0], max = [1, 2] }";
  const std::vector<Mistake> cases = {
      {"dimensions = 2", "dimensions = 4", "scene.dimensions: 4 does not do; give a whole number from 2 to 3"},
      {"dimensions = 2", "dimensions = 3", "fluid.box.min: has 2 entries; give 3 numbers"},
      {"dimensions = 2", "dimensions = 2\ngravity = [0, 0, -9.81]", "scene.gravity: has 3 entries; give 2"},
      {"dimensions = 2", "dimensions = 2\nperiodic = [\"z\"]", "\"z\" is no axis; this scene has x, y"},
      {box.c_str(), "mesh = \"a.obj\"", "fluid.mesh: is for 3-D scenes"},
      {box.c_str(), "polygon = { points = [[0, 0], [1, 0], [0, 1]], bottom = 0 }", "polygon.bottom: is for 3-D scenes"},
      {box.c_str(), "cone = { base = [0, 0], radius = 0, height = 1 }", "0 at both ends"},
      {box.c_str(), "", "fluid: has no shape"},
      {"[run]", "[fluid.heat]\ndiffusivity = 1\nmelting_range = [1, 2]\ninitial = 1\n[run]", "acts on the jump_number"},
      {"[run]", "[fluid.rheology]\nmodel = \"newtonian\"\n[run]", "fluid.rheology.viscosity: missing"},
      {"[run]", "[[fluid.body]]\nbox = { min = [0, 0], max = [1, 2] }\ntemperature = 3\n[run]",
       "stands beside a shape"},
      {"[run]", "[[boundary]]\nterrain = \"a.asc\"\n[run]", "terrain: is for 3-D scenes"},
      {"[run]\nend_time = 1", "", "run: missing; add [run]"},
  };
  for (const Mistake& mistake : cases) {
    expect_complaint(complaint(replaced(flat, mistake.from, mistake.to)), mistake.fragment);
  }
  expect_complaint(complaint(""), "fluid: missing");
}

}  // namespace
}  // namespace molten::scene_mistakes_test
