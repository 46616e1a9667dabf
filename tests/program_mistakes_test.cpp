// Mistakes in scenes, files and places: for each an exit code and one line that helps, with nothing half made.
#include <fmt/format.h>

#include "tests/program.h"

namespace molten::program_mistakes_test {
namespace {

namespace fs = std::filesystem;

using BadScene = ProgramTest;
using BadFile = ProgramTest;
using BadPlace = ProgramTest;

// ---- scenes: 2 ------------------------------------------------------------------------------------------------------

TEST_F(BadScene, UnknownKey) {
  expect_bad(replaced(block_scene, "spacing", "spacin"), 2, {"my scene.toml:6:1: ", "spacin"});
  expect_bad(block_scene + "[numeric]\n", 2, {"numeric"});
}

TEST_F(BadScene, WrongType) {
  expect_bad(replaced(block_scene, "spacing = 0.02", "spacing = \"small\""), 2, {":6:", "fluid.spacing"});
  expect_bad(replaced(block_scene, "dimensions = 2", "dimensions = 2.5"), 2, {":3:", "scene.dimensions"});
}

TEST_F(BadScene, NumbersThatAreNone) {
  for (const char* bad : {"nan", "inf", "-0.02", "0", "1e31"})
    expect_bad(replaced(block_scene, "spacing = 0.02", std::string("spacing = ") + bad), 2, {":6:", "fluid.spacing"});
  expect_bad(replaced(block_scene, "viscosity = 5.0", "viscosity = -1.0"), 2, {"viscosity"});
}

TEST_F(BadScene, Missing) {
  expect_bad(replaced(block_scene, "end_time = 0.04", ""), 2, {"end_time"});
  expect_bad("", 2, {"my scene.toml"});
  expect_bad("\n\n", 2, {"my scene.toml"});
  expect_refused(molten_program({"run", (folder.path() / "none.toml").string()}), 2, {"none.toml", "no such"});
  expect_refused(molten_program({"run", folder.path().string()}), 2, {"folder"});
}

TEST_F(BadScene, EmptyNames) {
  for (const char* command : {"run", "resume", "check", "info", "render"})
    expect_refused(molten_program({command, ""}), 2, {"is empty; name a file or folder", command});
}

TEST_F(BadScene, Garbage) {
  std::string bytes;
  for (int k = 0; k < 5000; ++k) bytes.push_back(static_cast<char>(k * 37 + k / 7));
  expect_bad(bytes, 2, {"my scene.toml"});
  expect_bad(std::string(3, '\0') + block_scene, 2, {"my scene.toml"});
  expect_bad("[scene\ntitle = 3", 2, {"my scene.toml:1"});
}

TEST_F(BadScene, Contradictions) {
  expect_bad(
      replaced(block_scene, "[run]", "[fluid.heat]\ndiffusivity = 1e-4\ninitial = 3\nmelting_range = [1, 2]\n[run]"), 2,
      {"melting_range"});
  expect_bad(replaced(block_scene, "spacing = 0.02", "spacing = 0.02\nparticles = 100"), 2, {"particles"});
}

TEST_F(BadScene, FieldsThatItHasNot) {
  expect_bad(block_scene + "fields = [\"temperature\"]\n", 2, {"output.fields", "temperature"});
}

TEST_F(BadScene, MoreParticlesThanMemory) {
  expect_bad(replaced(block_scene, "spacing = 0.02", "spacing = 1.1e-6"), 2, {"particles", "GB"});
  expect_bad(replaced(block_scene, "spacing = 0.02", "particles = 2000000000"), 2, {"particles", "GB"});
  const std::string ball =
      "[fluid]\nsphere = { center = [0, 0, 1], radius = 0.9 }\nspacing = 1e-6\n[run]\nend_time = 1\n";
  expect_bad(ball, 2, {"particles", "GB"});
}

TEST_F(BadScene, OverridesWithMistakes) {
  const auto with = [&](const std::string& set) { return std::vector<std::string>{"--set", set}; };
  expect_bad(block_scene, 2, {"--set", "x"}, with("x"));
  expect_bad(block_scene, 2, {"--set", "fluid.densit"}, with("fluid.densit=1"));
  expect_bad(block_scene, 2, {"fluid.density"}, with("fluid.density=heavy"));
  expect_bad(block_scene, 2, {"fluid.density"}, with("fluid.density="));
  expect_bad(block_scene, 2, {"boundary"}, with("boundary.7.slip=1"));
  expect_bad(block_scene, 2, {"fluid.density"}, with("fluid.density=nan"));
  expect_bad(block_scene, 2, {"--set"}, with("=3"));
  expect_bad(block_scene, 2, {"--set"}, with("fluid..density=3"));
}

// ---- meshes, grids and overlaps: 3 ----------------------------------------------------------------------------------

std::string inside_out(const std::string& mesh) {
  std::string flipped;
  std::istringstream in(mesh);
  for (std::string line; std::getline(in, line);) {
    int a = 0, b = 0, c = 0;
    if (std::sscanf(line.c_str(), "f %d %d %d", &a, &b, &c) == 3) line = fmt::format("f {} {} {}", a, c, b);
    flipped += line + "\n";
  }
  return flipped;
}

TEST_F(BadFile, MissingMesh) {
  expect_bad(mesh_scene("nowhere.obj"), 3, {"my scene.toml:2:", "nowhere.obj: check the path"});
  expect_bad(mesh_scene("models/nowhere.obj"), 3, {"my scene.toml:2:", "models/nowhere.obj", "scripts/models"});
  expect_bad(replaced(mesh_scene("none"), "mesh = \"none\"", "box = { min = [0, 0, 0], max = [1, 1, 1] }") +
                 "[[boundary]]\nterrain = \"models/nowhere.json\"\n",
             3, {"my scene.toml:7:", "models/nowhere.json", "scripts/models"});
}

TEST_F(BadFile, MeshesThatEncloseNothing) {
  const auto expect_bad_mesh = [&](const std::string& bytes, const std::string& why) {
    file("a mesh.obj", bytes);
    expect_bad(mesh_scene("a mesh.obj"), 3, {"a mesh.obj", why});
  };
  expect_bad_mesh(cube_obj.substr(0, cube_obj.find("f 4 5 8")), "not closed");
  expect_bad_mesh(inside_out(cube_obj), "inside out");
  expect_bad_mesh(replaced(cube_obj, "f 4 5 8", "f 4 8 5"), "opposite ways");
  expect_bad_mesh("", "empty");
  expect_bad_mesh("v 0 0 0\nv 1 0 0\n", "");
  expect_bad_mesh(cube_obj.substr(0, cube_obj.size() - 4), "");
  expect_bad_mesh(replaced(cube_obj, "f 4 5 8", "f 4 5 99"), "");
  expect_bad_mesh(replaced(cube_obj, "v 1 1 1", "v 1 nan 1"), "");
}

TEST_F(BadFile, RaggedGrid) {
  const std::string scene_text =
      "[fluid]\nsphere = { center = [1, 1, 5], radius = 0.5 }\nspacing = 0.2\n[[boundary]]\nterrain = \"hill.asc\"\n"
      "[run]\nend_time = 0.001\n";
  const std::string grid = "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3\n4 5 6\n";
  expect_bad(scene_text, 3, {"hill.asc", "no such"});
  file("hill.asc", grid + "7 8\n");
  expect_bad(scene_text, 3, {"hill.asc"});
  file("hill.asc", grid + "7 8 x\n");
  expect_bad(scene_text, 3, {"hill.asc"});
}

TEST_F(BadFile, FluidInsideAWall) {
  expect_bad(replaced(block_scene, "point = [0, 0]", "point = [0, 0.1]"), 3, {"particles start inside", "spacing"});
  const std::string twice = replaced(block_scene, "box = { min = [0.0, 0.02], max = [0.2, 0.3] }\nspacing = 0.02",
                                     "spacing = 0.02\n[[fluid.body]]\nbox = { min = [0.0, 0.1], max = [0.2, 0.3] }\n"
                                     "[[fluid.body]]\nbox = { min = [0.1, 0.1], max = [0.3, 0.3] }");
  expect_bad(twice, 3, {"overlap"});
}

// ---- places: 5 ------------------------------------------------------------------------------------------------------

TEST_F(BadPlace, BelowAFile) {
  file("a file", "x");
  const std::string below = (folder.path() / "a file/run").string();
  expect_refused(molten_program({"run", scene().string(), "-o", below}), 5, {below});
  expect_refused(molten_program({"run", scene().string(), "-o", file("a file", "x")}), 5, {"a file"});
  EXPECT_EQ(read_bytes(folder.path() / "a file"), "x");
}

TEST_F(BadPlace, HoldsARunAlready) {
  ASSERT_EQ(run(block_scene).code, 0);
  const std::string series = read_bytes(out / "series.csv");
  expect_refused(run(block_scene), 5, {out.string(), "--overwrite", "molten resume"});
  EXPECT_EQ(read_bytes(out / "series.csv"), series);
  EXPECT_EQ(run(replaced(block_scene, "end_time = 0.04", "end_time = 0.01"), {"--overwrite"}).code, 0);
  EXPECT_FALSE(fs::exists(out / "frames/000002.hdf"));
}

TEST_F(BadPlace, NothingToLookAt) {
  const std::string none = (folder.path() / "none").string();
  expect_refused(molten_program({"info", none}), 5, {none});
  expect_refused(molten_program({"render", none}), 5, {none});
  expect_refused(molten_program({"compare", none, none}), 5, {none});
  expect_refused(molten_program({"info", scene().string()}), 2, {".hdf"});
  expect_refused(molten_program({"info", file("a.hdf", "x")}), 5, {"a.hdf"});
  expect_refused(molten_program({"info", file("a.h5", "x")}), 6, {"a.h5"});
  expect_refused(molten_program({"info", file("a.obj", "x")}), 3, {"a.obj"});
}

// ---- streams and environment ---------------------------------------------------------------------------------------

/// The program in a shell's command line: $M stands for it.
Outcome in_shell(const std::string& line) {
  return Program({"-c", fmt::format("M='{}'; {}", MOLTEN_PROGRAM, line)}, {}, "/bin/sh").wait();
}

TEST_F(BadPlace, ARunOutlivesWhoeverListens) {
  const std::string run = fmt::format("$M run '{}' -o '{}' --overwrite ", scene().string(), out.string());
  for (const char* streams : {"2>/dev/full", "2>&- >&- <&-", "2>&1 | true"}) {
    fs::remove_all(out);
    EXPECT_EQ(in_shell(run + streams).code, 0) << streams;
    for (int k = 0; k < 2000 && !fs::exists(out / "summary.json"); ++k)  // a pipe's end does not wait for its beginning
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_TRUE(contains(read_bytes(out / "summary.json"), "\"done\"")) << streams;
    EXPECT_TRUE(contains(read_bytes(out / "series.csv"), "kinetic")) << "a stream's words went into a file";
  }
}

TEST_F(BadPlace, OutputThatIsNotTaken) {
  EXPECT_EQ(in_shell(fmt::format("$M check '{}' >/dev/full", scene().string())).code, 5);
  EXPECT_EQ(in_shell("$M --help >/dev/full").code, 5);
  EXPECT_EQ(in_shell("$M --help >/dev/null").code, 0);
}

TEST_F(BadPlace, MoreThreadsThanThereCanBe) {
  expect_refused(in_shell(fmt::format("OMP_NUM_THREADS=99999 $M check '{}'", scene().string())), 2,
                 {"OMP_NUM_THREADS", "99999", "4096"});
}

TEST_F(BadPlace, NothingToResume) {
  const std::string none = (folder.path() / "none").string();
  expect_refused(molten_program({"resume", none}), 6, {none, "no such folder"});
}

}  // namespace
}  // namespace molten::program_mistakes_test
