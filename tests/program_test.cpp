// The program as a person meets it: its command line, what its commands print and leave behind, how a run that diverges
// ends, and signals.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>

#include "tests/program.h"
#include "tests/small_files_only.h"

namespace molten::program_test {
namespace {

namespace fs = std::filesystem;

using CommandLine = ProgramTest;
using Commands = ProgramTest;
using Diverging = ProgramTest;

// ---- the command line -----------------------------------------------------------------------------------------------

TEST_F(CommandLine, MistakesAreOneLine) {
  const std::string there = scene().string();
  const std::vector<std::vector<std::string>> mistakes = {{},
                                                          {"bogus"},
                                                          {"run"},
                                                          {"run", there, "--threads", "0"},
                                                          {"run", there, "--threads", "two"},
                                                          {"run", there, "--set"},
                                                          {"run", there, "--bogus"},
                                                          {"run", there, "-o", ""},
                                                          {"resume"},
                                                          {"compare", there},
                                                          {"render", there, "--width", "1"},
                                                          {"render", there, "--field", ""}};
  for (const auto& mistake : mistakes) {
    const Outcome o = molten_program(mistake, folder.path());
    expect_refused(o, 2, {"--help"});
    EXPECT_LT(o.err.size(), 300u) << o.err;
  }
  expect_refused(molten_program({"bogus"}, folder.path()), 2, {"bogus is no command"});
}

TEST_F(CommandLine, HelpAndVersion) {
  const Outcome help = molten_program({"--help"});
  EXPECT_EQ(help.code, 0);
  for (const char* word : {"run", "resume", "check", "info", "render", "compare", "Exit codes", "--version"})
    EXPECT_TRUE(contains(help.out, word)) << word;
  for (const char* command : {"run", "resume", "check", "info", "render", "compare"}) {
    const Outcome o = molten_program({command, "--help"});
    EXPECT_EQ(o.code, 0);
    EXPECT_TRUE(contains(o.out, command)) << o.out;
    EXPECT_EQ(o.err, "");
    EXPECT_FALSE(contains(o.out, "{false}")) << o.out;
  }
  EXPECT_EQ(molten_program({"--version"}).out.substr(0, 8), "molten 0");
}

TEST_F(CommandLine, RunsGoToRunsUnlessToldOtherwise) {
  scene(block_scene, "drop.toml");
  ASSERT_EQ(molten_program({"run", "drop.toml"}, folder.path()).code, 0);
  EXPECT_TRUE(fs::exists(folder.path() / "runs/drop/summary.json"));
}

// ---- diverging: 4 ---------------------------------------------------------------------------------------------------

/// The last line on stderr: progress comes before it.
std::string last_line(const std::string& text) {
  const std::size_t end = text.find_last_not_of('\n');
  const std::size_t begin = text.find_last_of('\n', end);
  return text.substr(begin + 1, end - begin);
}

TEST_F(Diverging, NamesParticleFieldCauseAndCheckpoint) {
  for (const char* set : {"numerics.fixed_dt=0.01", "numerics.courant={viscous=40.0,sound=40.0,force=40.0}"}) {
    fs::remove_all(out);
    const Outcome o = run(block_scene, {"--set", set, "--set", "run.end_time=2.0"});
    EXPECT_EQ(o.code, 4) << o.err;
    const std::string line = last_line(o.err);
    for (const char* part : {"molten: ", "step ", "t = ", "particle ", "numerics.", "last good checkpoint"})
      EXPECT_TRUE(contains(line, part)) << "no '" << part << "' in: " << line;
    EXPECT_TRUE(contains(read_bytes(out / "summary.json"), "\"diverged\""));
    EXPECT_TRUE(contains(line, (out / "checkpoints/step-").string())) << line;
  }
}

TEST_F(Diverging, SpeedsWhoseSquareOverflowsAreNamed) {
  const Outcome o = run(block_scene, {"--set", "fluid.velocity=[1e20, 0]", "--set", "numerics.sound_speed=100.0"});
  EXPECT_EQ(o.code, 4) << o.err;
  EXPECT_TRUE(contains(last_line(o.err), "velocity is not finite")) << o.err;
}

TEST_F(Diverging, ASoundSpeedThatLetsTheFluidCollapseIsNoticedOnce) {
  const Outcome o = run(block_scene, {"--set", "numerics.sound_speed=1", "--set", "run.end_time=0.15"});
  const std::size_t first = o.err.find("note: at t = 0.");
  ASSERT_NE(first, std::string::npos) << o.err;
  EXPECT_TRUE(contains(o.err, "raise numerics.sound_speed above 1 m/s")) << o.err;
  EXPECT_EQ(o.err.find("note: at t = ", first + 1), std::string::npos) << o.err;
}

TEST_F(Diverging, HeatThatRunsAwayIsNoticed) {
  const std::string hot =
      replaced(block_scene, "[run]", "[fluid.heat]\ndiffusivity = 1.0\ninitial = { bottom = 1, top = 9 }\n[run]");
  const Outcome o = run(hot, {"--set", "numerics.courant.conduction=1000.0", "--set", "run.end_time=2.0"});
  EXPECT_EQ(o.code, 4) << o.err;
  EXPECT_TRUE(contains(last_line(o.err), "temperature")) << o.err;
}

// ---- what the commands print and leave ------------------------------------------------------------------------------

std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename());
  return names;
}

