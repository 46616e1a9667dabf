// Stopping and going on: a run that was stopped, by its end or by a signal, and resumed is the run that never stopped,
// bit for bit; what may change at a resume, and what happens when checkpoints are bad.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "io/hdf5/checkpoint.h"
#include "io/hdf5/frames.h"
#include "io/hdf5/hdf5.h"
#include "tests/program.h"

namespace molten::run_test {
namespace {

namespace fs = std::filesystem;

// ---- what a run leaves ----------------------------------------------------------------------------------------------

/// Every number of the newest checkpoint's state as text of its bits. Wall time is no part of the state.
void collect(const Hdf5File& file, const std::string& group, std::map<std::string, std::string>& all) {
  for (const std::string& member : file.members(group)) {
    const std::string name = group + "/" + member;
    if (name == "state/run/stepping_seconds") continue;
    Hdf5Layout layout;
    try {
      layout = file.layout(name);
    } catch (const Error&) {
      collect(file, name, all);
      continue;
    }
    std::string bytes(8 * layout.count(), '\0');
    if (!bytes.empty()) file.read(name, layout.type, bytes.data());
    all[name] = bytes;
  }
}

std::map<std::string, std::string> final_state(const fs::path& run) {
  std::map<std::string, std::string> all;
  collect(Hdf5File::open(list_checkpoints(run).at(0), ExitCode::checkpoint), "state", all);
  return all;
}

void expect_same_state(const fs::path& a, const fs::path& b) {
  const auto one = final_state(a), two = final_state(b);
  EXPECT_GT(one.size(), 15u);
  EXPECT_TRUE(one.contains("state/particles/position0"));
  EXPECT_EQ(one.size(), two.size());
  for (const auto& [name, bytes] : one) EXPECT_TRUE(two.contains(name) && two.at(name) == bytes) << name << " differs";
}

void expect_same_frames(const fs::path& a, const fs::path& b) {
  const auto one = list_frames(a), two = list_frames(b);
  ASSERT_EQ(one.size(), two.size());
  EXPECT_EQ(read_bytes(a / "frames.hdf.series"), read_bytes(b / "frames.hdf.series"));
  for (std::size_t k = 0; k < one.size(); ++k) {
    const Snapshot first = read_frame(one[k].file), second = read_frame(two[k].file);
    EXPECT_EQ(first.time, second.time);
    EXPECT_EQ(first.step, second.step);
    EXPECT_EQ(first.id, second.id);
    EXPECT_EQ(first.position, second.position) << k;
    ASSERT_EQ(first.fields.size(), second.fields.size());
    for (std::size_t f = 0; f < first.fields.size(); ++f)
      EXPECT_EQ(first.fields[f].values, second.fields[f].values) << k << ' ' << first.fields[f].name;
  }
}

void expect_same_run(const fs::path& a, const fs::path& b) {
  expect_same_state(a, b);
  expect_same_frames(a, b);
  EXPECT_EQ(read_bytes(a / "series.csv"), read_bytes(b / "series.csv"));
}

// ---- the runs -------------------------------------------------------------------------------------------------------

/// Everything at once: melting SMD fluid with XSPH that meets a floor, a post, and, where the method knows them, a ball
/// that moves and one that falls, while a vent lets more in and a plane takes it out; with symplectic Euler walls with
/// support.
std::string full_scene(int dimensions, const std::string& precision, const std::string& integrator,
                       const std::string& more = "") {
  const bool flat = dimensions == 2;
  const std::string body = flat ? "box = { min = [0.0, 0.02], max = [0.3, 0.32] }\nspacing = 0.015"
                                : "box = { min = [0.0, 0.0, 0.02], max = [0.2, 0.2, 0.22] }\nspacing = 0.02";
  const std::string walls =
      flat ? "plane = { point = [0, 0], normal = [0, 1] }\n[[boundary]]\n"
             "sphere = { center = [0.4, 0.0], radius = 0.06 }\nslip = 0.7\nrestitution = 0.2\n"
           : "plane = { point = [0, 0, 0], normal = [0, 0, 1] }\n[[boundary]]\n"
             "sphere = { center = [0.27, 0.1, 0.0], radius = 0.05 }\nslip = 0.7\nrestitution = 0.2\n";
  const bool two_step = integrator == "leap_frog" || integrator == "symplectic_euler";
  const bool symplectic = integrator == "symplectic_euler";
  const std::string moving =
      !two_step ? ""
      : flat    ? "[[boundary]]\nsphere = { center = [0.36, 0.2], radius = 0.04 }\n"
                  "motion = { velocity = [-1.0, 0.5], spin = 90 }\nfriction = 0.3\n[[boundary]]\n"
                  "sphere = { center = [0.1, 0.4], radius = 0.06 }\n"
                  "body = { density = 2000, velocity = [0, -2], spin = 100 }\n"
                : "[[boundary]]\nsphere = { center = [0.28, 0.1, 0.15], radius = 0.04 }\n"
                  "motion = { velocity = [-1.0, 0, 0.5], spin = [0, 90, 0] }\nfriction = 0.3\n[[boundary]]\n"
                  "sphere = { center = [0.1, 0.1, 0.3], radius = 0.06 }\n"
                  "body = { density = 2000, velocity = [0, 0, -2], spin = [100, 0, 0] }\n";
  const std::string vents =
      !two_step ? ""
      : flat    ? "[[vent]]\ndisc = { centre = [0.7, 0.2], normal = [1, -1], radius = 0.05 }\nrate = 0.2\n"
                  "temperature = 70\n[[outflow]]\nplane = { point = [0.75, 0.1], normal = [1, -1] }\n"
                : "[[vent]]\ndisc = { centre = [0.6, 0.1, 0.2], normal = [1, 0, -1], radius = 0.05 }\n"
                  "table = [[0, 0.01, 70], [0.05, 0.02, 50]]\n"
                  "[[outflow]]\nplane = { point = [0.65, 0, 0.1], normal = [1, 0, -1] }\n";
  return fmt::format(R"([scene]
dimensions = {}
[fluid]
{}
velocity = {}
[fluid.rheology]
model = "smd"
jump_number = [2, 20]
yield_stress = 20.0
consistency = 4.0
[fluid.heat]
diffusivity = 1e-4
melting_range = [40, 60]
initial = {{ bottom = 20.0, top = 90.0 }}
[[boundary]]
{}{}{}[run]
end_time = 0.08
[output]
frames_per_second = 100
series_every = 0.003
[numerics]
precision = "{}"
integrator = "{}"
xsph = {{ form = "position", epsilon = 0.3 }}
{}{})",
                     dimensions, body, flat ? "[0.5, -0.5]" : "[0.5, 0.0, -0.5]", walls, moving, vents, precision,
                     integrator, more, symplectic ? "wall_support = true\ndensity_diffusion = 0.1\n" : "");
}

/// A scene in a folder of its own, with runs beside it.
struct Bench {
  explicit Bench(const std::string& text) { write_bytes(scene, text); }
  fs::path run(const std::string& name) const { return folder.path() / name; }

