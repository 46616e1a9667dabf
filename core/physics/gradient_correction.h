// Kernel-gradient correction (Bonet & Lok 1999; [D] 5.12-5.18): ∇̃W = L_i ∇W with L_i = M_i⁻¹,
// M_i = Σ V_j ∇W_ij ⊗ (x_j − x_i), makes gradients Σ V_j (f_j − f_i) ∇̃W exact for linear fields. It fades to the
// identity at free surfaces: there the plain divergence is the one that goes with the plain pressure force (Colagrossi,
// Antuono & Le Touzé 2009), and a corrected one feeds energy into spray until it blows up. And for Laplacians of the
// form Σ V_j (f_i − f_j) W'/r: their factor is tr M_i / d, which the mean of both particles' d / tr M divides out
// without giving up the conservation of what is exchanged. Volumes are those at rest, m/ρ0: they cancel.
#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "core/fields.h"
#include "core/simd.h"

namespace molten {

/// Sums −ρ0 M.
struct GradientMoment {
  using Reads = FieldList<>;
  using Sums = FieldList<Moment>;
  static constexpr bool on = true;

  template <class Pair, class I, class J, class Out>
  [[gnu::always_inline]] void operator()(const Pair& ij, const I&, const J&, Out& out) const {
    using L = std::decay_t<decltype(ij.r2)>;
    out.gradW(moment, twice_symmetric(L(0.5) * ij.x, ij.x));
  }

  /// Over the solid behind a piece s of a wall, ∫ ∇W ⊗ (x' − x) dV = h_s 1 − ∫_s n ⊗ W (x' − x) dS by Gauss's theorem;
  /// over all pieces the sum is symmetric.
  template <class Piece, class L, class Out> void behind_wall(const Piece& s, const L& density, Out& out) const {
    auto sum = density * s.moment;
    for (int d = 0; d < static_cast<int>(s.normal.c.size()); ++d) sum(d, d) -= density * s.hidden;
    out.plain(moment, sum);
  }
};

/// What follows from the moment M of one particle.
template <int Dim> struct GradientCorrection {
  SymTensor<Dim, double> inverse;  // L
  double corrected = 0;            // how much of it: 1, at a free surface 0
  double laplacian = 1;            // d / tr M; towards a free surface, whose missing half is no lattice's flaw, 1
  double inner = 0;                // 1: deep in the fluid; 0: at its surface
  double least = 0;                // eigenvalue of M

  explicit GradientCorrection(const SymTensor<Dim, double>& moment) {
    Eigen::Matrix<double, Dim, Dim> m;
    for (int a = 0; a < Dim; ++a)
      for (int b = 0; b < Dim; ++b) m(a, b) = moment(a, b);
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, Dim, Dim>> solver;
    solver.computeDirect(m);
    least = solver.eigenvalues()[0];
    // Row by row below a plane surface the least eigenvalue is 0.5, 0.7 to 0.92, 0.94 or more (Wendland, h = 2 to 1.3
    // spacings), at an edge about 0.3.
    inner = std::clamp((least - 0.75) / 0.2, 0.0, 1.0);
    laplacian = 1 + inner * (Dim / std::max(m.trace(), 0.5) - 1);
    // Jittered insides come down to 0.8 or so: they stay whole.
    corrected = std::clamp((least - 0.6) / 0.2, 0.0, 1.0);
    if (corrected == 0) m.setIdentity();
    const Eigen::Matrix<double, Dim, Dim> l = m.inverse();
    for (int a = 0; a < Dim; ++a)
      for (int b = a; b < Dim; ++b) inverse(a, b) = (a == b) + corrected * (l(a, b) - (a == b));
  }
};

/// (d / tr M_i + d / tr M_j)/2
template <class I, class J> [[gnu::always_inline]] inline auto laplacian_correction_of(const I& i, const J& j) {
  using L = std::decay_t<decltype(i[laplacian_correction])>;
  return L(0.5) * (i[laplacian_correction] + j[laplacian_correction]);
}

}  // namespace molten