nlohmann::json json_of(const fs::path& file) { return nlohmann::json::parse(read_bytes(file)); }

TEST_F(Commands, RunLeavesItsFiles) {
  const Outcome o = run(block_scene);
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_EQ(o.out, "");
  EXPECT_EQ(names_in(out), (std::set<std::string>{"checkpoints", "frames", "frames.hdf.series", "manifest.json",
                                                  "scene.toml", "series.csv", "summary.json", "walls.obj"}));
  EXPECT_EQ(names_in(out / "frames"), (std::set<std::string>{"000000.hdf", "000001.hdf", "000002.hdf"}));
  EXPECT_TRUE(read_bytes(out / "series.csv").starts_with("time_s,step,dt_s,limit,"));
}

TEST_F(Commands, SeriesAndSummaryHaveWhatTheRunHas) {
  const auto header = [&] {
    const std::string series = read_bytes(out / "series.csv");
    return series.substr(0, series.find('\n'));
  };
  ASSERT_EQ(run(block_scene, {"--set", "run.max_steps=3"}).code, 0);
  EXPECT_TRUE(header().ends_with(",max_compression"));
  EXPECT_FALSE(json_of(out / "summary.json").contains("energy_taken_by_sleep_J"));
  ASSERT_EQ(run(block_scene, {"--overwrite", "--set", "run.max_steps=3", "--set", "numerics.sleep={}"}).code, 0);
  EXPECT_TRUE(header().ends_with(",max_compression,asleep,energy_taken_by_sleep_J"));
  EXPECT_EQ(json_of(out / "summary.json")["energy_taken_by_sleep_J"], 0);
  ASSERT_EQ(
      run(block_scene, {"--overwrite", "--set", "run.max_steps=3", "--set", "numerics.integrator=energy_bounded_euler"})
          .code,
      0);
  EXPECT_TRUE(header().ends_with(",least_energy_share,mean_energy_share,largest_energy_share"));
  const std::string series = read_bytes(out / "series.csv");
  EXPECT_EQ(std::count(series.begin(), series.end(), ','), 21 * std::count(series.begin(), series.end(), '\n'))
      << "as many fields in every row";
}

TEST_F(Commands, SummaryHasItsKeys) {
  ASSERT_EQ(run(block_scene, {"--threads", "2", "--set", "run.max_steps=20"}).code, 0);
  const auto summary = json_of(out / "summary.json");
  for (const char* key : {"particles", "steps", "simulated_time_s", "wall_time_s", "particle_steps_per_second",
                          "pairs_per_second", "threads", "state_bytes", "peak_memory_bytes"}) {
    ASSERT_TRUE(summary.contains(key)) << key;
    EXPECT_GT(summary[key].get<double>(), 0) << key;
  }
  EXPECT_EQ(summary["particles"], 140);
  EXPECT_EQ(summary["threads"], 2);
  EXPECT_EQ(summary["status"], "done");
  EXPECT_EQ(summary["steps"], 20);
  for (const char* pass : {"forces", "integrate and collide", "sort and list"})
    EXPECT_TRUE(summary["passes"].contains(pass));
}

