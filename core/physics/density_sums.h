// Density from the particles' places instead of from its rate.
//   Summation: ρ_i = Σ m_j W_ij, the particle itself included ([Q] 4.2; [D] 4.5).
//   Shepard filter: ρ_i = Σ m_j W_ij / Σ V_j W_ij ([D] 5.4, 5.5).
//   MLS filter: ρ_i = Σ m_j (β0 + β·x_ij) W_ij, A (β0, β) = (1, 0), A = Σ V_j W_ij p pᵀ, p = (1, x_ij), which leaves
//   linear densities as they are ([D] 5.6-5.11); near-singular A: Shepard.
// With V_j = m_j/ρ_j both are weighted means of the densities, so they are taken of the compressions δ = ρ/ρ0 − 1.
#pragma once

#include <Eigen/Dense>

#include "core/fields.h"
#include "core/simd.h"

namespace molten {

/// Sums ρ.
struct DensitySum {
  using Reads = FieldList<>;
  using Sums = FieldList<KernelSum>;
  static constexpr bool on = true;

  template <class Pair, class I, class J, class Out>
  [[gnu::always_inline]] void operator()(const Pair& ij, const I&, const J&, Out& out) const {
    out.W(kernel_sum, decltype(ij.r2)(1));
  }
};

/// Sums ρ0 times: Σ V W and Σ V W δ; for MLS also the moments Σ V W x, Σ V W x xᵀ and Σ V W δ x.
struct DensityFilterSums {
  using Reads = FieldList<Compression>;
  using Sums = FieldList<KernelSum, KernelMean, KernelMoment, KernelMomentOfMean, KernelSpread>;
  static constexpr bool on = true;
  bool mls = false;

  template <class Pair, class I, class J, class Out>
  [[gnu::always_inline]] void operator()(const Pair& ij, const I&, const J& j, Out& out) const {
    using L = std::decay_t<decltype(ij.r2)>;
    const L delta = j[compression];
    add(ij, delta, reciprocal(L(1) + delta), out);
  }

  template <class Pair, class L, class Out>
  [[gnu::always_inline]] void add(const Pair& ij, const L& delta, const L& volume, Out& out) const {
    out.W(kernel_sum, volume);
    out.W(kernel_mean, volume * delta);
    if (!mls) return;
    out.W(kernel_moment, volume * ij.x);
    out.W(kernel_moment_of_mean, (volume * delta) * ij.x);
    out.W(kernel_spread, twice_symmetric((L(0.5) * volume) * ij.x, ij.x));
  }
};

/// The same over the fluid alone, where there are boundary particles.
struct FluidFilterSums {
  using Reads = FieldList<Compression, Held>;
  using Sums = DensityFilterSums::Sums;
  static constexpr bool on = true;
  bool mls = false;

  template <class Pair, class I, class J, class Out>
  [[gnu::always_inline]] void operator()(const Pair& ij, const I&, const J& j, Out& out) const {
    using L = std::decay_t<decltype(ij.r2)>;
    const L delta = j[compression], fluid = L(1) - min(L(j[held]), L(1));
    DensityFilterSums{mls}.add(ij, delta, fluid * reciprocal(L(1) + delta), out);
  }
};

/// The filtered compression of one particle; `length` (m) scales the moments.
template <int Dim, class Sums> double filtered_compression_of(const Sums& sums, bool mls, double length) {
  const double shepard = double(sums[kernel_mean]) / double(sums[kernel_sum]);
  if (!mls) return shepard;
  Eigen::Matrix<double, Dim + 1, Dim + 1> A;
  Eigen::Matrix<double, Dim + 1, 1> b;
  A(0, 0) = 1;
  b[0] = shepard;
  const double first = 1 / (length * sums[kernel_sum]), second = first / length;
  for (int a = 0; a < Dim; ++a) {
    A(0, a + 1) = A(a + 1, 0) = first * sums[kernel_moment][a];
    b[a + 1] = first * sums[kernel_moment_of_mean][a];
    for (int c = 0; c < Dim; ++c) A(a + 1, c + 1) = second * sums[kernel_spread](a, c);
  }
  constexpr double near_singular = 1e-3;  // of what an inner particle has, about 0.2 to the power of Dim
  if (!(A.determinant() > near_singular * std::pow(0.2, Dim))) return shepard;
  return A.ldlt().solve(Eigen::Matrix<double, Dim + 1, 1>::Unit(0)).dot(b);
}

}  // namespace molten