  Outcome start(const std::string& name, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> all{"run", scene.string(), "-o", run(name).string()};
    all.insert(all.end(), more.begin(), more.end());
    return molten_program(all);
  }
  Outcome resume(const std::string& name, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> all{"resume", run(name).string()};
    all.insert(all.end(), more.begin(), more.end());
    return molten_program(all);
  }

  TempFolder folder;
  fs::path scene = folder.path() / "scene.toml";
};

struct Variant {
  int dimensions;
  const char *precision, *integrator;
  const char* more = "";  // keys of [numerics]
};

class Resume : public ::testing::TestWithParam<Variant> {};

TEST_P(Resume, AfterHalfTheTimeIsTheWholeRunBitForBit) {
  const Variant v = GetParam();
  const Bench bench(full_scene(v.dimensions, v.precision, v.integrator, v.more));
  ASSERT_EQ(bench.start("whole").code, 0);
  ASSERT_EQ(bench.start("halves", {"--set", "run.end_time=0.04"}).code, 0);
  const Outcome o = bench.resume("halves", {"--set", "run.end_time=0.08"});
  ASSERT_EQ(o.code, 0) << o.err;
  expect_same_run(bench.run("whole"), bench.run("halves"));
}

// An end between frames: its extra frame is dropped at the resume and the true one made.
TEST_P(Resume, FromBetweenFramesAndWithOtherThreadsIsTheSameToo) {
  const Variant v = GetParam();
  const Bench bench(full_scene(v.dimensions, v.precision, v.integrator, v.more));
  ASSERT_EQ(bench.start("whole", {"--set", "run.end_time=0.045"}).code, 0);
  ASSERT_EQ(bench.start("parts", {"--set", "run.max_steps=37"}).code, 0);
  ASSERT_EQ(bench.resume("parts", {"--set", "run.max_steps=90", "--threads", "2"}).code, 0);
  ASSERT_EQ(bench.resume("parts", {"--set", "run.end_time=0.045", "--set", "run.max_steps=1000000"}).code, 0);
  expect_same_run(bench.run("whole"), bench.run("parts"));
}

// Whatever a checkpoint forgot would have to be the same by chance at each of these steps, between sorts and at them.
TEST_P(Resume, EveryFewStepsIsTheSameToo) {
  const Variant v = GetParam();
  const Bench bench(full_scene(v.dimensions, v.precision, v.integrator, v.more));
  constexpr int first = 100, every = 7, last = 226;
  ASSERT_EQ(bench.start("whole", {"--set", fmt::format("run.max_steps={}", last)}).code, 0);
  ASSERT_EQ(bench.start("pieces", {"--set", fmt::format("run.max_steps={}", first)}).code, 0);
  for (int steps = first + every; steps <= last; steps += every)
    ASSERT_EQ(bench.resume("pieces", {"--set", fmt::format("run.max_steps={}", steps)}).code, 0);
  expect_same_run(bench.run("whole"), bench.run("pieces"));
}

INSTANTIATE_TEST_SUITE_P(
    All, Resume,
    ::testing::Values(Variant{2, "single", "leap_frog"}, Variant{2, "double", "symplectic_euler"},
                      Variant{3, "single", "symplectic_euler"}, Variant{3, "double", "leap_frog"},
                      Variant{2, "single", "leap_frog", "gradient_correction = true  shifting = true"},
                      Variant{2, "double", "leap_frog",
                              "gradient_correction = true  shifting = true  wall_support = true  "
                              "stress_form = \"pairwise\""},
                      Variant{2, "double", "predictor_corrector", "density_filter = { kind = \"mls\", every = 7 }"},
                      Variant{2, "single", "runge_kutta_4"}),
    [](const auto& info) {
      const Variant& v = info.param;
      return fmt::format("{}d_{}_{}{}", v.dimensions, v.precision, v.integrator, *v.more ? "_more" : "");
    });

/// Stops a run with a signal once it has made a few frames.
Outcome stop_with(int signal, const Bench& bench, const std::string& name) {
  Program program({"run", bench.scene.string(), "-o", bench.run(name).string()});
  const fs::path frame = bench.run(name) / "frames/000003.hdf";
  EXPECT_TRUE(program.waits_for([&] { return fs::exists(frame); }));
  program.kill(signal);
  return program.wait();
}

class Signal : public ::testing::TestWithParam<int> {};

TEST_P(Signal, StopsCleanlyAndTheResumedRunIsTheUninterruptedOne) {
  const Bench bench(full_scene(3, "single", "leap_frog"));
  ASSERT_EQ(bench.start("whole").code, 0);
  const Outcome stopped = stop_with(GetParam(), bench, "stopped");
  ASSERT_EQ(stopped.code, 75) << stopped.err;
  EXPECT_TRUE(contains(stopped.err, "molten resume ")) << stopped.err;
  EXPECT_TRUE(contains(read_bytes(bench.run("stopped") / "summary.json"), "\"interrupted\""));
  ASSERT_LT(list_frames(bench.run("stopped")).size(), list_frames(bench.run("whole")).size());
  ASSERT_EQ(bench.resume("stopped").code, 0);
  expect_same_run(bench.run("whole"), bench.run("stopped"));
}

INSTANTIATE_TEST_SUITE_P(Either, Signal, ::testing::Values(SIGTERM, SIGINT, SIGHUP, SIGXCPU), [](const auto& info) {
  return info.param == SIGTERM ? "Term" : info.param == SIGINT ? "Int" : info.param == SIGHUP ? "Hup" : "CpuLimit";
});

// ---- bad checkpoints and changed scenes -----------------------------------------------------------------------------

void damage(const fs::path& file) {
  std::string bytes = read_bytes(file);
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  write_bytes(file, bytes);
}

/// Two steps' worth of checkpoints: at the start and at the end.
struct Finished : Bench {
  Finished() : Bench(block_scene) {
    EXPECT_EQ(start("a").code, 0);
    EXPECT_EQ(list_checkpoints(run("a")).size(), 2u);
  }
};

TEST(ResumeFallsBack, ToTheCheckpointBeforeADamagedOneAndSaysSo) {
  const Finished bench;
  fs::copy(bench.run("a"), bench.run("whole"), fs::copy_options::recursive);
  const fs::path newest = list_checkpoints(bench.run("a")).at(0);
  damage(newest);
  const Outcome o = bench.resume("a");
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_TRUE(contains(o.err, "warning: " + newest.string())) << o.err;
  EXPECT_TRUE(contains(o.err, "from t = 0 s, step 0")) << o.err;
  expect_same_run(bench.run("whole"), bench.run("a"));
}

TEST(ResumeFallsBack, OntoNothingWhenAllAreDamaged) {
  const Finished bench;
  for (const fs::path& file : list_checkpoints(bench.run("a"))) damage(file);
  expect_refused(
      bench.resume("a"), 6,
      {list_checkpoints(bench.run("a")).at(0).string(), "checksum", "no older checkpoint is whole", "--overwrite"});
  const Outcome info = molten_program({"info", bench.run("a").string()});
  EXPECT_EQ(info.code, 0) << info.err;
  EXPECT_TRUE(contains(info.err, "warning: ") && contains(info.err, "checksum")) << info.err;
}

TEST(ResumeRefuses, CheckpointsOfAnotherFormat) {
  const Finished bench;
  for (const fs::path& file : list_checkpoints(bench.run("a"))) {
    std::string bytes = read_bytes(file);
    const std::string mark = "molten checkpoint, format ";
    ASSERT_TRUE(bytes.starts_with(mark + "5\n"));
    bytes[mark.size()] = '1';
    write_bytes(file, bytes);
  }
  expect_refused(bench.resume("a"), 6, {"is of format 1", "reads format 5", "run the scene anew"});
}

TEST(ResumeRefuses, AFolderWithoutCheckpoints) {
  const Finished bench;
  expect_refused(bench.resume("nowhere"), 6, {"nowhere", "molten run"});
  fs::remove_all(bench.run("a") / "checkpoints");
  expect_refused(bench.resume("a"), 6, {"holds no checkpoint"});
}

TEST(ResumeRefuses, AChangedSceneUnlessForced) {
  const Finished bench;
  for (const char* change :
       {"fluid.density=1001.0", "fluid.rheology.viscosity=6.0", "scene.gravity=[0.0, -9.0]",
        "numerics.precision=double", "boundary.0.slip=0.5", "fluid.spacing=0.021", "numerics.tensile_correction=true"})
    expect_refused(bench.resume("a", {"--set", change}), 6, {"--force", "changed"});
  EXPECT_TRUE(contains(read_bytes(bench.run("a") / "scene.toml"), "viscosity = 5.0"));
  const Outcome forced =
      bench.resume("a", {"--set", "fluid.rheology.viscosity=6.0", "--set", "run.end_time=0.05", "--force"});
  EXPECT_EQ(forced.code, 0) << forced.err;
  EXPECT_TRUE(contains(read_bytes(bench.run("a") / "scene.toml"), "viscosity = 6.0"));
}

TEST(ResumeRefuses, OverridesThatAreNoScene) {
  const Finished bench;
  expect_refused(bench.resume("a", {"--set", "run.end_tim=2"}), 2, {"end_tim"});
  expect_refused(bench.resume("a", {"--set", "run.end_time=nan"}), 2, {"end_time"});
}

TEST(ResumeAccepts, AnotherEndTimeAndOutputAndKeepsThem) {
  const Finished bench;
  ASSERT_EQ(bench.resume("a", {"--set", "run.end_time=0.06", "--set", "output.fields=[\"density\"]"}).code, 0);
  const auto frames = list_frames(bench.run("a"));
  EXPECT_EQ(frames.size(), 4u);
  EXPECT_EQ(read_frame(frames.back().file).fields.size(), 1u);
  EXPECT_EQ(bench.resume("a").code, 0);  // there is nothing left to do
  EXPECT_EQ(list_frames(bench.run("a")).size(), 4u);
}

/// Times of a run's rows, which must never go back.
std::vector<double> row_times(const fs::path& run) {
  std::vector<double> times;
  std::ifstream in(run / "series.csv");
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) times.push_back(std::stod(line));
  return times;
}

