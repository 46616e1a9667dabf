#include "io/hdf5/checkpoint.h"

#include <gtest/gtest.h>

#include <random>

#include "core/error.h"
#include "tests/small_files_only.h"
#include "tests/temp_folder.h"

namespace molten::checkpoint_test {
namespace {

namespace fs = std::filesystem;

// Every type of number, an empty array, and two numbers on their own.
struct State {
  double time = 0;
  std::int64_t step = 0;
  std::vector<double> position;
  std::vector<float> velocity;
  std::vector<std::uint8_t> flags;
  std::vector<std::int8_t> marks;
  std::vector<std::int32_t> cell;
  std::vector<std::uint32_t> slot;
  std::vector<std::int64_t> id;
  std::vector<std::uint64_t> seed, none;

  void archive(Archive& a) {
    a.value("clock/time", time);
    a.value("clock/step", step);
    a.vector("particles/position", position);
    a.vector("particles/velocity", velocity);
    a.vector("particles/flags", flags);
    a.vector("particles/marks", marks);
    a.vector("neighbours/cell", cell);
    a.vector("neighbours/slot", slot);
    a.vector("particles/id", id);
    a.vector("random/seed", seed);
    a.vector("random/none", none);
  }
  bool operator==(const State&) const = default;
};

State some_state(std::size_t count) {
  State state{0.1, 77, {}, {}, {}, {}, {}, {}, {}, {}, {}};
  std::mt19937_64 random(1);
  for (std::size_t i = 0; i < count; ++i) {
    const auto bits = random();
    state.position.push_back(static_cast<double>(bits) * 1e-19);
    state.velocity.push_back(static_cast<float>(bits % 1000) * 0.1f);
    state.flags.push_back(static_cast<std::uint8_t>(bits));
    state.marks.push_back(static_cast<std::int8_t>(bits));
    state.cell.push_back(static_cast<std::int32_t>(bits));
    state.slot.push_back(static_cast<std::uint32_t>(bits));
    state.id.push_back(static_cast<std::int64_t>(bits));
    state.seed.push_back(bits);
  }
  return state;
}

CheckpointHead head_at(std::int64_t step) {
  return {step, 0.5 * static_cast<double>(step), "[scene]\ntitle = \"Größe\"\n" + std::string(100000, '#'), "abc",
          "0.1"};
}

void save(const fs::path& folder, std::int64_t step, State state, int keep = 3) {
  write_checkpoint(
      folder, head_at(step), [&](Archive& a) { state.archive(a); }, keep);
}

State load(const fs::path& file) {
  State state;
  read_checkpoint(file, [&](Archive& a) { state.archive(a); });
  return state;
}

std::vector<std::string> names(const fs::path& folder) {
  std::vector<std::string> all;
  for (const fs::path& file : list_checkpoints(folder)) all.push_back(file.filename());
  return all;
}

// The line of the checkpoint error, or a test failure.
std::string refusal(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::checkpoint);
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
  ADD_FAILURE() << "accepted";
  return "";
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(Checkpoint, RestoresEveryBit) {
  const TempFolder folder;
  const State state = some_state(10000);
  save(folder.path(), 77, state);
  const fs::path file = list_checkpoints(folder.path()).at(0);
  EXPECT_TRUE(load(file) == state);
  const CheckpointHead head = read_checkpoint_head(file), wanted = head_at(77);
  EXPECT_EQ(head.step, wanted.step);
  EXPECT_EQ(head.time, wanted.time);
  EXPECT_EQ(head.scene_text, wanted.scene_text);
  EXPECT_EQ(head.scene_hash, wanted.scene_hash);
  EXPECT_EQ(head.version, wanted.version);
}

TEST(Checkpoint, HoldsAnEmptyState) {
  const TempFolder folder;
  save(folder.path(), 0, some_state(0));
  EXPECT_TRUE(load(list_checkpoints(folder.path()).at(0)) == some_state(0));
}

TEST(Checkpoint, KeepsTheNewest) {
  const TempFolder folder;
  for (const int step : {5, 10, 100, 1000}) save(folder.path(), step, some_state(10), 2);
  EXPECT_EQ(names(folder.path()), (std::vector<std::string>{"step-000001000.h5", "step-000000100.h5"}));
}

TEST(Checkpoint, DropsLaterOnesAfterGoingBack) {
  const TempFolder folder;
  for (const int step : {10, 20, 30}) save(folder.path(), step, some_state(10), 3);
  save(folder.path(), 25, some_state(10), 1);
  EXPECT_EQ(names(folder.path()), (std::vector<std::string>{"step-000000025.h5"}));
}

TEST(Checkpoint, IgnoresAndCleansLeftovers) {
  const TempFolder folder;
  EXPECT_TRUE(list_checkpoints(folder.path()).empty());
  save(folder.path(), 1, some_state(10));
  for (const char* name : {"step-000000009.h5.tmp", "step-x.h5", "notes.txt"})
    write_bytes(folder.path() / "checkpoints" / name, "x");
  EXPECT_EQ(names(folder.path()).size(), 1u);
  save(folder.path(), 2, some_state(10));
  EXPECT_FALSE(fs::exists(folder.path() / "checkpoints/step-000000009.h5.tmp"));
  EXPECT_TRUE(fs::exists(folder.path() / "checkpoints/notes.txt"));
}

TEST(Checkpoint, FindsAnyFlippedBit) {
  const TempFolder folder;
  save(folder.path(), 1, some_state(50));
  const fs::path file = list_checkpoints(folder.path()).at(0);
  const std::string whole = read_bytes(file);
  std::mt19937 random(1);
  std::vector<std::size_t> offsets = {0, 8, 20, 40, 60, 511, 512, 600, whole.size() - 1};
  for (int i = 0; i < 300; ++i) offsets.push_back(random() % whole.size());
  for (const std::size_t offset : offsets) {
    std::string damaged = whole;
    damaged[offset] = static_cast<char>(damaged[offset] ^ (1 << random() % 8));
    write_bytes(file, damaged);
    EXPECT_TRUE(contains(refusal([&] { read_checkpoint_head(file); }), file.string())) << offset;
    refusal([&] { load(file); });
  }
}

TEST(Checkpoint, FindsTruncation) {
  const TempFolder folder;
  save(folder.path(), 1, some_state(50));
  const fs::path file = list_checkpoints(folder.path()).at(0);
  const std::string whole = read_bytes(file);
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{100}, std::size_t{512}, whole.size() / 2, whole.size() - 1}) {
    write_bytes(file, whole.substr(0, size));
    const std::string line = refusal([&] { load(file); });
    EXPECT_TRUE(size <= 512 || contains(line, "truncated")) << line;
  }
  write_bytes(file, whole + "x");
  refusal([&] { load(file); });
  fs::remove(file);
  refusal([&] { load(file); });
}

