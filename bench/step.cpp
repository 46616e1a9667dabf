// The rates pass and the whole step on states of fixed names, so that figures can be compared over time:
//   build/release/bench/step [NAME PREFIX ...] [Google Benchmark's flags]; threads by OMP_NUM_THREADS.
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <omp.h>

#include <functional>
#include <string>
#include <vector>

#include "bench/cases.h"
#include "core/diagnostics.h"
#include "core/step.h"
#include "io/program/report.h"
#include "version.h"

namespace molten::bench {
namespace {

template <int Dim, class Real> void count(benchmark::State& bench, const State<Dim, Real>& s, double pairs) {
  const auto n = static_cast<double>(s.particles.count());
  bench.counters["particle_steps/s"] = benchmark::Counter(n, benchmark::Counter::kIsIterationInvariantRate);
  bench.counters["pairs/s"] = benchmark::Counter(pairs, benchmark::Counter::kIsIterationInvariantRate);
  bench.counters["bytes_per_particle"] = static_cast<double>(s.bytes()) / n;
  bench.counters["neighbours"] = pairs / n;
}

/// Times `work` on a state that has passed the naive check.
template <int Dim, class Real>
void time_on(benchmark::State& bench, State<Dim, Real> s, const std::function<void(State<Dim, Real>&)>& work) {
  if (const std::string wrong = check_rates(s); !wrong.empty()) return bench.SkipWithError(wrong.c_str());
  const auto pairs = static_cast<double>(count_pairs(s));
  for (auto _ : bench) work(s);
  count(bench, s, pairs);
}

template <int Dim, class Real>
void add_block(const std::string& name, bool whole_step, long long particles, double smoothing_ratio) {
  const std::string full = name + (sizeof(Real) == 8 ? "/double" : "");
  benchmark::RegisterBenchmark(full.c_str(),
                               [=](benchmark::State& bench) {
                                 time_on<Dim, Real>(bench, jittered_block<Dim, Real>(particles, smoothing_ratio),
                                                    whole_step ? step<Dim, Real> : find_rates<Dim, Real>);
                               })
      ->UseRealTime()
      ->Unit(benchmark::kMillisecond);
}

template <class Real> void add_all() {
  constexpr long long k = 1000, M = 1000000;
  add_block<3, Real>("rates/wcsph/3d/1M", false, M, 1.3);
  add_block<3, Real>("step/wcsph/3d/100k", true, 100 * k, 1.3);
  add_block<3, Real>("step/wcsph/3d/1M", true, M, 1.3);
  add_block<3, Real>("step/wcsph/3d/4M", true, 4 * M, 1.3);
  add_block<3, Real>("step/wcsph/3d/1M-165", true, M, 1.73);
  add_block<2, Real>("step/wcsph/2d/100k", true, 100 * k, 1.3);
  const std::string bunny_name = std::string("step/smd-heat/bunny") + (sizeof(Real) == 8 ? "/double" : "");
  benchmark::RegisterBenchmark(bunny_name.c_str(),
                               [](benchmark::State& bench) { time_on<3, Real>(bench, bunny<Real>(), step<3, Real>); })
      ->UseRealTime()
      ->Unit(benchmark::kMillisecond);
}

/// Names given as they are match as prefixes: they become Google Benchmark's filter.
std::vector<std::string> with_filter(int argc, char** argv) {
  std::vector<std::string> flags;
  std::string filter;
  for (int k = 1; k < argc; ++k) {
    const std::string word = argv[k];
    if (word.starts_with("-"))
      flags.push_back(word);
    else
      filter += (filter.empty() ? "^(" : "|") + word;
  }
  if (!filter.empty()) flags.push_back("--benchmark_filter=" + filter + ")");
  return flags;
}

}  // namespace
}  // namespace molten::bench

int main(int argc, char** argv) {
  std::vector<std::string> flags = molten::bench::with_filter(argc, argv);
  std::vector<char*> words{argv[0]};
  for (std::string& f : flags) words.push_back(f.data());
  int count = static_cast<int>(words.size());
  benchmark::Initialize(&count, words.data());
  benchmark::AddCustomContext("commit", MOLTEN_COMMIT);
  benchmark::AddCustomContext("compiler", molten::compiler_name());
  benchmark::AddCustomContext("flags", MOLTEN_FLAGS);
  benchmark::AddCustomContext("cpu", molten::cpu_name());
  benchmark::AddCustomContext("threads", std::to_string(omp_get_max_threads()));
  molten::bench::add_all<float>();
  molten::bench::add_all<double>();
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
