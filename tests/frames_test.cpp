#include "io/hdf5/frames.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "core/error.h"
#include "tests/small_files_only.h"
#include "tests/temp_folder.h"

namespace molten::frames_test {
namespace {

namespace fs = std::filesystem;

Snapshot some_snapshot(std::size_t count, double time = 0.25) {
  Snapshot snapshot;
  snapshot.time = time;
  snapshot.step = 1234567890123;
  snapshot.dimensions = 2;
  snapshot.spacing = 0.0125;
  SnapshotField temperature{"temperature", "°C", "what a thermometer shows", 1, {}};
  SnapshotField velocity{"velocity", "m/s", "of the particle", 3, {}};
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-1, 1);
  for (std::size_t i = 0; i < count; ++i) {
    snapshot.id.push_back((std::int64_t{1} << 40) + 3 * static_cast<std::int64_t>(i));
    temperature.values.push_back(90 * any(random));
    for (int axis = 0; axis < 3; ++axis) {
      snapshot.position.push_back(1e7 + any(random));
      velocity.values.push_back(any(random));
    }
  }
  snapshot.fields = {velocity, temperature};
  return snapshot;
}

void expect_same(const Snapshot& a, const Snapshot& b) {
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.step, b.step);
  EXPECT_EQ(a.dimensions, b.dimensions);
  EXPECT_EQ(a.spacing, b.spacing);
  EXPECT_EQ(a.id, b.id);
  EXPECT_EQ(a.position, b.position);
  ASSERT_EQ(a.fields.size(), b.fields.size());
  for (std::size_t f = 0; f < a.fields.size(); ++f) {
    EXPECT_EQ(a.fields[f].name, b.fields[f].name);
    EXPECT_EQ(a.fields[f].unit, b.fields[f].unit);
    EXPECT_EQ(a.fields[f].meaning, b.fields[f].meaning);
    EXPECT_EQ(a.fields[f].components, b.fields[f].components);
    ASSERT_EQ(a.fields[f].values.size(), b.fields[f].values.size());
    for (std::size_t i = 0; i < a.fields[f].values.size(); ++i)
      EXPECT_EQ(static_cast<float>(a.fields[f].values[i]), static_cast<float>(b.fields[f].values[i]));
  }
}

ExitCode code_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.code();
  }
  return ExitCode::done;
}

TEST(Frames, ReadWhatWasWritten) {
  const TempFolder folder;
  const Snapshot snapshot = some_snapshot(50000);
  write_frame(folder.path(), 7, snapshot);
  expect_same(snapshot, read_frame(folder.path() / "frames/000007.hdf"));
}

TEST(Frames, HoldNoParticlesAndOne) {
  const TempFolder folder;
  for (const int count : {0, 1}) {
    write_frame(folder.path(), count, some_snapshot(count));
    expect_same(some_snapshot(count), read_frame(list_frames(folder.path()).at(count).file));
  }
}

TEST(Frames, KeepNonFiniteValuesAndEmptyTexts) {
  const TempFolder folder;
  Snapshot snapshot = some_snapshot(3);
  snapshot.fields[1].values = {std::nan(""), std::numeric_limits<double>::infinity(), 1e300};
  snapshot.fields[1].unit = snapshot.fields[1].meaning = "";
  write_frame(folder.path(), 0, snapshot);
  const Snapshot back = read_frame(folder.path() / "frames/000000.hdf");
  EXPECT_TRUE(std::isnan(back.fields[1].values[0]));
  EXPECT_TRUE(std::isinf(back.fields[1].values[1]));
  EXPECT_TRUE(std::isinf(back.fields[1].values[2]));  // more than a float holds
  EXPECT_EQ(back.fields[1].unit, "");
}