TEST(Checkpoint, RefusesAnotherFormat) {
  const TempFolder folder;
  save(folder.path(), 1, some_state(5));
  const fs::path file = list_checkpoints(folder.path()).at(0);
  std::string bytes = read_bytes(file);
  bytes[bytes.find("format ") + 7] = '9';
  write_bytes(file, bytes);
  EXPECT_TRUE(contains(refusal([&] { load(file); }), "is of format 9"));
}

TEST(Checkpoint, RefusesWhatDoesNotFit) {
  const TempFolder folder;
  save(folder.path(), 1, some_state(5));
  const fs::path file = list_checkpoints(folder.path()).at(0);
  const auto refused = [&](const std::function<void(Archive&)>& load) {
    return refusal([&] { read_checkpoint(file, load); });
  };
  std::vector<double> numbers(6);
  std::vector<std::int64_t> wrong;
  std::int64_t whole = 0;
  EXPECT_TRUE(contains(refused([&](Archive& a) { a.vector("particles/mass", numbers); }), "particles/mass"));
  EXPECT_TRUE(contains(refused([&](Archive& a) { a.array("particles/position", NumberType::f64, numbers.data(), 6); }),
                       "an array of 5, but this run needs an array of 6"));
  EXPECT_TRUE(contains(refused([&](Archive& a) { a.vector("particles/position", wrong); }), "type"));
  EXPECT_TRUE(contains(refused([&](Archive& a) { a.value("clock/time", whole); }), "type"));
  EXPECT_TRUE(contains(refused([&](Archive& a) { a.value("particles/id", whole); }), "array"));
  EXPECT_TRUE(contains(refused([&](Archive& a) { a.vector("clock/step", wrong); }), "no array"));
}

TEST(Checkpoint, FullDiskLeavesTheOlderOnes) {
  const TempFolder folder;
  const State state = some_state(10000);
  save(folder.path(), 1, state, 1);
  for (const int bytes : {0, 600, 5000, 100000, 300000}) {
    ExitCode code = ExitCode::done;
    std::string line;
    try {
      const SmallFilesOnly limit(bytes);
      save(folder.path(), 2, state, 1);
    } catch (const Error& error) {
      code = error.code();
      line = error.what();
    }
    EXPECT_EQ(code, ExitCode::files);
    EXPECT_TRUE(contains(line, "File too large")) << line;
    EXPECT_EQ(names(folder.path()).size(), 1u);
    EXPECT_FALSE(fs::exists(folder.path() / "checkpoints/step-000000002.h5.tmp"));
  }
  EXPECT_TRUE(load(list_checkpoints(folder.path()).at(0)) == state);
  save(folder.path(), 3, state, 1);
  EXPECT_TRUE(load(list_checkpoints(folder.path()).at(0)) == state);
}

TEST(Checkpoint, AnErrorWhileSavingLeavesNothingBehind) {
  const TempFolder folder;
  const auto broken = [](Archive&) { throw Error(ExitCode::diverged, "state is not finite"); };
  EXPECT_THROW(write_checkpoint(folder.path(), head_at(1), broken, 2), Error);
  EXPECT_TRUE(fs::is_empty(folder.path() / "checkpoints"));
}

}  // namespace
}  // namespace molten::checkpoint_test
