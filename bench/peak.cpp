#include "bench/peak.h"

#include <algorithm>
#include <chrono>

#include "core/particle_pass.h"
#include "core/simd.h"
#include "core/vec.h"

namespace molten::bench {

namespace {

constexpr std::size_t pieces = 256;
constexpr int links = 1 << 12;
constexpr int chains = 12;  // of dependent operations: enough to hide the latency, few enough for 16 registers
constexpr std::size_t doubles = 1 << 24;  // an array: 128 MB

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

/// The shortest of several runs, s.
template <class Probe> double shortest(int runs, Probe& probe) {
  double best = 1e300;
  for (int k = 0; k < runs; ++k) {
    const auto start = std::chrono::steady_clock::now();
    probe.run();
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return best;
}

}  // namespace

template <class Real> void ArithmeticProbe<Real>::run() {
  results_.resize(pieces);
  for_each_piece(pieces, [&](std::size_t k) { results_[k] = chain_up<Real>(Real(0.999) + Real(1e-6) * Real(k)); });
}

template <class Real> double ArithmeticProbe<Real>::operations() const {
  return 2.0 * pieces * links * chains * native_lanes<Real>;
}

MemoryProbe::MemoryProbe() {
  for (int k = 0; k < 3; ++k) {
    memory_[k].resize(doubles * sizeof(double));
    array_[k] = static_cast<double*>(memory_[k].data());
  }
  for_each_slot(doubles, [&](std::size_t n) { array_[0][n] = 0, array_[1][n] = 1, array_[2][n] = 2; });
}

void MemoryProbe::run() {
  for_each_slot(doubles, [&](std::size_t n) { array_[0][n] = array_[1][n] + 3 * array_[2][n]; });
}

double MemoryProbe::bytes() const { return 4.0 * doubles * sizeof(double); }

template <class Real> double peak_arithmetic() {
  ArithmeticProbe<Real> probe;
  return probe.operations() / shortest(8, probe);
}

double memory_bandwidth() {
  MemoryProbe probe;
  return probe.bytes() / shortest(5, probe);
}

template class ArithmeticProbe<float>;
template class ArithmeticProbe<double>;
template double peak_arithmetic<float>();
template double peak_arithmetic<double>();

}  // namespace molten::bench