TEST_F(Commands, ManifestSaysWhatRanWhereAndFromWhat) {
  file("cube.obj", cube_obj);
  ASSERT_EQ(run(mesh_scene("cube.obj")).code, 0);
  const auto manifest = json_of(out / "manifest.json");
  for (const char* key : {"version", "commit", "compiler", "cpu", "threads", "fingerprint", "features", "passes"})
    EXPECT_TRUE(manifest.contains(key)) << key;
  ASSERT_EQ(manifest["files"].size(), 1u);
  EXPECT_EQ(manifest["files"][0]["path"], "cube.obj");
  EXPECT_EQ(manifest["files"][0]["hash"].get<std::string>().size(), 16u);
  EXPECT_EQ(manifest["fingerprint"].get<std::string>().size(), 16u);
  const std::string hash = manifest["files"][0]["hash"];
  file("cube.obj", cube_obj + "# changed\n");
  ASSERT_EQ(run(mesh_scene("cube.obj"), {"--overwrite"}).code, 0);
  EXPECT_NE(json_of(out / "manifest.json")["files"][0]["hash"], hash);
}

TEST_F(Commands, OverridesAreKeptWithTheRun) {
  ASSERT_EQ(run(block_scene, {"--set", "fluid.density=1200", "--set", "boundary.0.slip=0.5"}).code, 0);
  const std::string kept = read_bytes(out / "scene.toml");
  EXPECT_TRUE(contains(kept, "1200")) << kept;
  EXPECT_EQ(molten_program({"check", (out / "scene.toml").string()}).code, 0);
}

TEST_F(Commands, CheckSaysWhatARunWouldTake) {
  file("cube.obj", cube_obj);
  const Outcome o = molten_program({"check", scene(mesh_scene("cube.obj")).string(), "--set", "run.end_time=0.1"});
  EXPECT_EQ(o.code, 0);
  EXPECT_EQ(o.err, "");
  for (const char* part :
       {"particles ", "memory ", "time step ", "limit", "run time ", "features ", "mesh ", "open edges"})
    EXPECT_TRUE(contains(o.out, part)) << part;
  EXPECT_EQ(names_in(folder.path()), (std::set<std::string>{"cube.obj", "my scene.toml"}));
}

TEST_F(Commands, InfoReadsWhatARunLeaves) {
  ASSERT_EQ(run(block_scene).code, 0);
  const auto expect_told = [](const fs::path& path, const std::vector<std::string>& parts) {
    const Outcome o = molten_program({"info", path.string()});
    EXPECT_EQ(o.code, 0) << o.err;
    for (const std::string& part : parts) EXPECT_TRUE(contains(o.out, part)) << part << " not in " << o.out;
  };
  expect_told(out, {"manifest.json", "summary.json", "checkpoint", "3 frames", "140 particles"});
  expect_told(out / "frames/000001.hdf", {"t = 0.02 s", "140 particles", "2-D", "velocity", "density", "pressure"});
  expect_told(out / "checkpoints/step-000000000.h5", {"checkpoint", "step 0"});
  expect_told(file("cube.obj", cube_obj), {"8 vertices", "12 triangles", "volume 1 "});
}

TEST_F(Commands, InfoOfARunWithoutFrames) {
  ASSERT_EQ(run(block_scene, {"--set", "output.frames_per_second=0"}).code, 0);
  const Outcome o = molten_program({"info", out.string()});
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_TRUE(contains(o.out, "checkpoint")) << o.out;
}

