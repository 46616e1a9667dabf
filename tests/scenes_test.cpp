// The scenes as shipped: every one reads and starts (quick); bunny and volcano do what their heads promise (slow).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "io/geometry/terrain.h"
#include "io/hdf5/checkpoint.h"
#include "io/hdf5/frames.h"
#include "io/scene/scene_file.h"
#include "tests/program.h"
#include "tests/temp_folder.h"

namespace molten::scenes_test {
namespace {

namespace fs = std::filesystem;

const fs::path scenes = fs::path(MOLTEN_SOURCE_DIR) / "scenes";

bool models_are_there() {
  return fs::exists(scenes / "models/bunny.obj") && fs::exists(scenes / "models/hand.glb") &&
         fs::exists(scenes / "models/volcano.json");
}

TEST(Scenes, AllAreReadAndSayWhatTheyAre) {
  std::size_t count = 0;
  for (const auto& entry : fs::directory_iterator(scenes)) {
    if (entry.path().extension() != ".toml") continue;
    ++count;
    const Scene scene = read_scene(entry.path());
    EXPECT_FALSE(scene.title.empty()) << entry.path();
    for (const char* line : {"# Source:", "# Expect:", "# Time here:", "# Picture:"})
      EXPECT_NE(scene.text.find(line), std::string::npos) << entry.path() << " has no line " << line;
  }
  EXPECT_GE(count, 15u);
}

TEST(Scenes, AllTakeAFewSteps) {
  if (!models_are_there()) GTEST_SKIP() << "scenes/models is empty: run scripts/models";
  for (const auto& entry : fs::directory_iterator(scenes)) {
    if (entry.path().extension() != ".toml") continue;
    const TempFolder folder;
    std::vector<std::string> words{"run", entry.path(), "-o", folder.path() / "run", "--set", "run.max_steps=3"};
    if (entry.path().stem() == "dam-break-3d") words.insert(words.end(), {"--set", "fluid.particles=20000"});
    const Outcome o = Program(words).wait();
    EXPECT_EQ(o.code, 0) << entry.path() << ": " << o.err;
  }
}

double height(const Snapshot& s, std::size_t k) { return s.position[3 * k + 2]; }

double highest(const Snapshot& s) {
  double z = -1e300;
  for (std::size_t k = 0; k < s.count(); ++k) z = std::max(z, height(s, k));
  return z;
}

double lowest(const Snapshot& s) {
  double z = 1e300;
  for (std::size_t k = 0; k < s.count(); ++k) z = std::min(z, height(s, k));
  return z;
}

/// The longest way (m) that one of the lowest tenth of the particles has moved.
double way_of_lowest_tenth(const Snapshot& first, const Snapshot& last) {
  std::vector<std::size_t> order(first.count());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return height(first, a) < height(first, b); });
  double longest = 0;
  for (std::size_t k = 0; k < order.size() / 10; ++k) {
    double square = 0;
    for (int d = 0; d < 3; ++d)
      square += std::pow(last.position[3 * order[k] + d] - first.position[3 * order[k] + d], 2);
    longest = std::max(longest, std::sqrt(square));
  }
  return longest;
}

TEST(SlowScenes, OnlyTheBunnysEarsRun) {
  if (!models_are_there()) GTEST_SKIP() << "scenes/models is empty: run scripts/models";
  const TempFolder folder;
  const Outcome o = Program({"run", scenes / "bunny.toml", "-o", folder.path() / "run"}).wait();
  ASSERT_EQ(o.code, 0) << o.err;
  const auto frames = list_frames(folder.path() / "run");
  const Snapshot first = read_frame(frames.front().file), last = read_frame(frames.back().file);
  const double moved = way_of_lowest_tenth(first, last) / first.spacing, fell = (highest(first) - highest(last)) / 0.15;
  RecordProperty("lowest_tenth_spacings", std::to_string(moved));
  RecordProperty("ears_fell_of_height", std::to_string(fell));
  std::printf("lowest tenth moved at most %.2f spacings; the highest point fell by %.3f of the height\n", moved, fell);
  EXPECT_EQ(last.count(), 10188u);
  EXPECT_LT(moved, 2);
  EXPECT_GT(fell, 0.2);
  for (const FrameEntry& frame : frames) EXPECT_GE(lowest(read_frame(frame.file)), 0) << frame.file;
}

/// Height (m) of the ground under a point, by the same two triangles a grid cell as the wall has.
double ground(const TriangleMesh& mesh, double x, double y) {
  for (const auto& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const double area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
    const double u = ((x - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (y - a[1])) / area;
    const double v = ((b[0] - a[0]) * (y - a[1]) - (x - a[0]) * (b[1] - a[1])) / area;
    if (u >= -1e-9 && v >= -1e-9 && u + v <= 1 + 1e-9) return a[2] + u * (b[2] - a[2]) + v * (c[2] - a[2]);
  }
  return -1e300;
}

TEST(SlowScenes, LavaRunsDownTheVolcano) {
  if (!models_are_there()) GTEST_SKIP() << "scenes/models is empty: run scripts/models";
  const TempFolder folder;
  const Outcome o = Program({"run", scenes / "volcano.toml", "-o", folder.path() / "run"}).wait();
  ASSERT_EQ(o.code, 0) << o.err;
  Terrain terrain;
  const TriangleMesh mesh = triangulate(read_terrain(terrain, scenes / "models/volcano.json"));
  const auto frames = list_frames(folder.path() / "run");
  double before = lowest(read_frame(frames.front().file)), largest_drop = 0;
  const double start = before;
  for (const FrameEntry& frame : frames) {
    const double now = lowest(read_frame(frame.file));
    EXPECT_LE(now, before + 1.0) << frame.file << ": the lowest lava climbs";
    largest_drop = std::max(largest_drop, before - now);
    before = now;
  }
  std::printf("lowest lava from %.1f to %.1f m, at most %.2f m between frames\n", start, before, largest_drop);
  EXPECT_LT(before, start - 20);
  EXPECT_LT(largest_drop, 10) << "a jump between two frames 1 s apart";
  const Snapshot last = read_frame(frames.back().file);
  EXPECT_NEAR(static_cast<double>(last.count()), 12000, 120) << "all are kept, within 1 % of the number asked for";
  for (std::size_t k = 0; k < last.count(); ++k)
    ASSERT_GE(height(last, k), ground(mesh, last.position[3 * k], last.position[3 * k + 1]))
        << "particle " << last.id[k];
}

}  // namespace
}  // namespace molten::scenes_test
