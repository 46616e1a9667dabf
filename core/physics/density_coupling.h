// The density of shifted particles, held to that of the places where they are. Continuity carries the density along
// with the velocity of the fluid and shifting moves the particles otherwise, so errors of the discrete divergence, most
// at walls, corners and surfaces, are sources of particles that no pressure resists: they stream off by shifting, and
// as much fluid streams back. In a cavity that is a part of the flow in proportion to the spacing. So
//   dρ_i/dt += κ U/h Σ V_j W_ij (C_j ρ0 − ρ_j),  C = (2 Σ V W + tr M)/(d + 2),
// U as in shifting.h, M the moment of gradient_correction.h; nothing towards a free surface.
//
// C is the density of the places over ρ0. Where particles lie in disorder Σ V W is too large and tr M/d is too small:
// displacements of variance σ² along each axis change Σ_{j≠i} V f(x_ij), for ∫∇²f dV = 0, by −σ² V ∇²f(0), which is
// −d σ² V W''(0) for W and 2 σ² V W''(0) for −r W'/d. In C the two cancel, as far as sums over neighbours are
// integrals: for displacements by up to 0.2 spacings and h of 1.7 a fifth of the change of Σ V W is left in 2-D, six
// tenths in 3-D. C is taken over that of a square lattice, in 2-D 1 within 0.2 % for h of 1.5 spacings and more.
#pragma once

#include <algorithm>

#include "core/fields.h"
#include "core/simd.h"

namespace molten {

/// Sums ρ0 Σ V_j W_ij, the particle itself and the solid behind walls among them.
struct Concentration {
  using Reads = FieldList<>;
  using Sums = FieldList<KernelSum>;
  static constexpr bool on = true;

  template <class Pair, class I, class J, class Out>
  [[gnu::always_inline]] void operator()(const Pair& ij, const I&, const J&, Out& out) const {
    out.W(kernel_sum, decltype(ij.r2)(1));
  }
  template <class Piece, class L, class Out> void behind_wall(const Piece& s, const L& density, Out& out) const {
    out.plain(kernel_sum, density * s.hidden);
  }
};

/// C; the sums are Σ V W and tr M.
template <int Dim> double concentration_of(double kernel_sum, double moment_trace) {
  return (2 * kernel_sum + moment_trace) / (Dim + 2);
}

/// What part of the coupling acts, by GradientCorrection::inner: none in the two rows at a surface, where C lacks the
/// missing half; all where particles merely lie in disorder, or those with too few neighbours would count less.
inline double coupling_share(double inner) { return std::clamp(2 * inner - 0.25, 0.0, 1.0); }

struct DensityCoupling {
  using Reads = FieldList<CouplingRate>;
  using Sums = FieldList<CompressionRate>;
  static constexpr bool at_walls = false;  // the fluid's alone
  bool on = false;

  template <class Pair, class I, class J, class Out>
  [[gnu::always_inline]] void operator()(const Pair&, const I&, const J& j, Out& out) const {
    out.W(compression_rate, j[coupling_rate]);
  }
};

}  // namespace molten
