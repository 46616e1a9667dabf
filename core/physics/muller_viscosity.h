// Viscous force of Müller et al. (2003; [Q] 4.5, its sign put right): dv_i/dt = (μ/ρ_i) Σ V_j (v_j − v_i) ∇²W_visc with
// the viscosity kernel, of which only ∇²W is used: 12 (1−q)/h³, 40 (1−q)/(π h⁴), 45 (1−q)/(π h⁵) in 1-D, 2-D, 3-D, q =
// r/h, h its support. It conserves momentum where densities are equal, and its ∇²W makes no Laplacian of the velocity
// in general.
#pragma once

#include <numbers>

#include "core/fields.h"
#include "core/simd.h"

namespace molten {

/// ∇²W at q = 0 of the viscosity kernel, times h^(d+2).
constexpr double viscosity_kernel_constant(int dim) {
  return dim == 1 ? 12 : dim == 2 ? 40 / std::numbers::pi : 45 / std::numbers::pi;
}

template <int Dim, class Real> struct MullerViscosity {
  using Reads = FieldList<Velocity, Compression>;
  using Sums = FieldList<Acceleration>;
  bool on = false;
  Real strength = 0, inverse_support = 0;  // μ m/ρ0² ∇²W(0), 1/s; 1/m

  MullerViscosity(double viscosity, double mass, double rest_density, double support)
      : on(viscosity > 0),
        strength(Real(viscosity * mass / (rest_density * rest_density) * viscosity_kernel_constant(Dim) /
                      std::pow(support, Dim + 2))),
        inverse_support(Real(1 / support)) {}

  template <class Pair, class I, class J, class Out>
  [[gnu::always_inline]] void operator()(const Pair& ij, const I& i, const J& j, Out& out) const {
    using L = std::decay_t<decltype(ij.r2)>;
    const L inside = max(affine_root(ij.r2, Real(1), -inverse_support), L(0));  // 1 − q
    const L laplacian = L(strength) * inside;
    const L inverse = reciprocal((L(1) + i[compression]) * (L(1) + j[compression]));
    out.plain(acceleration, (laplacian * inverse) * (j[velocity] - i[velocity]));
  }
};

}  // namespace molten
