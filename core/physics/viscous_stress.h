// Generalised Newtonian stress ([P] 4-38, 4-45, 6-1): the rate of strain D = ∇v + (∇v)ᵀ with
// ∇v_i = Σ V_j (v_j − v_i) ⊗ ∇W_ij, and the force Σ m_j (S_i/ρ_i² + S_j/ρ_j²)·∇W_ij of the stress S = η D.
#pragma once

#include <type_traits>

#include "core/fields.h"
#include "core/simd.h"

namespace molten {

/// Sums ρ0 D; the caller divides by ρ0.
struct StrainRateTerm {
  using Reads = FieldList<Velocity, Compression>;
  using Sums = FieldList<StrainRate>;
  static constexpr bool on = true;

  template <class Pair, class I, class J, class Out>
  void operator()(const Pair& ij, const I& i, const J& j, Out& out) const {
    using L = std::decay_t<decltype(i[compression])>;
    const L volume = reciprocal(L(1) + j[compression]);  // V_j ρ0/m
    out.gradW(strain_rate, twice_symmetric(volume * (j[velocity] - i[velocity]), ij.x));
  }
};

struct StressForce {
  using Reads = FieldList<Stress>;
  using Sums = FieldList<Acceleration>;
  bool on = false;

  template <class Pair, class I, class J, class Out>
  void operator()(const Pair& ij, const I& i, const J& j, Out& out) const {
    out.gradW(acceleration, (i[stress] + j[stress]) * ij.x);
  }
};

}  // namespace molten
