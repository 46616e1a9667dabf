// Writing and reading a checkpoint of a million particles, into a folder beside the program; the disk counts.
#include <algorithm>
#include <cstring>
#include <filesystem>
#include <string>

#include <fmt/format.h>

#include "bench/cases.h"
#include "bench/program.h"
#include "io/hdf5/checkpoint.h"

namespace molten::bench {
namespace {

using S = State<3, float>;

std::filesystem::path run_folder() {
  const auto folder = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "checkpoint-run";
  std::filesystem::create_directories(folder);
  return folder;
}

void write(S& s) {
  CheckpointHead head;
  head.step = s.clock.step;
  write_checkpoint(
      run_folder(), head, [&](Archive& a) { s.archive(a); }, 1);
}

void read(S& s) {
  read_checkpoint(list_checkpoints(run_folder()).at(0), [&](Archive& a) { s.archive(a); });
}

/// Is every column of both the same, bit for bit? Empty, or which is not.
std::string check_same(const S& a, const S& b) {
  std::string wrong;
  if (a.particles.slots() != b.particles.slots()) return "the number of slots differs";
  for_each_field([&]<class F>(F field) {
    if (!a.particles.has(field)) return;
    const auto x = a.particles[field], y = b.particles[field];
    for (int k = 0; k < x.size; ++k)
      if (std::memcmp(x[k], y[k], a.particles.slots() * sizeof(*x[k])) != 0) wrong = fmt::format("{} differs", F::name);
  });
  return wrong;
}

void time_checkpoint(benchmark::State& bench, bool writing) {
  S s = jittered_block<3, float>(1000000, 1.3);
  S restored = jittered_block<3, float>(1000000, 1.3);
  std::fill_n(restored.particles[position][0], restored.particles.slots(), 0.0);
  write(s);
  read(restored);
  if (const std::string wrong = check_same(s, restored); !wrong.empty()) return bench.SkipWithError(wrong.c_str());
  const double bytes = static_cast<double>(std::filesystem::file_size(list_checkpoints(run_folder()).at(0)));
  const Stopwatch watch;
  for (auto _ : bench) writing ? write(s) : read(restored);
  const double elapsed = watch.seconds(), times = static_cast<double>(bench.iterations());
  bench.counters["GB/s"] = 1e-9 * bytes * times / elapsed;
  bench.counters["bytes_per_particle"] = bytes / static_cast<double>(s.particles.count());
  std::filesystem::remove_all(run_folder());
}

}  // namespace
}  // namespace molten::bench

int main(int argc, char** argv) {
  using namespace molten::bench;
  return run_program(argc, argv, [] {
    add("checkpoint/write/3d/1M", [](benchmark::State& bench) { time_checkpoint(bench, true); });
    add("checkpoint/read/3d/1M", [](benchmark::State& bench) { time_checkpoint(bench, false); });
  });
}