TEST_F(Commands, RenderDraws) {
  ASSERT_EQ(run(block_scene).code, 0);
  const Outcome o = molten_program({"render", out.string(), "--frames", "last", "--width", "64", "--height", "48"});
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_EQ(o.out, (out / "pictures/000002.png").string() + "\n");
  EXPECT_TRUE(read_bytes(out / "pictures/000002.png").starts_with("\x89PNG"));
  for (const std::vector<std::string>& range : {std::vector<std::string>{"0,1"}, {"0", "1"}}) {
    std::vector<std::string> words{"render", out.string(), "--frames", "last", "--width", "64", "--range"};
    words.insert(words.end(), range.begin(), range.end());
    EXPECT_EQ(molten_program(words).code, 0);
  }
  expect_refused(molten_program({"render", out.string(), "--frames", "9"}), 2, {"frames 0 to 2"});
  expect_refused(molten_program({"render", out.string(), "--field", "colour"}), 2, {"colour"});
  expect_refused(molten_program({"render", out.string(), "--range", "1,1"}), 2, {"--range 1 1"});
  expect_refused(molten_program({"render", out.string(), "--frames", "0:2:0"}), 2, {"--frames 0:2:0"});
}

TEST_F(Commands, CompareTellsRunsApart) {
  ASSERT_EQ(run(block_scene).code, 0);
  const std::string other = (folder.path() / "other").string();
  ASSERT_EQ(molten_program({"run", scene().string(), "-o", other, "--set", "scene.gravity=[0.5, -9.81]"}).code, 0);
  const Outcome same = molten_program({"compare", out.string(), out.string()});
  EXPECT_EQ(same.code, 0);
  EXPECT_TRUE(contains(same.out, "position       largest 0,")) << same.out;
  EXPECT_FALSE(contains(same.out, "different times")) << same.out;
  const std::string first = (out / "frames/000000.hdf").string(), second = (out / "frames/000001.hdf").string();
  EXPECT_TRUE(contains(molten_program({"compare", first, second}).out, "different times"));
  const Outcome differ = molten_program({"compare", out.string(), other});
  EXPECT_EQ(differ.code, 0);
  EXPECT_FALSE(contains(differ.out, "velocity       largest 0,")) << differ.out;
}

TEST_F(Commands, TheSameRunWritesTheSameFrames) {
  ASSERT_EQ(run(block_scene).code, 0);
  const std::string frame = read_bytes(out / "frames/000001.hdf");
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // HDF5 knows seconds
  ASSERT_EQ(run(block_scene, {"--overwrite"}).code, 0);
  EXPECT_EQ(read_bytes(out / "frames/000001.hdf"), frame);
}

TEST_F(Commands, OneProcessAtATimeRunsInAFolder) {
  Program program({"run", scene().string(), "-o", out.string(), "--set", "run.end_time=1000.0"});
  ASSERT_TRUE(program.waits_for([&] { return fs::exists(out / "frames/000001.hdf"); }));
  for (const auto& more :
       {std::vector<std::string>{"resume", out.string()}, {"run", scene().string(), "-o", out.string(), "--overwrite"}})
    expect_refused(molten_program(more), 5, {out.string(), "another process runs in this folder"});
  EXPECT_TRUE(fs::exists(out / "frames/000001.hdf")) << "the run was spoiled";
  program.kill(SIGKILL);
  program.wait();
  EXPECT_EQ(molten_program({"resume", out.string(), "--set", "run.end_time=0.0001"}).code, 0) << "the lock outlived it";
}

TEST_F(Commands, AFileBeyondItsLimitIsAnErrorOfWriting) {
  Outcome o;
  {
    const SmallFilesOnly limit(20000);
    o = run(replaced(block_scene, "spacing = 0.02", "spacing = 0.005"));
  }
  EXPECT_EQ(o.code, 5) << o.signal << o.err;
  EXPECT_TRUE(contains(o.err, "molten: ") && contains(o.err, "File too large")) << o.err;
}

TEST_F(Commands, ASecondSignalEndsAtOnce) {
  // The stop asked for by the first signal is seen after a step; a stopped process takes both before it.
  Program program({"run", scene().string(), "-o", out.string(), "--set", "run.end_time=1000.0"});
  ASSERT_TRUE(program.waits_for([&] { return fs::exists(out / "frames/000001.hdf"); }));
  program.kill(SIGSTOP);
  program.kill(SIGINT);
  program.kill(SIGTERM);
  program.kill(SIGCONT);
  const Outcome o = program.wait();
  EXPECT_TRUE(o.signal == SIGINT || o.signal == SIGTERM) << o.code << o.err;
}

}  // namespace
}  // namespace molten::program_test
