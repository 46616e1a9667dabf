// The pair pass, term by term and fused, over one list of a million jittered particles that have every column. Each
// benchmark's sums are compared with the naive twin first. `none` has no term: the distance, the kernel and the loop.
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include <fmt/format.h>

#include "bench/cases.h"
#include "bench/naive.h"
#include "bench/peak.h"
#include "bench/program.h"
#include "bench/terms.h"
#include "core/diagnostics.h"
#include "core/pair_pass.h"

namespace molten::bench {
namespace {

/// The least that a pass can sum: shows what distance, kernel and loop cost without a term's own work. (× r²: nothing
/// for a particle with itself.)
struct KernelSlopeSum {
  using Reads = FieldList<>;
  using Sums = FieldList<KernelSum>;
  static constexpr bool on = true;

  template <class Pair, class I, class J, class Out>
  [[gnu::always_inline]] void operator()(const Pair& ij, const I&, const J&, Out& out) const {
    out.gradW(kernel_sum, ij.r2);
  }
};

/// One array a component of what a pass sums.
template <int Dim, class Real, class Sums> class SumColumns {
 public:
  explicit SumColumns(std::size_t slots) {
    for_each_component<Dim>(Sums{}, [&](auto, int) { columns_.emplace_back(slots); });
  }
  auto finish() {
    return PlainFinish{[this](std::size_t slot, const auto& sums) {
      std::size_t n = 0;
      for_each_component<Dim>(Sums{}, [&](auto field, int k) {
        auto copy = sums[field];
        columns_[n++][slot] = component(copy, k);
      });
    }};
  }
  const std::vector<std::vector<Real>>& columns() const { return columns_; }

 private:
  std::vector<std::vector<Real>> columns_;
};

/// Some particles' sums against brute force; empty, or what differs.
template <int Dim, class Real, class... Terms>
std::string check_sums(const State<Dim, Real>& s, const std::vector<std::vector<Real>>& columns,
                       const Terms&... terms) {
  constexpr double tolerance = sizeof(Real) == 4 ? 2e-5 : 3e-11;
  std::string wrong;
  for (std::size_t i = 0; i < s.particles.slots(); i += 1 + s.particles.slots() / 10) {
    if (s.particles.is_padding(i)) continue;
    NaiveSums<Dim, Terms...> naive(s, i, terms...);
    std::size_t n = 0;
    for_each_component<Dim>(naive.fields, [&](auto field, int k) {
      const double got = columns[n++][i], wanted = component(naive.value[field], k).v;
      if (!(std::abs(got - wanted) <= tolerance * component(naive.scale[field], k).v))
        wrong = fmt::format("particle {}: {} is {} instead of {}", s.particles[id][0][i], field.name, got, wanted);
    });
  }
  return wrong;
}

template <int Dim, class Real, class... Terms>
void time_pass(benchmark::State& bench, const State<Dim, Real>& s, const Terms&... terms) {
  SumColumns<Dim, Real, SumsOf<Terms...>> sums(s.particles.slots());
  const Parameters<Dim>& p = s.parameters;
  const Kernel<KernelChoice::wendland_c2, Real> kernel(p.kernel, Dim, p.smoothing_length, p.particle_mass);
  const auto finish = sums.finish();
  const auto pass = [&] { pair_pass<native_lanes<Real>>(s.neighbours, s.particles, kernel, finish, terms...); };
  pass();
  if (const std::string wrong = check_sums(s, sums.columns(), terms...); !wrong.empty())
    return bench.SkipWithError(wrong.c_str());
  const double peak = peak_arithmetic<Real>();
  const Stopwatch watch;
  for (auto _ : bench) pass();
  const double elapsed = watch.seconds();
  Work work;
  work.particles = static_cast<double>(s.particles.count());
  work.pairs = static_cast<double>(count_pairs(s));
  work.lanes = listed_pairs(s);
  work.operations_a_pair = static_cast<double>(operations_a_pair<Dim>(terms...));
  count_work(bench, work, elapsed, peak);
  bench.counters["operations_a_pair"] = work.operations_a_pair;
}

template <int Dim, class Real> void add_passes(const std::string& size, long long particles) {
  auto kept = std::make_shared<std::unique_ptr<State<Dim, Real>>>();
  const auto pass = [&](const std::string& name, const auto&... terms) {
    add(named<Real>("pair_pass/" + name + "/" + size), [=](benchmark::State& bench) {
      if (!*kept) *kept = std::make_unique<State<Dim, Real>>(full_block<Dim, Real>(particles, 1.3));
      time_pass(bench, **kept, terms...);
    });
  };
  constexpr double rho0 = 1000, c = 44, h = 0.013;
  const Continuity continuity;
  const PressureForce pressure;
  const ArtificialViscosity<Real> artificial(0.1, c, h, rho0);
  const StressForce<Dim, Real> stress(true, rho0, h * h);
  const HeatConduction<Real> heat(1e-5, rho0);
  const LaminarViscosity<Real> laminar(10, rho0);
  const XsphTerm<Real> xsph(true, rho0);
  pass("none", KernelSlopeSum{});
  pass("continuity", continuity);
  pass("pressure", pressure);
  pass("artificial_viscosity", artificial);
  pass("laminar_viscosity", laminar);
  pass("strain_rate", StrainRateTerm{});
  pass("stress", stress);
  pass("heat", heat);
  pass("xsph", xsph);
  pass("forces", continuity, pressure, artificial);
  pass("forces_and_heat", continuity, pressure, artificial, stress, heat);
}

}  // namespace
}  // namespace molten::bench

int main(int argc, char** argv) {
  return molten::bench::run_program(argc, argv, [] {
    molten::bench::add_passes<3, float>("3d/1M", 1000000);
    molten::bench::add_passes<3, double>("3d/1M", 1000000);
  });
}
