// Scene files: what a good one means, how overrides change it, and that no text of any kind does harm.
#include "io/scene/scene_file.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/scene_texts.h"
#include "tests/temp_folder.h"

namespace molten::scene_file_test {
namespace {

using namespace scene_texts;

// ---- good scenes ------------------------------------------------------------------------------------------------

TEST(SceneFile, ReadsEverything) {
  const Scene scene = parse_scene(good, "folder/s.toml");
  EXPECT_EQ(scene.title, "A good scene");
  EXPECT_EQ(scene.dimensions, 3);
  EXPECT_TRUE(scene.periodic[0] && !scene.periodic[1] && !scene.periodic[2]);
  EXPECT_EQ(scene.domain->max[2], 2);
  EXPECT_EQ(scene.fluid.particles, 1000);
  EXPECT_FALSE(scene.fluid.spacing);
  EXPECT_EQ(scene.fluid.density, 1200);
  EXPECT_EQ(scene.fluid.place.line, 8);
  ASSERT_EQ(scene.fluid.bodies.size(), 2U);
  EXPECT_EQ(scene.fluid.bodies[0].shape.sphere->radius, 0.5);
  EXPECT_EQ(scene.fluid.bodies[0].shape.place.line, 13);
  EXPECT_EQ(scene.fluid.bodies[0].velocity[2], -1);
  EXPECT_EQ(scene.fluid.bodies[0].temperature, 80);
  EXPECT_FALSE(scene.fluid.bodies[1].temperature);
  EXPECT_FALSE(scene.fluid.bodies[0].diffusivity);
  const Scene own = parse_scene(replaced(good, "temperature = 80", "diffusivity = 2e-4"), "s.toml");
  EXPECT_EQ(own.fluid.bodies[0].diffusivity, 2e-4);
  EXPECT_EQ(scene.fluid.rheology.model, Rheology::Model::smd);
  EXPECT_EQ(scene.fluid.rheology.jump_number, (std::array<double, 2>{15, 150}));
  EXPECT_EQ(scene.fluid.rheology.yield_stress, 60);
  EXPECT_EQ(scene.fluid.rheology.consistency, 20);
  EXPECT_EQ(scene.fluid.heat->diffusivity, 1e-4);
  EXPECT_EQ((*scene.fluid.heat->melting_range)[1], 60);
  EXPECT_EQ(scene.fluid.heat->initial_top, 90);
  ASSERT_EQ(scene.boundaries.size(), 2U);
  EXPECT_EQ(scene.boundaries[0].slip, 0.5);
  EXPECT_EQ(scene.boundaries[0].shape.plane->normal[2], 1);
  EXPECT_TRUE(scene.boundaries[1].inside);
  EXPECT_EQ(scene.boundaries[1].restitution, 0.2);
  EXPECT_EQ(scene.run.end_time, 0.4);
  EXPECT_EQ(scene.run.max_steps, 100);
  EXPECT_EQ(scene.output.frames_per_second, 50);
  EXPECT_EQ(scene.output.fields, (std::vector<std::string>{"density", "temperature"}));
  EXPECT_EQ(scene.output.checkpoint_every, 300);
  EXPECT_EQ(scene.text, good);
}

TEST(SceneFile, WallsWithSupport) {
  const std::string keys =
      "slip = 0.5\nvelocity = [0.1, 0, 0]\ntemperature = 30\n"
      "ground = { diffusivity = 1e-6, thickness = 0.2 }";
  std::string text = replaced(good, "slip = 0.5", keys);
  text = replaced(text, "periodic = [\"x\"]\n", "");
  text = replaced(text, "[numerics]", "[numerics]\nwall_support = true\ndensity_diffusion = 0.1");
  const Scene scene = parse_scene(replaced(text, "density = 1200.0", "density = 1200.0\nhydrostatic = true"), "s.toml");
  EXPECT_TRUE(scene.fluid.hydrostatic);
  EXPECT_TRUE(scene.numerics.wall_support);
  EXPECT_EQ(scene.numerics.density_diffusion, 0.1);
  EXPECT_EQ(scene.boundaries[0].velocity[0], 0.1);
  EXPECT_EQ(scene.boundaries[0].temperature, 30);
  EXPECT_EQ(scene.boundaries[0].ground->diffusivity, 1e-6);
  EXPECT_EQ(scene.boundaries[0].ground->thickness, 0.2);
  EXPECT_FALSE(scene.boundaries[1].temperature);
}

TEST(SceneFile, PresetThenOverridesOfItsKeys) {
  const Numerics numerics = parse_scene(good, "s.toml").numerics;
  EXPECT_EQ(numerics.preset, "paiva");
  EXPECT_EQ(numerics.precision, Precision::double_);
  EXPECT_EQ(numerics.kernel, KernelKind::gaussian);
  EXPECT_EQ(numerics.state_equation, StateEquation::linear);
  EXPECT_EQ(numerics.xsph->form, Xsph::Form::velocity);
  EXPECT_EQ(numerics.xsph->epsilon, 0.4);
  EXPECT_EQ(numerics.courant_sound, 0.15);
  EXPECT_EQ(numerics.courant_viscous, 0.0125);
  EXPECT_FALSE(parse_scene(replaced(good, "xsph = { epsilon = 0.4 }", "xsph = false"), "s.toml").numerics.xsph);
}

TEST(SceneFile, TheDefaultPresetCorrectsSmoothFlows) {
  const auto corrects = [](const std::vector<std::string>& overrides) {
    const Numerics n = parse_scene(flat, "s.toml", overrides).numerics;
    EXPECT_EQ(n.gradient_correction, n.shifting.has_value());
    return n.gradient_correction;
  };
  EXPECT_FALSE(corrects({})) << "water that falls";
  EXPECT_TRUE(corrects({"scene.gravity=[0, 0]"}));
  EXPECT_TRUE(corrects({"fluid.rheology.viscosity=1"}));
  EXPECT_TRUE(corrects({"scene.periodic=[\"x\"]", "scene.domain={ min = [-9, -9], max = [9, 9] }"}));
  EXPECT_FALSE(
      corrects({"fluid.rheology={ model = \"smd\", yield_stress = 1, consistency = 1, n = 1, jump_number = 9 }"}));
  EXPECT_FALSE(corrects({"fluid.rheology.viscosity=1", "numerics.preset=\"basic\""}));
  EXPECT_FALSE(corrects({"fluid.rheology.viscosity=1", "numerics.sleep={}"}));
  EXPECT_FALSE(corrects({"fluid.rheology.viscosity=1", "numerics.boundary_particles.kind=\"dynamic\""}));
  const Numerics still =
      parse_scene(flat, "s.toml", {"scene.gravity=[0, 0]", "fluid.heat={ diffusivity = 1, initial = 20 }"}).numerics;
  EXPECT_TRUE(still.gradient_correction && !still.shifting) << "only heat flows";
}

TEST(SceneFile, CorrectedGradientsAndShifting) {
  const auto numerics = [](const std::string& lines) {
    return parse_scene(replaced(good, "xsph = { epsilon = 0.4 }", lines), "s.toml").numerics;
  };
  EXPECT_FALSE(numerics("").gradient_correction);
  EXPECT_FALSE(numerics("gradient_correction = true").shifting);
  EXPECT_EQ(numerics("gradient_correction = true").stress_form, StressForm::summed);
  EXPECT_EQ(numerics("gradient_correction = true").laplacian, LaplacianForm::conservative);
  EXPECT_EQ(numerics("laplacian = \"consistent\"\ngradient_correction = true").laplacian, LaplacianForm::consistent);
  EXPECT_EQ(numerics("stress_form = \"pairwise\"\ngradient_correction = true").stress_form, StressForm::pairwise);
  EXPECT_EQ(numerics("gradient_correction = true\nshifting = true").shifting->strength, Shifting{}.strength);
  EXPECT_EQ(numerics("gradient_correction = true\nshifting = { strength = 3 }").shifting->strength, 3);
  EXPECT_EQ(numerics("gradient_correction = true\nshifting = { coupling = 0 }").shifting->coupling, 0);
  const std::string internal = replaced(flat, "[run]", "[numerics]\npreset = \"internal\"\nshifting = false\n[run]");
  EXPECT_TRUE(parse_scene(internal, "s.toml").numerics.gradient_correction);
  EXPECT_FALSE(parse_scene(internal, "s.toml").numerics.shifting);
}

TEST(SceneFile, DensityAndStateEquation) {
  const auto numerics = [](const std::string& lines) {
    return parse_scene(replaced(flat, "[run]", "[numerics]\n" + lines + "\n[run]"), "s.toml").numerics;
  };
  EXPECT_FALSE(numerics("").density_filter);
  EXPECT_EQ(numerics("density = \"summation\"").density, DensityForm::summation);
  EXPECT_EQ(numerics("density_filter = { kind = \"mls\", every = 20 }").density_filter->every, 20);
  EXPECT_EQ(numerics("density_filter = { kind = \"mls\" }").density_filter->kind, DensityFilter::Kind::mls);
  EXPECT_FALSE(numerics("density_filter = false").density_filter);
  EXPECT_EQ(numerics("state_equation = \"ideal_gas\"\nstiffness = 3").stiffness, 3);
  const Numerics queiroz = numerics("preset = \"queiroz\"\ndensity = \"continuity\"");
  EXPECT_FALSE(queiroz.density_kernel) << "goes with the summation of the preset";
  EXPECT_EQ(numerics("preset = \"queiroz\"").density_kernel, KernelKind::poly6);
  EXPECT_EQ(numerics("integrator = \"runge_kutta_4\"").integrator, IntegratorKind::runge_kutta_4);
}

TEST(SceneFile, SleepIsAbsentUnlessAskedFor) {
  EXPECT_FALSE(parse_scene(good, "s.toml").numerics.sleep);
  const auto bare = parse_scene(good, "s.toml", {"numerics.sleep={}"}).numerics.sleep;
  ASSERT_TRUE(bare);
  EXPECT_FALSE(bare->speed || bare->density_rate || bare->temperature_rate || bare->after);
  const auto full = parse_scene(good, "s.toml",
                                {"numerics.sleep={ speed = 0.1, density_rate = 2, temperature_rate = 0, after = 0.5 }"})
                        .numerics.sleep;
  ASSERT_TRUE(full);
  EXPECT_EQ(full->speed, 0.1);
  EXPECT_EQ(full->density_rate, 2);
  EXPECT_EQ(full->temperature_rate, 0);
  EXPECT_EQ(full->after, 0.5);
}

TEST(SceneFile, DesignExampleParsesAsPrinted) {
  const Scene scene = parse_scene(design, "s.toml");
  EXPECT_EQ(scene.title, "Bunny melts from the ears down");
  EXPECT_EQ(scene.dimensions, 3);
  EXPECT_EQ(scene.gravity, (std::array<double, 3>{0, 0, -9.81}));
  ASSERT_TRUE(scene.fluid.bodies.at(0).shape.mesh);
  EXPECT_EQ(scene.fluid.bodies[0].shape.mesh->path, "models/bunny.obj");
  EXPECT_EQ(scene.fluid.bodies[0].shape.mesh->height, 0.15);
  EXPECT_EQ(scene.fluid.particles, 10188);
  EXPECT_EQ(scene.fluid.rheology.jump_number[1], 150);
  EXPECT_EQ(scene.boundaries.size(), 1U);
  EXPECT_EQ(scene.output.checkpoint_every, 300);
  EXPECT_EQ(scene.fluid.bodies[0].shape.place.line, 2);
  EXPECT_EQ(scene.fluid.bodies[0].shape.place.column, 21);
  // What is stored is plain TOML of the same meaning.
  EXPECT_NE(scene.text.find("[run]\n"), std::string::npos);
  EXPECT_EQ(parse_scene(scene.text, "s.toml").fluid.particles, 10188);
}

/// The example of the reference page is a scene.
TEST(SceneFile, DocumentedExampleParses) {
  const std::string page = read_bytes(std::filesystem::path(MOLTEN_SOURCE_DIR) / "docs/scenes.md");
  const std::size_t begin = page.find("```toml\n") + 8;
  EXPECT_EQ(complaint(page.substr(begin, page.find("```", begin) - begin)), "");
}

TEST(SceneFile, SideBySidePlacesAreThoseOfTheFile) {
  expect_complaint(complaint(replaced(design, "consistency = 20.0", "consistenzy = 20.0")),
                   "s.toml:3:89: fluid.rheology.consistenzy");
  expect_complaint(complaint(replaced(design, "slip = 0.0", "slip = 0.0.0")), "s.toml:5:");
  expect_complaint(complaint(replaced(design, "Bunny melts", "Büñny mélts") + "[numerics] skin = 0.1 skinn = 2"),
                   "s.toml:8:23");
}

TEST(SceneFile, TwoDimensions) {
  const Scene scene = parse_scene(flat, "dam.toml");
  EXPECT_EQ(scene.title, "dam");
  EXPECT_EQ(scene.gravity, (std::array<double, 3>{0, -9.81, 0}));
  EXPECT_EQ(scene.fluid.bodies.at(0).shape.box->max[1], 2);
  EXPECT_EQ(scene.fluid.spacing, 0.03);
  EXPECT_EQ(scene.fluid.rheology.model, Rheology::Model::newtonian);
  EXPECT_EQ(scene.fluid.rheology.viscosity, 0);
  EXPECT_FALSE(scene.fluid.heat);
  for (const std::string shape :
       {"sphere = { center = [0, 1], radius = 1 }", "cone = { base = [0, 0], radius = 1, height = 1 }",
        "cylinder = { base = [0, 0], radius = 1, height = 1 }", "polygon = { points = [[0, 0], [1, 0], [0, 1]] }"}) {
    EXPECT_EQ(complaint(replaced(flat, "box = { min = [0, 0], max = [1, 2] }", shape)), "");
  }
}

TEST(SceneFile, PolygonsAreTurnedCounterClockwise) {
  const Polygon polygon = *parse_scene(good, "s.toml").fluid.bodies[1].shape.polygon;
  EXPECT_EQ(polygon.points[0], (std::array<double, 2>{1, 0}));
  EXPECT_EQ(polygon.points[1], (std::array<double, 2>{1, 1}));
}

TEST(SceneFile, DimensionlessRheology) {
  const std::string text =
      replaced(replaced(good, "yield_stress = 60.0\n", ""), "consistency = 20.0", "dimensionless = true");
  const Rheology rheology = parse_scene(text, "s.toml").fluid.rheology;
  EXPECT_EQ(rheology.yield_stress, 1);
  EXPECT_EQ(rheology.consistency, 1);
}

TEST(SceneFile, Durations) {
  const std::vector<std::pair<std::string, double>> cases = {{"90", 90},          {"0", 0},           {"1.5", 1.5},
                                                             {"\"30 s\"", 30},    {"\"5 min\"", 300}, {"\"5min\"", 300},
                                                             {"\"1.5 h\"", 5400}, {"\"12\"", 12}};
  for (const auto& [text, seconds] : cases) {
    EXPECT_EQ(parse_scene(replaced(good, "\"5 min\"", text), "s.toml").output.checkpoint_every, seconds) << text;
  }
}

TEST(SceneFile, ByteOrderMarkAndWindowsLines) {
  std::string text = "\xEF\xBB\xBF";
  for (const char c : design) text += c == '\n' ? "\r\n" : std::string(1, c);
  EXPECT_EQ(complaint(text), "");
}

// ---- overrides --------------------------------------------------------------------------------------------------

TEST(SceneFile, OverridesReplaceAddAndReachIntoArrays) {
  const Scene scene = parse_scene(good, "s.toml",
                                  {"fluid.density=900", "boundary.0.slip=0.25", "fluid.body.1.velocity=[1, 2, 3]",
                                   "scene.gravity.2=-1.62", "numerics.precision=single", "numerics.skin = 0.3",
                                   "output.checkpoint_every=\"1 h\"", "fluid.body.0.sphere.radius=0.125"});
  EXPECT_EQ(scene.fluid.density, 900);
  EXPECT_EQ(scene.boundaries[0].slip, 0.25);
  EXPECT_EQ(scene.fluid.bodies[1].velocity[1], 2);
  EXPECT_EQ(scene.gravity[2], -1.62);
  EXPECT_EQ(scene.numerics.precision, Precision::single);
  EXPECT_EQ(scene.numerics.skin, 0.3);
  EXPECT_EQ(scene.output.checkpoint_every, 3600);
  EXPECT_EQ(scene.fluid.bodies[0].shape.sphere->radius, 0.125);
}

TEST(SceneFile, OverriddenTextReadsBackTheSame) {
  const Scene scene = parse_scene(good, "s.toml", {"fluid.heat.diffusivity=2.3e-7", "run.end_time=0.1"});
  const Scene again = parse_scene(scene.text, "s.toml");
  EXPECT_EQ(again.fluid.heat->diffusivity, 2.3e-7);
  EXPECT_EQ(again.run.end_time, 0.1);
  EXPECT_EQ(again.fluid.bodies.size(), 2U);
  EXPECT_EQ(parse_scene(again.text, "s.toml", {"run.end_time=0.1"}).text, scene.text);
}

TEST(SceneFile, OverridesCreateTables) {
  EXPECT_EQ(parse_scene(flat, "s.toml", {"numerics.courant.sound=0.05"}).numerics.courant_sound, 0.05);
}

TEST(SceneFile, BadOverrides) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"fluid.density", "--set fluid.density: no value"},
      {"=3", "not a key"},
      {"fluid..density=3", "not a key"},
      {"fluid.density=", "not one TOML value"},
      {"fluid.density=1 2", "not one TOML value"},
      {"fluid.density=1\nx=2", "not one TOML value"},
      {"fluid.density=-1", "--set fluid.density=-1: fluid.density: -1 is out of range"},
      {"fluid.densty=1", "fluid.densty: unknown key; did you mean density?"},
      {"fluid.density=high", "is a string"},
      {"boundary.7.slip=0", "there are only 2, counted from 0"},
      {"boundary.first.slip=0", "first is no index"},
      {"boundary.0.slip.x=0", "plain value"},
      {"scene.gravity.3=0", "there are only 3"},
      {std::string(5000, 'a') + "=1", "unknown key"},
      {"fluid.x=" + std::string(5000, '['), "not one TOML value"},
  };
  for (const auto& [text, fragment] : cases) expect_complaint(complaint(good, {text}), fragment);
}

