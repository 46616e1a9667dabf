// The particle pass: time integration and what the next pair pass reads, without walls. Each iteration is a whole step
// of a million particles in free flight; what is timed is the pass's own scope in it.
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "bench/cases.h"
#include "bench/peak.h"
#include "bench/program.h"
#include "core/step.h"

namespace molten::bench {
namespace {

/// Bytes a particle of the columns of a list of fields.
template <int Dim, class Real, class... F> constexpr double bytes_of(FieldList<F...>) {
  return (0.0 + ... + (components<F, Dim> * sizeof(stored_t<F, Real>)));
}

/// What the leap-frog pass has to read and write of a particle, each column once; a written cache line is read first
/// where it was not read anyway.
template <int Dim, class Real> constexpr double traffic() {
  using Read =
      FieldList<Id, Position, HalfVelocity, HalfCompression, Acceleration, CompressionRate, PreviousCompressionRate>;
  using Written = FieldList<Position, HalfVelocity, HalfCompression, PreviousCompressionRate>;
  using OnlyWritten = FieldList<Velocity, Compression, PressureTerm, LocalPosition>;
  return bytes_of<Dim, Real>(Read{}) + bytes_of<Dim, Real>(Written{}) + 2 * bytes_of<Dim, Real>(OnlyWritten{});
}

/// One step, particle by particle with the formulas of core/integrate.cpp's head. Empty, or what differs.
template <int Dim, class Real> std::string check_step(State<Dim, Real>& s) {
  const Particles<Dim, Real>& p = s.particles;
  struct Before {
    std::int64_t id;
    double x, v;
  };
  sort_and_list(s);  // so that the step does not
  std::vector<Before> before;
  for (std::size_t slot = 0; slot < p.slots(); slot += 1 + p.slots() / 100)
    before.push_back({p[id][0][slot], p[position][0][slot], p[half_velocity][0][slot]});
  const double kick_before = s.clock.dt;
  step(s);
  std::size_t slot = 0;
  for (const Before& b : before) {
    const double v = b.v + (kick_before + s.clock.dt) / 2 * p[acceleration][0][slot];
    const double x = b.x + s.clock.dt * v;
    if (b.id != padding_id && std::abs(p[position][0][slot] - x) > 1e-6 * s.parameters.spacing)
      return fmt::format("particle {} moved to {} instead of {}", b.id, p[position][0][slot], x);
    slot += 1 + p.slots() / 100;
  }
  return "";
}

template <int Dim, class Real> void time_integration(benchmark::State& bench, long long particles) {
  State<Dim, Real> s = jittered_block<Dim, Real>(particles, 1.3);
  s.features.contact = false;
  step(s);
  if (const std::string wrong = check_step(s); !wrong.empty()) return bench.SkipWithError(wrong.c_str());
  const double bandwidth = memory_bandwidth();
  const auto spent = [&] { return s.timer.seconds().find("integrate")->second; };
  const double start = spent();
  for (auto _ : bench) {
    const double before = spent();
    step(s);
    bench.SetIterationTime(spent() - before);
  }
  const double particle_steps = static_cast<double>(s.particles.count()) * static_cast<double>(bench.iterations());
  const double seconds = spent() - start, bytes = particle_steps * traffic<Dim, Real>();
  bench.counters["particle_steps/s"] = particle_steps / seconds;
  bench.counters["ns_per_particle"] = 1e9 * seconds / particle_steps;
  bench.counters["GB/s"] = 1e-9 * bytes / seconds;
  bench.counters["bandwidth_share"] = bytes / seconds / bandwidth;
}

template <int Dim, class Real> void add_integration(const std::string& size, long long particles) {
  benchmark::RegisterBenchmark(named<Real>("particle_pass/integrate/" + size).c_str(),
                               [=](benchmark::State& bench) { time_integration<Dim, Real>(bench, particles); })
      ->UseManualTime()
      ->Iterations(steps_to_time(40))
      ->Unit(benchmark::kMillisecond);
}

}  // namespace
}  // namespace molten::bench

int main(int argc, char** argv) {
  return molten::bench::run_program(argc, argv, [] {
    molten::bench::add_integration<3, float>("3d/1M", 1000000);
    molten::bench::add_integration<3, double>("3d/1M", 1000000);
    molten::bench::add_integration<2, float>("2d/1M", 1000000);
  });
}