TEST(ResumeAccepts, FramesAndRowsThatWereTakenAwayAndSaysSo) {
  const Finished bench;
  fs::remove_all(bench.run("a") / "frames");
  const fs::path series = bench.run("a") / "series.csv";
  const std::string rows = read_bytes(series);
  write_bytes(series, rows.substr(0, rows.size() - 5));
  const Outcome o = bench.resume("a", {"--set", "run.end_time=0.06"});
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_TRUE(contains(o.err, "frames: 3 of the 3 frames so far are not there")) << o.err;
  EXPECT_TRUE(contains(o.err, "series.csv: 1 of the 3 rows so far are not there")) << o.err;
  EXPECT_EQ(list_frames(bench.run("a")).size(), 1u);
  // What is missing counts no more, and an older checkpoint that still counts it keeps no row that is made again.
  fs::remove(list_checkpoints(bench.run("a")).at(0));
  EXPECT_TRUE(contains(bench.resume("a").err, "series.csv: 1 of the 3 rows so far")) << "the older checkpoint";
  const std::vector<double> times = row_times(bench.run("a"));
  EXPECT_TRUE(std::is_sorted(times.begin(), times.end(), std::less_equal<>())) << "a row is there twice";
}

// 6/135 over 1/135 rounds to less than 6: no frame of its own for the round-off, nor a step of 10⁻¹⁷ s.
TEST(Run, FramesAreAnIntervalApart) {
  const Bench bench(block_scene);
  ASSERT_EQ(bench.start("a", {"--set", "output.frames_per_second=135", "--set", "run.end_time=0.06"}).code, 0);
  const auto frames = list_frames(bench.run("a"));
  EXPECT_EQ(frames.size(), 10u);
  for (std::size_t k = 1; k + 1 < frames.size(); ++k) EXPECT_NEAR(frames[k].time - frames[k - 1].time, 1 / 135.0, 1e-9);
}

