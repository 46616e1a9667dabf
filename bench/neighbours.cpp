// Sorting and listing: the whole rebuild as a step does it, and of its parts those that stand alone. Between two
// rebuilds every particle is moved by up to half a skin, there and back, as far as it may get between them in a run.
#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "bench/dam_break.h"
#include "bench/peak.h"
#include "bench/program.h"
#include "core/particle_pass.h"
#include "core/step.h"

namespace molten::bench {
namespace {

/// Moves each particle by `part` of half a skin, in a direction of its own.
template <int Dim, class Real> void shake(State<Dim, Real>& s, double part) {
  Particles<Dim, Real>& p = s.particles;
  const double way = part * s.parameters.skin / 2 / std::sqrt(double(Dim));
  for_each_slot(p.slots(), [&](std::size_t slot) {
    if (p.is_padding(slot)) return;
    auto bits = static_cast<std::uint64_t>(p[id][0][slot]) * 0x9e3779b97f4a7c15u;
    for (int d = 0; d < Dim; ++d, bits = bits * 0x9e3779b97f4a7c15u + 1)
      p[position][d][slot] += way * (static_cast<double>(bits >> 11) * 0x1p-52 - 1);
  });
}

/// Are all particles within the support of some in their clusters' lists, once each? Empty, or which is not.
template <int Dim, class Real> std::string check_list(const State<Dim, Real>& s) {
  const Particles<Dim, Real>& p = s.particles;
  const ShiftTable<Dim>& shifts = s.neighbours.shifts();
  const auto chunks = s.neighbours.chunks();
  for (std::size_t k = 0; k < chunks.size(); k += std::max<std::size_t>(1, chunks.size() / 20)) {
    const std::uint32_t cluster = chunks[k].begin;
    std::vector<std::uint32_t> listed;
    s.neighbours.for_each_list(chunks[k], [&](std::uint32_t c, auto list) {
      if (c == cluster)
        for (const ListEntry e : list) listed.push_back(static_cast<std::uint32_t>(shifts.group(e)));
    });
    for (std::size_t i = std::size_t{cluster} * cluster_size; i < (std::size_t{cluster} + 1) * cluster_size; ++i)
      for (std::size_t j = 0; j < p.slots(); ++j) {
        if (p.is_padding(i) || p.is_padding(j)) continue;
        double r2 = 0;
        for (int d = 0; d < Dim; ++d) r2 += std::pow(p[position][d][i] - p[position][d][j], 2);
        if (r2 < std::pow(s.parameters.support_radius, 2) &&
            std::count(listed.begin(), listed.end(), static_cast<std::uint32_t>(j / group_size<Real>)) != 1)
          return fmt::format("particle {} is missing in the list of {}", p[id][0][j], p[id][0][i]);
      }
  }
  return "";
}

template <int Dim, class Real, class F>
void time_part(benchmark::State& bench, long long particles, bool moving, F&& part) {
  State<Dim, Real> s = moving_dam_break<Dim, Real>(particles, 1.3);
  if (const std::string wrong = check_list(s); !wrong.empty()) return bench.SkipWithError(wrong.c_str());
  double seconds = 0, sign = 1;
  for (auto _ : bench) {
    if (moving) shake(s, sign = -sign);
    const Stopwatch watch;
    part(s);
    bench.SetIterationTime(watch.seconds());
    seconds += watch.seconds();
  }
  if (const std::string wrong = check_list(s); moving && !wrong.empty()) return bench.SkipWithError(wrong.c_str());
  const auto count = static_cast<double>(s.particles.count()), times = static_cast<double>(bench.iterations());
  bench.counters["ns_per_particle"] = 1e9 * seconds / times / count;
  bench.counters["list_entries_per_particle"] = listed_pairs(s) / (cluster_size * cluster_size) / count;
  bench.counters["list_bytes_per_particle"] = static_cast<double>(s.neighbours.bytes()) / count;
}

template <int Dim, class Real> void add_parts(const std::string& size, long long particles) {
  const auto part = [&](const std::string& name, bool moving, auto&& work) {
    benchmark::RegisterBenchmark(named<Real>("neighbours/" + name + "/" + size).c_str(),
                                 [=](benchmark::State& bench) { time_part<Dim, Real>(bench, particles, moving, work); })
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
  };
  using S = State<Dim, Real>;
  part("sort_and_list", true, [](S& s) { sort_and_list(s); });
  part("rebuild", true, [](S& s) { s.neighbours.rebuild(s.particles); });
  part("boxes_and_list", false, [](S& s) { s.neighbours.relist(s.particles); });
  part("permute", false, [](S& s) {
    std::vector<std::int32_t> order(s.particles.slots());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = static_cast<std::int32_t>(k);
    s.particles.permute(order, s.particles.count());
  });
  part("look_for_walls", false, [](S& s) { look_for_walls(s); });
}

}  // namespace
}  // namespace molten::bench

int main(int argc, char** argv) {
  return molten::bench::run_program(argc, argv, [] {
    molten::bench::add_parts<3, float>("3d/100k", 100000);
    molten::bench::add_parts<3, float>("3d/1M", 1000000);
    molten::bench::add_parts<2, float>("2d/100k", 100000);
  });
}
