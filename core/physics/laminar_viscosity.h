// Laminar viscosity of a Newtonian fluid (Morris 1997): Σ m_j (η_i + η_j)/(ρ_i ρ_j) (W'/r) v_ij, one pass, no tensor;
// corrected: times the mean of the particles' factors (gradient_correction.h).
#pragma once

#include <type_traits>

#include "core/fields.h"
#include "core/physics/gradient_correction.h"
#include "core/simd.h"

namespace molten {

template <class Real, bool corrected = false> struct LaminarViscosity {
  using Reads = std::conditional_t<corrected, FieldList<Velocity, Compression, LaplacianCorrection>,
                                   FieldList<Velocity, Compression>>;
  using Sums = FieldList<Acceleration>;
  bool on = false;
  Real strength = 0;  // 2 η/ρ0², Pa s m⁶/kg²

  LaminarViscosity(double viscosity, double rest_density)
      : on(viscosity > 0), strength(Real(2 * viscosity / (rest_density * rest_density))) {}

  template <class Pair, class I, class J, class Out>
  [[gnu::always_inline]] void operator()(const Pair&, const I& i, const J& j, Out& out) const {
    using L = std::decay_t<decltype(i[compression])>;
    L factor = L(strength) * reciprocal((L(1) + i[compression]) * (L(1) + j[compression]));
    if constexpr (corrected) factor = factor * laplacian_correction_of(i, j);
    out.gradW(acceleration, factor * (i[velocity] - j[velocity]));
  }
};

}  // namespace molten
