// What the benchmark programs share: their command line, what they say of build and machine, their counters.
#pragma once

#include <benchmark/benchmark.h>

#include <chrono>
#include <functional>
#include <string>

#include "core/state.h"

namespace molten::bench {

/// The main of a benchmark program: names given as they are match as prefixes (with --exact only as they are),
/// --steps=N overrides the steps that whole-step benchmarks time, the rest is Google Benchmark's. `add` registers the
/// benchmarks; `conclude` comes after them.
int run_program(int argc, char** argv, const std::function<void()>& add, const std::function<void()>& conclude = {});

/// --steps=N, else `usual`.
long long steps_to_time(long long usual);

/// "name" in single, "name/double" in double precision.
template <class Real> std::string named(const std::string& name) { return name + (sizeof(Real) == 8 ? "/double" : ""); }

/// Registers a benchmark whose time is the wall's, in ms.
benchmark::internal::Benchmark* add(const std::string& name, const std::function<void(benchmark::State&)>& run);

/// Counters of one iteration: particles, and directed pairs within the support with their operations each.
struct Work {
  double particles = 0, pairs = 0, operations_a_pair = 0;
  double lanes = 0;  // pairs that were computed, idle lanes too
};

/// Wall time of the iterations so far, s.
class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Sets particle_steps/s, pairs/s, neighbours, GFLOP/s (of the pairs within the support) and peak_share (of all lanes'
/// arithmetic, idle ones too, in the peak that the probe measured before); `seconds`: of all iterations.
void count_work(benchmark::State& bench, const Work& work, double seconds, double peak_arithmetic);

/// Pairs that a pass over the present list computes: clusters against groups.
template <int Dim, class Real> double listed_pairs(const State<Dim, Real>& s) {
  double entries = 0;
  for (const ClusterChunk& chunk : s.neighbours.chunks())
    s.neighbours.for_each_list(chunk, [&](std::uint32_t, auto list) { entries += static_cast<double>(list.size()); });
  return entries * cluster_size * group_size<Real>;
}

template <int Dim, class Real> double bytes_a_particle(const State<Dim, Real>& s) {
  return static_cast<double>(s.bytes()) / static_cast<double>(s.particles.count());
}

}  // namespace molten::bench
