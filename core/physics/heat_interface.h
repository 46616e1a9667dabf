// Where bodies that conduct differently meet. The share of the kernel's weight around a particle that is on particles
// of another conductivity says how far they are: beside a plane interface it is about ½ (1 − d)³, d being the distance
// over the kernel's reach. On a lattice at 1.3 spacings d comes out 1.28 and 1.36 times too long in the first two
// columns, of which the ratio alone matters. A pair across an interface sees it where both particles' distances say
// (heat_conduction.h): half-way between any two, it would be as thick as the kernel, an error of first order.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/fields.h"
#include "core/simd.h"

namespace molten {

/// Sums Σ m_j W, and the same over those of another conductivity alone.
struct InterfaceSums {
  using Reads = FieldList<Conductivity>;
  using Sums = FieldList<KernelSum, KernelMean>;
  static constexpr bool on = true;

  template <class Pair, class I, class J, class Out>
  [[gnu::always_inline]] void operator()(const Pair& ij, const I& i, const J& j, Out& out) const {
    using L = std::decay_t<decltype(ij.r2)>;
    const L own = i[conductivity], its = j[conductivity], zero(0), one(1);
    out.W(kernel_sum, one);
    out.W(kernel_mean, select_less(own, its, one, select_less(its, own, one, zero)));
  }
};

/// d. Drops smaller than the kernel, most of whose weight is on others, keep some.
template <class Real> Real interface_distance_at(Real share_of_others) {
  return std::max(Real(1) - std::cbrt(2 * share_of_others), Real(0.02));
}

using InterfaceReads = FieldList<InterfaceDistance, InterfaceResistance>;

/// The conductivity, over the scene's, of materials of this thickness and resistance in series; padding has neither.
template <class Real, class L>
[[gnu::always_inline]] inline L series_conductivity(const L& thickness, const L& resistance) {
  return thickness * reciprocal(resistance + L(std::numeric_limits<Real>::min() * Real(1e8)));
}

/// That between two particles: symmetric to the last bit, so that heat is conserved.
template <class Real, class I, class J>
[[gnu::always_inline]] inline auto conductivity_between(const I& i, const J& j) {
  return series_conductivity<Real>(i[interface_distance] + j[interface_distance],
                                   i[interface_resistance] + j[interface_resistance]);
}

}  // namespace molten
