// What this machine can do at most, measured: the roofs that benchmarks are held against.
#pragma once

namespace molten::bench {

/// Operations a second of all threads together in fused multiply-adds on full lanes, each counted as two.
template <class Real> double peak_arithmetic();

/// Bytes a second of all threads together in a = b + s c over arrays far larger than the caches; the fill of a's cache
/// lines before they are written counts too.
double memory_bandwidth();

/// The same, measured once a process.
template <class Real> double usual_peak_arithmetic();
double usual_memory_bandwidth();

}  // namespace molten::bench
