// The rates pass and the whole step on states of fixed names, so that figures can be compared over time:
//   build/release/bench/step [NAME PREFIX ...] [--exact] [--steps=N] [Google Benchmark's flags]; threads by
//   OMP_NUM_THREADS.
// rates/… is timed on a jittered block whose list is half used up. step/wcsph/… is timed in the moving dam break of
// dam_break.h: list rebuilds and contact with the tank are what they are there; the steps timed are fixed (below), so
// that builds are compared over the same stretch of the run. step/smd-heat/bunny starts from its scene after 200 steps.
#include <algorithm>
#include <memory>

#include "bench/cases.h"
#include "bench/dam_break.h"
#include "bench/naive.h"
#include "bench/peak.h"
#include "bench/program.h"
#include "bench/terms.h"
#include "core/diagnostics.h"
#include "core/step.h"

namespace molten::bench {
namespace {

template <int Dim, class Real> Work work_of(const State<Dim, Real>& s) {
  Work work;
  work.particles = static_cast<double>(s.particles.count());
  work.pairs = static_cast<double>(count_pairs(s));
  work.lanes = listed_pairs(s);
  with_rate_terms(
      s, [&](const auto&... terms) { work.operations_a_pair = static_cast<double>(operations_a_pair<Dim>(terms...)); });
  if (s.features.stress) work.operations_a_pair += static_cast<double>(operations_a_pair<Dim>(StrainRateTerm{}));
  return work;
}

/// The rates pass alone, over and over on one state.
template <int Dim, class Real> void time_rates(benchmark::State& bench, State<Dim, Real>& s) {
  if (const std::string wrong = check_rates(s); !wrong.empty()) return bench.SkipWithError(wrong.c_str());
  const double peak = peak_arithmetic<Real>();
  const Stopwatch watch;
  for (auto _ : bench) find_rates(s);
  const double elapsed = watch.seconds();
  count_work(bench, work_of(s), elapsed, peak);
  bench.counters["bytes_per_particle"] = bytes_a_particle(s);
}

/// Steps one after the other; each iteration is a step. Beside the counters, ms a step of each scope of the timer.
template <int Dim, class Real> void time_steps(benchmark::State& bench, State<Dim, Real> s) {
  if (const std::string wrong = check_rates(s); !wrong.empty()) return bench.SkipWithError(wrong.c_str());
  const double peak = peak_arithmetic<Real>();
  const Work before = work_of(s);
  const auto seconds = s.timer.seconds();
  double rebuilds = 0;
  const Stopwatch watch;
  for (auto _ : bench) {
    rebuilds += s.neighbours.is_due();
    step(s);
  }
  const double elapsed = watch.seconds();
  Work work = work_of(s);
  work.pairs = (work.pairs + before.pairs) / 2;
  work.lanes = (work.lanes + before.lanes) / 2;
  count_work(bench, work, elapsed, peak);
  const auto steps = static_cast<double>(bench.iterations());
  bench.counters["bytes_per_particle"] = bytes_a_particle(s);
  bench.counters["steps_a_list"] = steps / std::max(1.0, rebuilds);
  for (const auto& [name, now] : s.timer.seconds()) {
    const auto earlier = seconds.find(name);
    bench.counters[name + " ms"] = 1e3 * (now - (earlier == seconds.end() ? 0 : earlier->second)) / steps;
  }
}

template <int Dim, class Real> void add_rates(const std::string& name, long long particles, double smoothing_ratio) {
  auto kept = std::make_shared<std::unique_ptr<State<Dim, Real>>>();  // over Google Benchmark's attempts
  add(named<Real>(name), [=](benchmark::State& bench) {
    if (!*kept) {
      *kept = std::make_unique<State<Dim, Real>>(jittered_block<Dim, Real>(particles, smoothing_ratio));
      (*kept)->neighbours.moved((*kept)->parameters.skin / 4);  // half of what makes a new list due: the mean of a run
    }
    time_rates(bench, **kept);
  });
}

/// `steps`: enough for several rebuilds and about a minute at most on one thread.
template <int Dim, class Real>
void add_steps(const std::string& name, long long particles, double smoothing_ratio, long long steps) {
  add(named<Real>(name), [=](benchmark::State& bench) {
    time_steps(bench, moving_dam_break<Dim, Real>(particles, smoothing_ratio));
  })->Iterations(steps_to_time(steps));
}

template <class Real> void add_bunny() {
  add(named<Real>("step/smd-heat/bunny"), [](benchmark::State& bench) {
    State<3, Real> s = bunny<Real>();
    for (int k = 0; k < 200; ++k) step(s);
    time_steps(bench, std::move(s));
  })->Iterations(steps_to_time(2000));
}

template <class Real> void add_all() {
  constexpr long long k = 1000, M = 1000000;
  add_rates<3, Real>("rates/wcsph/3d/100k", 100 * k, 1.3);
  add_rates<3, Real>("rates/wcsph/3d/1M", M, 1.3);
  add_rates<3, Real>("rates/wcsph/3d/4M", 4 * M, 1.3);
  add_steps<3, Real>("step/wcsph/3d/100k", 100 * k, 1.3, 2000);
  add_steps<3, Real>("step/wcsph/3d/1M", M, 1.3, 500);
  add_steps<3, Real>("step/wcsph/3d/4M", 4 * M, 1.3, 120);
  add_steps<3, Real>("step/wcsph/3d/1M-165", M, 1.73, 250);
  add_steps<2, Real>("step/wcsph/2d/100k", 100 * k, 1.3, 4000);
  add_bunny<Real>();
}

}  // namespace
}  // namespace molten::bench

int main(int argc, char** argv) {
  return molten::bench::run_program(argc, argv, [] {
    molten::bench::add_all<float>();
    molten::bench::add_all<double>();
  });
}
