// Density diffusion (δ-SPH: Molteni and Colagrossi 2009) without the hydrostatic part of the difference (Fourtakas et
// al. 2019), so that a fluid at rest stays as it is, also at its surface and its walls:
//   dρ_i/dt += 2 δ h c Σ V_j (ρ_i − ρ_j − ρ^H_ij) W'/r,  ρ^H_ij = ρ̄ g·(x_i − x_j)/c(ρ̄)²,  c(ρ)² = c² (ρ/ρ0)^{γ−1}
// (γ = 1: the linear equation of state and the ideal gas), to first order in ρ̄/ρ0 − 1.
#pragma once

#include <array>

#include "core/fields.h"
#include "core/physics/pressure.h"
#include "core/simd.h"

namespace molten {

template <int Dim, class Real> struct DensityDiffusion {
  using Reads = FieldList<Compression>;
  using Sums = FieldList<CompressionRate>;
  static constexpr bool at_walls = false;  // no flux: there the difference is hydrostatic
  bool on = false;
  Real strength = 0;           // 2 δ h c, m²/s
  Vec<Dim, Real> hydrostatic;  // g/c², 1/m
  Real stiffening = 0;         // (2 − γ)/2

  DensityDiffusion(double delta, double smoothing_length, const EquationOfState& eos,
                   const std::array<double, Dim>& gravity)
      : on(delta > 0),
        strength(Real(2 * delta * smoothing_length * eos.sound_speed)),
        stiffening(Real(eos.kind != StateEquation::tait ? 0.5 : (2 - eos.gamma) / 2)) {
    for (int d = 0; d < Dim; ++d) hydrostatic[d] = Real(gravity[d] / (eos.sound_speed * eos.sound_speed));
  }

  template <class Pair, class I, class J, class Out>
  [[gnu::always_inline]] void operator()(const Pair& ij, const I& i, const J& j, Out& out) const {
    using L = decltype(ij.r2);
    Vec<Dim, L> slope;
    unrolled<Dim>([&](auto d) { slope[d] = L(hydrostatic[d]); });
    const L at_rest = dot(slope, ij.x) * (L(1) + L(stiffening) * (i[compression] + j[compression]));
    const L beyond = i[compression] - j[compression] - at_rest;
    out.gradW(compression_rate, L(strength) * beyond * reciprocal(L(1) + j[compression]));
  }
};

}  // namespace molten
