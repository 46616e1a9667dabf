// Particle shifting (Lind et al. 2012; Skillen et al. 2013): particles move with v + δv,
// δv_i = −C U h Σ V_j ∇W_ij, from where they are many to where they are few. U is the largest speed, at most a tenth of
// the speed of sound, the fastest flow that it is made for: the coupling of the density (density_coupling.h) may raise
// speeds, and with a rate that followed them it ran away in corners of tanks. It fades towards a free surface, where
// the sum measures the missing half (GradientCorrection::inner), and stays below U/2. There neighbours nearer than 0.65
// Δx, and they alone, part in its place, or particles clump: their share of the sum, with the weight 1 − r²/(0.65 Δx)²,
// lacks no half. (From 0.8 Δx on a rotating patch loses four times the energy.) What a moving particle then sees of the
// field that it carries (arbitrary Lagrangian-Eulerian; Sun et al. 2019): dv/dt += (δv·∇)v and dρ/dt += δv·∇ρ, both
// with corrected gradients.
#pragma once

#include "core/fields.h"
#include "core/simd.h"

namespace molten {

/// Sums ρ0 Σ V_j ∇W_ij.
struct Crowding {
  using Reads = FieldList<>;
  using Sums = FieldList<CrowdingGradient>;
  using Radial = FieldList<CrowdingGradient>;
  bool on = false;

  template <class Pair, class I, class J, class Out>
  [[gnu::always_inline]] void operator()(const Pair& ij, const I&, const J&, Out& out) const {
    out.along(crowding_gradient, decltype(ij.r2)(1));
  }
};

/// Sums ρ0 Σ V_j max(0, 1 − r²/(0.65 Δx)²) ∇W_ij: zero for particles in order.
template <class Real> struct PartingOfClose {
  using Reads = FieldList<>;
  using Sums = FieldList<Parting>;
  using Radial = FieldList<Parting>;
  static constexpr bool at_walls = false;  // the fluid's alone
  static constexpr bool on = true;
  Real inverse_near2 = 0;  // 1/m²

  explicit PartingOfClose(double spacing) : inverse_near2(Real(1 / (0.65 * 0.65 * spacing * spacing))) {}

  template <class Pair, class I, class J, class Out>
  [[gnu::always_inline]] void operator()(const Pair& ij, const I&, const J&, Out& out) const {
    using L = std::decay_t<decltype(ij.r2)>;
    out.along(parting, max(L(1) - L(inverse_near2) * ij.r2, L(0)));
  }
};

/// Continuity with corrected gradients, dρ_i/dt = −ρ_i Σ V_j (v_j − v_i)·L_i ∇W_ij, and what shifting adds to it.
struct CorrectedContinuity {
  using Reads = FieldList<Velocity, Compression, Correction, ShiftVelocity>;
  using Sums = FieldList<CompressionRate>;
  static constexpr bool on = true;
  bool shifting = false;

  template <class Pair, class I, class J, class Out>
  [[gnu::always_inline]] void operator()(const Pair& ij, const I& i, const J& j, Out& out) const {
    using L = std::decay_t<decltype(ij.r2)>;
    const auto x = i[correction] * ij.x;
    L rate = (L(1) + i[compression]) * dot(i[velocity] - j[velocity], x);
    if (shifting) rate += (j[compression] - i[compression]) * dot(i[shift_velocity], x);
    out.gradW(compression_rate, rate);
  }
};

/// (δv·∇)v
template <class Real> struct ShiftTransport {
  using Reads = FieldList<Velocity, Correction, ShiftVelocity>;
  using Sums = FieldList<Acceleration>;
  bool on = false;
  Real inverse_density = 0;  // 1/ρ0, m³/kg

  ShiftTransport(bool on_, double rest_density) : on(on_), inverse_density(Real(1 / rest_density)) {}

  template <class Pair, class I, class J, class Out>
  [[gnu::always_inline]] void operator()(const Pair& ij, const I& i, const J& j, Out& out) const {
    using L = std::decay_t<decltype(ij.r2)>;
    const auto way = i[correction] * i[shift_velocity];  // L is symmetric: δv·L ∇W = (L δv)·∇W
    out.gradW(acceleration, (L(inverse_density) * dot(way, ij.x)) * (j[velocity] - i[velocity]));
  }
};

}  // namespace molten