TEST(ResumeAccepts, MoreAndFewerFramesASecond) {
  for (const double rate : {200.0, 20.0, 0.0}) {
    const Finished bench;
    const Outcome o =
        bench.resume("a", {"--set", fmt::format("output.frames_per_second={}", rate), "--set", "run.end_time=0.1"});
    ASSERT_EQ(o.code, 0) << o.err;
    const std::vector<double> rows = row_times(bench.run("a"));
    EXPECT_TRUE(std::is_sorted(rows.begin(), rows.end())) << rate;
    const auto frames = list_frames(bench.run("a"));
    for (std::size_t k = 1; k < frames.size(); ++k) EXPECT_LT(frames[k - 1].time, frames[k].time) << rate;
    EXPECT_NEAR(frames.back().time, rate > 0 ? 0.1 : 0.04, 1e-9) << rate;
    EXPECT_EQ(frames.size(), rate == 200 ? 3u + 12 : rate == 20 ? 3u + 2 : 3u) << rate;
  }
}

TEST(ResumeAccepts, RowsMoreOftenAndLessOften) {
  for (const double every : {0.005, 0.03}) {
    const Bench bench(block_scene);
    ASSERT_EQ(bench.start("a", {"--set", "output.series_every=0.01", "--set", "output.frames_per_second=0"}).code, 0);
    ASSERT_EQ(
        bench.resume("a", {"--set", fmt::format("output.series_every={}", every), "--set", "run.end_time=0.1"}).code,
        0);
    const std::vector<double> rows = row_times(bench.run("a"));
    EXPECT_TRUE(std::is_sorted(rows.begin(), rows.end()));
    EXPECT_LE(*std::upper_bound(rows.begin(), rows.end(), 0.041), 0.041 + every * 1.1) << every;
    EXPECT_GE(rows.size(), 5 + std::size_t(0.06 / every) - 1) << every;
  }
}

}  // namespace
}  // namespace molten::run_test
