// Generalised Newtonian stress ([P] 4-38, 4-45, 6-1): the rate of strain D = ∇v + (∇v)ᵀ with
// ∇v_i = Σ V_j (v_j − v_i) ⊗ ∇W_ij, and the force Σ m_j (S_i/ρ_i² + S_j/ρ_j²)·∇W_ij of the stress S = η D.
#pragma once

#include <limits>
#include <type_traits>

#include "core/fields.h"
#include "core/simd.h"

namespace molten {

/// Sums ρ0 D; the caller divides by ρ0.
struct StrainRateTerm {
  using Reads = FieldList<Velocity, Compression>;
  using Sums = FieldList<StrainRate>;
  static constexpr bool on = true;

  template <class Pair, class I, class J, class Out>
  [[gnu::always_inline]] void operator()(const Pair& ij, const I& i, const J& j, Out& out) const {
    using L = std::decay_t<decltype(i[compression])>;
    const L volume = reciprocal(L(1) + j[compression]);  // V_j ρ0/m
    out.gradW(strain_rate, twice_symmetric(volume * (j[velocity] - i[velocity]), ij.x));
  }
};

/// The same with L_i ∇W and volumes at rest (gradient_correction.h).
struct CorrectedStrainRateTerm {
  using Reads = FieldList<Velocity, Correction>;
  using Sums = FieldList<StrainRate>;
  static constexpr bool on = true;

  template <class Pair, class I, class J, class Out>
  [[gnu::always_inline]] void operator()(const Pair& ij, const I& i, const J& j, Out& out) const {
    out.gradW(strain_rate, twice_symmetric(j[velocity] - i[velocity], i[correction] * ij.x));
  }
};

/// Stress / density², from the viscosity (Pa s), the density (kg/m³) and the rate of strain.
template <int Dim, class Real>
SymTensor<Dim, Real> stress_term(Real viscosity, Real density, const SymTensor<Dim, Real>& strain) {
  return (viscosity / (density * density)) * strain;
}

/// The sum of stresses alone does not feel velocities that alternate from particle to particle: their rate of strain is
/// zero. So what a pair's approach has beyond the particles' own rates of strain, v_ij·x − ¼ x·(D_i + D_j)·x, of third
/// order in r where the velocity is smooth, is damped with the harmonic mean viscosity η̄ and m₂ = ∫ W r² dV:
///   + Σ m_j (2d/m₂) η̄ (v_ij·x − ¼ x·(D_i + D_j)·x)/(ρ_i ρ_j) ∇W_ij,
/// which is Monaghan's form with 2(d + 2)/r² as a constant of the same Laplacian. By 1/r² close neighbours would count
/// most: what alternates along one axis would be damped 1.5 times as fast, where particles have paired 2.2 times, and
/// would bind the step; what is damped the least, across the axis, differs by 5 %. Both parts conserve momentum, linear
/// and angular.
template <int Dim, class Real> struct StressForce {
  using Reads = FieldList<Stress, Viscosity, Velocity, Compression>;
  using Sums = FieldList<Acceleration>;
  using Radial = FieldList<Acceleration>;
  bool on = false;
  Real density2 = 0;  // ρ0², kg²/m⁶
  Real damping = 0;   // 2d/m₂, 1/m²

  StressForce(bool present, double rest_density, double second_moment)
      : on(present), density2(Real(rest_density * rest_density)), damping(Real(2 * Dim / second_moment)) {}

  template <class Pair, class I, class J, class Out>
  [[gnu::always_inline]] void operator()(const Pair& ij, const I& i, const J& j, Out& out) const {
    using L = decltype(ij.r2);
    const Vec<Dim, L> force_i = i[stress] * ij.x, force_j = j[stress] * ij.x;  // η D·x/ρ² of each
    out.gradW(acceleration, force_i + force_j);
    const L eta_i = i[viscosity], eta_j = j[viscosity];
    const L rho_i = L(1) + i[compression], rho_j = L(1) + j[compression];  // over ρ0
    // With η̄ = 2 η_i η_j/(η_i + η_j), and D = ρ² (stress)/η, the viscosities that D is divided by cancel.
    const L strain = eta_j * rho_i * rho_i * dot(ij.x, force_i) + eta_i * rho_j * rho_j * dot(ij.x, force_j);
    const L beyond = L(2) * eta_i * eta_j * dot(i[velocity] - j[velocity], ij.x) - L(Real(0.5)) * L(density2) * strain;
    const L tiny(std::numeric_limits<Real>::min() * Real(1e8));  // of padding, whose viscosity may be 0
    const L scale = L(density2) * (eta_i + eta_j) * rho_i * rho_j;
    out.along(acceleration, L(damping) * beyond * reciprocal(max(scale, tiny)));
  }
};

}  // namespace molten
