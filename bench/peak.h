// What this machine can do at most, measured: the roofs that benchmarks are held against.
#pragma once

#include <vector>

#include "core/particles.h"

namespace molten::bench {

/// Fused multiply-adds on full lanes, on all threads.
template <class Real> class ArithmeticProbe {
 public:
  void run();
  double operations() const;  // of one run; a multiply-add counts as two

 private:
  std::vector<Real> results_;
};

/// a = b + s c over arrays far larger than the caches, on all threads.
class MemoryProbe {
 public:
  MemoryProbe();
  void run();
  double bytes() const;  // of one run; the fill of a's cache lines before they are written counts too

 private:
  Buffer memory_[3];
  double* array_[3];
};

/// Operations a second, bytes a second: the best of several runs of the probes.
template <class Real> double peak_arithmetic();
double memory_bandwidth();

}  // namespace molten::bench
