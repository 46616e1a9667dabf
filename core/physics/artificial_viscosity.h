// Artificial viscosity (Monaghan; [P] 6-14, 6-15; [D] 5.1): Π_ij = −α c μ_ij/ρ̄ where v_ij·x_ij < 0, else 0, with
// μ_ij = h v_ij·x_ij/(r² + 0.01 h²); it enters as −Σ m_j Π_ij ∇W_ij ([P] 6-14 prints m_j/ρ_i, a wrong dimension).
// c is constant, or the mean of the particles' own c_i = c0 (ρ_i/ρ0)³, that of Tait with γ = 7 ([D] 4.2).
#pragma once

#include "core/fields.h"
#include "core/simd.h"

namespace molten {

template <class Real, bool varied_sound = false> struct ArtificialViscosity {
  using Reads = FieldList<Velocity, Compression>;
  using Sums = FieldList<Acceleration>;
  using Radial = FieldList<Acceleration>;
  bool on = false;
  Real inverse_strength = 0;  // ρ0/(2 α c h), kg s/m⁵
  Real softening = 0;         // 0.01 h², m²

  bool particle_sound = false;

  ArtificialViscosity(double alpha, double sound_speed, double smoothing_length, double rest_density,
                      bool particle_sound_ = false)
      : on(alpha > 0),
        inverse_strength(on ? Real(rest_density / (2 * alpha * sound_speed * smoothing_length)) : 0),
        softening(Real(0.01 * smoothing_length * smoothing_length)),
        particle_sound(particle_sound_) {}

  template <class Pair, class I, class J, class Out>
  [[gnu::always_inline]] void operator()(const Pair& ij, const I& i, const J& j, Out& out) const {
    using L = decltype(ij.r2);
    L approach = min(dot(i[velocity] - j[velocity], ij.x), L(0));
    if constexpr (varied_sound)
      if (particle_sound) approach = approach * mean_sound(i[compression], j[compression]);
    // 2 ρ̄/ρ0 over the strength; grouped so that i's share is worked out once
    const L density = L(inverse_strength) * (L(2) + i[compression]) + L(inverse_strength) * j[compression];
    out.along(acceleration, approach * reciprocal((ij.r2 + L(softening)) * density));
  }

 private:
  /// c̄/c0 of a pair
  template <class L> [[gnu::always_inline]] static L mean_sound(const L& a, const L& b) {
    const L x = L(1) + a, y = L(1) + b;
    return L(Real(0.5)) * (x * x * x + y * y * y);
  }
};

}  // namespace molten
