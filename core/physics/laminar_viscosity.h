// Constant viscosity of a Newtonian fluid, in one pass without a tensor; corrected: times the mean of the particles'
// factors (gradient_correction.h).
//   Morris (1997): Σ m_j (η_i + η_j)/(ρ_i ρ_j) (W'/r) v_ij, which dissipates η ∇v:∇v.
//   Monaghan and Gingold (1983): Σ m_j (d + 2)(η_i + η_j)/(ρ_i ρ_j) (v_ij·x_ij/r²) ∇W_ij, which dissipates ½ η D:D, as
// a fluid does, and so conserves angular momentum and leaves a free surface without stress: with Morris' form a gravity
// wave decays half as fast as it should (Colagrossi et al. 2011).
#pragma once

#include <limits>
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

template <int Dim, class Real, bool corrected = false> struct MonaghanViscosity {
  using Morris = LaminarViscosity<Real, corrected>;
  using Reads = typename Morris::Reads;
  using Sums = FieldList<Acceleration>;
  using Radial = FieldList<Acceleration>;
  bool on = false;
  Morris morris;

  MonaghanViscosity(double viscosity, double rest_density) : on(viscosity > 0), morris(viscosity, rest_density) {}

  template <class Pair, class I, class J, class Out>
  [[gnu::always_inline]] void operator()(const Pair& ij, const I& i, const J& j, Out& out) const {
    using L = decltype(ij.r2);
    const L rho_i = L(1) + i[compression], rho_j = L(1) + j[compression];  // over ρ0
    const L tiny(std::numeric_limits<Real>::min() * Real(1e8));            // a particle with itself: r = 0
    L factor = L(Real(Dim + 2) * morris.strength) * reciprocal(max(rho_i * rho_j * ij.r2, tiny));
    if constexpr (corrected) factor = factor * laplacian_correction_of(i, j);
    out.along(acceleration, factor * dot(i[velocity] - j[velocity], ij.x));
  }

  /// The neighbour that stands for a wall is straight ahead, where this form feels no shear: Morris' form does.
  template <class Pair, class I, class J, class Out>
  [[gnu::always_inline]] void before_wall(const Pair& ij, const I& i, const J& j, Out& out) const {
    morris(ij, i, j, out);
  }
};

}  // namespace molten