TEST(Frames, SeriesNamesEveryFrameWithItsTime) {
  const TempFolder folder;
  for (int number : {0, 1, 2}) write_frame(folder.path(), number, some_snapshot(5, 0.04 * number));
  write_frame(folder.path(), 1, some_snapshot(5, 0.05));  // made again
  const auto series = nlohmann::json::parse(read_bytes(folder.path() / "frames.hdf.series"));
  EXPECT_EQ(series["file-series-version"], "1.0");
  ASSERT_EQ(series["files"].size(), 3u);
  EXPECT_EQ(series["files"][2]["name"], "frames/000002.hdf");
  EXPECT_EQ(series["files"][1]["time"], 0.05);
  EXPECT_EQ(series["files"][2]["time"], 0.08);
}

TEST(Frames, ListSurvivesALostSeries) {
  const TempFolder folder;
  for (int number : {0, 1, 2}) write_frame(folder.path(), number, some_snapshot(5, 0.04 * number));
  for (const char* damage : {"", "{\"files\":[1,{\"name\":3}]}", "[]"}) {
    write_bytes(folder.path() / "frames.hdf.series", damage);
    const auto frames = list_frames(folder.path());
    ASSERT_EQ(frames.size(), 3u);
    EXPECT_EQ(frames[2].time, 0.08);
    EXPECT_EQ(frames[2].file.filename(), "000002.hdf");
  }
}

TEST(Frames, DropFromANumberOn) {
  const TempFolder folder;
  for (int number : {0, 1, 2, 3}) write_frame(folder.path(), number, some_snapshot(2, number));
  write_bytes(folder.path() / "frames/000009.hdf.tmp", "left by a crash");
  drop_frames_from(folder.path(), 2);
  EXPECT_EQ(list_frames(folder.path()).size(), 2u);
  EXPECT_FALSE(fs::exists(folder.path() / "frames/000002.hdf"));
  EXPECT_FALSE(fs::exists(folder.path() / "frames/000009.hdf.tmp"));
  EXPECT_EQ(nlohmann::json::parse(read_bytes(folder.path() / "frames.hdf.series"))["files"].size(), 2u);
  EXPECT_NO_THROW(drop_frames_from(folder.path() / "never made", 0));
}

TEST(Frames, BadFilesAndFoldersAreFileErrors) {
  const TempFolder folder;
  EXPECT_EQ(code_of([&] { list_frames(folder.path()); }), ExitCode::files);
  EXPECT_EQ(code_of([&] { read_frame(folder.path() / "none.hdf"); }), ExitCode::files);
  write_frame(folder.path(), 0, some_snapshot(1000));
  const fs::path file = folder.path() / "frames/000000.hdf";
  const std::string whole = read_bytes(file);
  write_bytes(file, "not HDF5 at all");
  EXPECT_EQ(code_of([&] { read_frame(file); }), ExitCode::files);
  write_bytes(file, whole.substr(0, whole.size() / 2));
  EXPECT_EQ(code_of([&] { read_frame(file); }), ExitCode::files);
  write_bytes(folder.path() / "flat", "");
  EXPECT_EQ(code_of([&] { write_frame(folder.path() / "flat", 0, some_snapshot(1)); }), ExitCode::files);
}

TEST(Frames, FullDiskIsAFileErrorAndLeavesTheOlderOnes) {
  const TempFolder folder;
  write_frame(folder.path(), 0, some_snapshot(5));
  {
    // HDF5 by itself crashes here: compressed arrays are written when the file is closed.
    const SmallFilesOnly limit(20000);
    EXPECT_EQ(code_of([&] { write_frame(folder.path(), 1, some_snapshot(50000)); }), ExitCode::files);
  }
  EXPECT_EQ(list_frames(folder.path()).size(), 1u);
  EXPECT_FALSE(fs::exists(folder.path() / "frames/000001.hdf.tmp"));
  write_frame(folder.path(), 1, some_snapshot(50000));
  EXPECT_EQ(list_frames(folder.path()).size(), 2u);
}

TEST(Frames, UnequalColumnsAreRefused) {
  const TempFolder folder;
  Snapshot snapshot = some_snapshot(5);
  snapshot.fields[0].values.pop_back();
  EXPECT_THROW(write_frame(folder.path(), 0, snapshot), std::invalid_argument);
  EXPECT_FALSE(fs::exists(folder.path() / "frames/000000.hdf"));
}

}  // namespace
}  // namespace molten::frames_test
