// Tensile correction (Monaghan 2000; [D] 5.21, 5.22): the force −Σ m_j R f_ij⁴ ∇W_ij with f_ij = W(r)/W(Δx) keeps
// particles from pairing; R = R_i + R_j with 0.01 p/ρ² of positive pressure and 0.2 |p|/ρ² of negative.
#pragma once

#include "core/fields.h"
#include "core/simd.h"

namespace molten {

template <class Real> struct TensileCorrection {
  using Reads = FieldList<PressureTerm>;
  using Sums = FieldList<Acceleration>;
  using Radial = FieldList<Acceleration>;
  bool on = false;
  Real inverse_w = 0;  // 1/(m W(Δx)), m^d/kg

  TensileCorrection(bool on_, double mass_times_w) : on(on_), inverse_w(Real(1 / mass_times_w)) {}

  template <class Pair, class I, class J, class Out>
  [[gnu::always_inline]] void operator()(const Pair& ij, const I& i, const J& j, Out& out) const {
    using L = std::decay_t<decltype(ij.r2)>;
    const auto share = [](const L& term) { return max(L(Real(0.01)) * term, L(Real(-0.2)) * term); };
    const L f = L(inverse_w) * out.kernel.w, f2 = f * f;
    out.along(acceleration, -(share(i[pressure_term]) + share(j[pressure_term])) * f2 * f2);
  }
};

}  // namespace molten
