#include "bench/program.h"

#include <omp.h>

#include <cstdlib>
#include <vector>

#include "core/error.h"
#include "io/program/report.h"
#include "version.h"

namespace molten::bench {

namespace {

long long asked_steps = 0;

/// Names become Google Benchmark's filter; it adds to them itself how they are timed.
std::vector<std::string> flags_of(int argc, char** argv) {
  std::vector<std::string> flags;
  std::string filter;
  const std::string steps = "--steps=";
  bool exact = false;
  for (int k = 1; k < argc; ++k) {
    const std::string word = argv[k];
    if (word.starts_with(steps))
      asked_steps = std::atoll(word.c_str() + steps.size());
    else if (word == "--exact")
      exact = true;
    else if (word.starts_with("-"))
      flags.push_back(word);
    else
      filter += (filter.empty() ? "^(" : "|") + word;
  }
  if (!filter.empty())
    flags.push_back("--benchmark_filter=" + filter + (exact ? ")(/iterations.*|/real_time|/manual_time)?$" : ")"));
  return flags;
}

}  // namespace

int run_program(int argc, char** argv, const std::function<void()>& add, const std::function<void()>& conclude) {
  std::vector<std::string> flags = flags_of(argc, argv);
  std::vector<char*> words{argv[0]};
  for (std::string& f : flags) words.push_back(f.data());
  int count = static_cast<int>(words.size());
  benchmark::Initialize(&count, words.data());
  if (benchmark::ReportUnrecognizedArguments(count, words.data())) return 2;
  benchmark::AddCustomContext("commit", MOLTEN_COMMIT);
  benchmark::AddCustomContext("compiler", compiler_name());
  benchmark::AddCustomContext("flags", MOLTEN_FLAGS);
  benchmark::AddCustomContext("cpu", cpu_name());
  benchmark::AddCustomContext("threads", std::to_string(omp_get_max_threads()));
  add();
  const bool any = benchmark::RunSpecifiedBenchmarks() > 0;
  if (conclude) conclude();
  return any ? 0 : 2;
}

long long steps_to_time(long long usual) { return asked_steps > 0 ? asked_steps : usual; }

benchmark::internal::Benchmark* add(const std::string& name, const std::function<void(benchmark::State&)>& run) {
  const auto run_or_say_why_not = [run](benchmark::State& bench) {
    try {
      run(bench);
    } catch (const Error& error) {
      bench.SkipWithError(error.what());
    }
  };
  return benchmark::RegisterBenchmark(name.c_str(), run_or_say_why_not)->UseRealTime()->Unit(benchmark::kMillisecond);
}

void count_work(benchmark::State& bench, const Work& work, double seconds, double peak_arithmetic) {
  const double a_second = static_cast<double>(bench.iterations()) / seconds;
  bench.counters["particle_steps/s"] = work.particles * a_second;
  bench.counters["pairs/s"] = work.pairs * a_second;
  bench.counters["neighbours"] = work.pairs / work.particles;
  bench.counters["GFLOP/s"] = 1e-9 * work.pairs * work.operations_a_pair * a_second;
  bench.counters["peak_share"] = work.lanes * work.operations_a_pair * a_second / peak_arithmetic;
}

}  // namespace molten::bench
