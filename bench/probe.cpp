// What the machine can do at most: the arithmetic that two threads are given beside one (scripts/bench-scaling), and
// the roofs of the roofline in docs/performance.md.
#include "bench/peak.h"
#include "bench/program.h"

namespace molten::bench {
namespace {

template <class Real> void add_arithmetic() {
  add(named<Real>("probe/arithmetic"), [](benchmark::State& bench) {
    ArithmeticProbe<Real> probe;
    const Stopwatch watch;
    for (auto _ : bench) probe.run();
    bench.counters["GFLOP/s"] = 1e-9 * probe.operations() * static_cast<double>(bench.iterations()) / watch.seconds();
  });
}

void add_memory() {
  add("probe/memory", [](benchmark::State& bench) {
    MemoryProbe probe;
    const Stopwatch watch;
    for (auto _ : bench) probe.run();
    bench.counters["GB/s"] = 1e-9 * probe.bytes() * static_cast<double>(bench.iterations()) / watch.seconds();
  });
}

}  // namespace
}  // namespace molten::bench

int main(int argc, char** argv) {
  return molten::bench::run_program(argc, argv, [] {
    molten::bench::add_arithmetic<float>();
    molten::bench::add_arithmetic<double>();
    molten::bench::add_memory();
  });
}
