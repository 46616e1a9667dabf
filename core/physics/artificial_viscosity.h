// Artificial viscosity (Monaghan; [P] 6-14, 6-15; [D] 5.1): Π_ij = −α c μ_ij/ρ̄ where v_ij·x_ij < 0, else 0, with
// μ_ij = h v_ij·x_ij/(r² + 0.01 h²); it enters as −Σ m_j Π_ij ∇W_ij ([P] 6-14 prints m_j/ρ_i, a wrong dimension).
#pragma once

#include "core/fields.h"
#include "core/simd.h"

namespace molten {

template <class Real>
struct ArtificialViscosity {
  using Reads = FieldList<Velocity, Compression>;
  using Sums = FieldList<Acceleration>;
  using Radial = FieldList<Acceleration>;
  bool on = false;
  Real strength = 0;   // 2 α c h / ρ0, m⁵/(kg s)
  Real softening = 0;  // 0.01 h², m²

  ArtificialViscosity(double alpha, double sound_speed, double smoothing_length, double rest_density)
      : on(alpha > 0),
        strength(Real(2 * alpha * sound_speed * smoothing_length / rest_density)),
        softening(Real(0.01 * smoothing_length * smoothing_length)) {}

  template <class Pair, class I, class J, class Out>
  void operator()(const Pair& ij, const I& i, const J& j, Out& out) const {
    using L = decltype(ij.r2);
    const L approach = min(dot(i[velocity] - j[velocity], ij.x), L(0));
    const L twice_density = L(2) + i[compression] + j[compression];  // 2 ρ̄/ρ0
    out.along(acceleration, L(strength) * approach * reciprocal((ij.r2 + L(softening)) * twice_density));
  }
};

}  // namespace molten
