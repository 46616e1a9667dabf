// Continuity: dρ_i/dt = Σ m_j v_ij · ∇W_ij ([P] 4-37, [D] 4.4). The sum is the rate of ρ; the caller divides by ρ0.
#pragma once

#include "core/fields.h"

namespace molten {

struct Continuity {
  using Reads = FieldList<Velocity>;
  using Sums = FieldList<CompressionRate>;
  static constexpr bool on = true;

  template <class Pair, class I, class J, class Out>
  [[gnu::always_inline]] void operator()(const Pair& ij, const I& i, const J& j, Out& out) const {
    out.gradW(compression_rate, dot(i[velocity] - j[velocity], ij.x));
  }
};

}  // namespace molten
