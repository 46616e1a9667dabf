#include "bench/peak.h"

#include <algorithm>
#include <chrono>
#include <vector>

#include "core/particle_pass.h"
#include "core/particles.h"
#include "core/simd.h"

namespace molten::bench {

namespace {

/// The shortest of several runs, s.
template <class F> double shortest(int runs, F&& f) {
  double best = 1e300;
  for (int k = 0; k < runs; ++k) {
    const auto start = std::chrono::steady_clock::now();
    f();
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return best;
}

constexpr int chains = 12;  // of dependent operations: enough to hide the latency, few enough for 16 registers
constexpr int links = 1 << 12;

template <class Real> Real chain_up(Real factor) {
  using L = Lanes<Real, native_lanes<Real>>;
  const L f(factor), addend(Real(1e-3));
  L x[chains];
  for (int k = 0; k < chains; ++k) x[k] = L(Real(k));
  for (int n = 0; n < links; ++n) unrolled<chains>([&](auto k) { x[k] = x[k] * f + addend; });
  Real sum = 0;
  for (int k = 0; k < chains; ++k) sum += x[k].v[0];
  return sum;
}

}  // namespace

template <class Real> double peak_arithmetic() {
  constexpr std::size_t pieces = 256;
  std::vector<Real> results(pieces);
  const double seconds = shortest(8, [&] {
    for_each_piece(pieces, [&](std::size_t k) { results[k] = chain_up<Real>(Real(0.999) + Real(1e-6) * Real(k)); });
  });
  return 2.0 * pieces * links * chains * native_lanes<Real> / seconds;
}

double memory_bandwidth() {
  constexpr std::size_t count = 1 << 24;  // 3 × 128 MB
  Buffer memory[3];
  double* array[3];
  for (int k = 0; k < 3; ++k) {
    memory[k].resize(count * sizeof(double));
    array[k] = static_cast<double*>(memory[k].data());
  }
  for_each_slot(count, [&](std::size_t n) { array[0][n] = 0, array[1][n] = 1, array[2][n] = 2; });
  const double seconds =
      shortest(5, [&] { for_each_slot(count, [&](std::size_t n) { array[0][n] = array[1][n] + 3 * array[2][n]; }); });
  return 4.0 * count * sizeof(double) / seconds;
}

template <class Real> double usual_peak_arithmetic() {
  static const double peak = peak_arithmetic<Real>();
  return peak;
}

double usual_memory_bandwidth() {
  static const double bandwidth = memory_bandwidth();
  return bandwidth;
}

template double peak_arithmetic<float>();
template double peak_arithmetic<double>();
template double usual_peak_arithmetic<float>();
template double usual_peak_arithmetic<double>();

}  // namespace molten::bench