// ---- files ------------------------------------------------------------------------------------------------------

TEST(SceneFile, ReadsFilesAndLocatesTheirs) {
  const TempFolder temp;
  const std::filesystem::path folder = temp.path(), dam = folder / "sub/dam.toml";
  std::filesystem::create_directory(folder / "sub");
  write_bytes(dam, flat);
  for (const std::string name : {"above.obj", "both.obj", "sub/both.obj"}) write_bytes(folder / name, "");
  const Scene scene = read_scene(dam, {"run.end_time=2"});
  EXPECT_EQ(scene.title, "dam");
  EXPECT_EQ(scene.run.end_time, 2);
  EXPECT_EQ(locate(scene, "above.obj"), folder / "above.obj");
  EXPECT_EQ(locate(scene, "both.obj"), folder / "sub/both.obj");
  EXPECT_EQ(locate(scene, "nowhere.obj"), folder / "sub/nowhere.obj");
  EXPECT_EQ(locate(scene, "/a/b.obj"), "/a/b.obj");
}

TEST(SceneFile, RefusesWhatIsNoScene) {
  const TempFolder temp;
  const std::filesystem::path large = temp.path() / "large.toml";
  write_bytes(large, std::string((16U << 20U) + 1, '#'));
  const auto said = [](const std::filesystem::path& file) -> std::string {
    try {
      read_scene(file);
      return "";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::usage);
      return error.what();
    }
  };
  expect_complaint(said(temp.path() / "missing.toml"), "no such scene file");
  expect_complaint(said(temp.path()), "is a folder");
  expect_complaint(said(large), "larger than 16 MB");
}

// ---- hostile text -----------------------------------------------------------------------------------------------

TEST(SceneFile, NestingEndsInOneLine) {
  std::string dotted;
  for (int i = 0; i < 1000000; ++i) dotted += "a.";
  expect_complaint(complaint("x = 1\n" + dotted + "a = 1"), "s.toml:2:1: a key with more than 32 dots");
  expect_complaint(complaint("[" + dotted + "a]"), "a key with more than 32 dots");
  expect_complaint(complaint("a = " + std::string(1000000, '[')), "not valid TOML");
  std::string tables;
  for (int i = 0; i < 100000; ++i) tables += "{a = ";
  expect_complaint(complaint("a = " + tables), "not valid TOML");
  EXPECT_EQ(complaint(replaced(good, "A good scene", std::string(100, '.'))), "");
}

/// Reads the text and asserts the contract: a scene, or one line with the right exit code.
void read_anything(const std::string& text) {
  const std::string message = complaint(text);
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  EXPECT_LT(message.size(), 2000U);
}

TEST(SceneFile, MutationsOfGoodScenesDoNoHarm) {
  std::mt19937 random(20240611);
  const auto below = [&random](std::size_t count) { return static_cast<std::size_t>(random() % count); };
  const std::string pieces[] = {"[",  "]", "{", "}",   "\"",     "'''",   "\"\"\"", "=",
                                "\n", ".", ",", "nan", "-1e999", "[[a]]", "#",      "\\u0000"};
  for (int round = 0; round < 2000; ++round) {
    std::string text = round % 2 == 0 ? good : design;
    for (std::size_t edits = 1 + below(6); edits > 0; --edits) {
      const std::size_t at = below(text.size());
      switch (below(5)) {
        case 0:
          text[at] = static_cast<char>(random());
          break;
        case 1:
          text.erase(at, 1 + below(20));
          break;
        case 2:
          text.insert(at, pieces[below(std::size(pieces))]);
          break;
        case 3:
          text.insert(at, text.substr(below(text.size()), below(60)));
          break;
        default:
          std::swap(text[at], text[below(text.size())]);
          break;
      }
    }
    read_anything(text);
  }
}

TEST(SceneFile, RandomBytesDoNoHarm) {
  std::mt19937 random(7);
  for (int round = 0; round < 2000; ++round) {
    std::string text(random() % 200, ' ');
    for (char& c : text) c = static_cast<char>(round % 2 == 0 ? random() : 32 + random() % 95);
    read_anything(text);
  }
}

}  // namespace
}  // namespace molten::scene_file_test
