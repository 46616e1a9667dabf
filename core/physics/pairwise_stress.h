// Generalised Newtonian stress between the particles of a pair, for corrected gradients: the force
//   Σ m_j 2 η_ij λ_ij (v_ij + ∇vᵀ_ij x_ij)/(ρ_i ρ_j) W'/r
// of the traction half-way, η_ij (∇v + ∇vᵀ) x_ij/r with the pair's own difference for the slope along x_ij; ∇v_ij is
// the mean of the particles' velocity gradients, λ the factor that makes Laplacians whole (gradient_correction.h). A
// rigid rotation has no traction, whatever the viscosities, and for a constant viscosity it is Morris' form (1997).
//
// η_ij belongs to the rate of strain half-way, of which the mean of the particles' knows less than the pair: that mean
// is scaled by the part of what it lets the pair differ by that the pair does differ by. In plane shear flow this is
// the pair's own slope, however the pair lies. The viscosity there is of the flow curve between the particles' places
// on it, so interpolated that the stress has its values and slopes at both, is exact for a parabola and hugs the knee
// of a fluid that yields (Delbourgo & Gregory 1985), and beyond them of the power law that touches the curve at the
// nearer,
//   η(D) = η_k (D/D_k)^−n_k, n_k = −d ln η/d ln D at the particle,
// as the ratio of first order in D² that has its value and its slope at D_k; D from half to twice D_k. Where
// viscosities depend on temperatures the particles have curves of their own: the harmonic mean of what either's fluid
// would have by its power law, which keeps stresses whole where the viscosity jumps. A sum of the particles' stresses
// ([P] 4-38; viscous_stress.h) takes its rates of strain over the support, which flattens the profile where a fluid
// yields; and what damps its shortest waves adds to the viscosity. But in a shear flow u(y) with the flow curve τ =
// f(u') its error of second order, m4 (τ''' + (f' u''')')/6 with m4 = Σ V y⁴ W'/r, is four times that of the pairs'
// tractions: four thirds of these less a third of that have none. At a free surface, where the particles' rates of
// strain lack half of the neighbours, the tractions alone remain.
#pragma once

#include <limits>
#include <type_traits>

#include "core/fields.h"
#include "core/physics/gradient_correction.h"
#include "core/simd.h"

namespace molten {

/// Sums ρ0 D and ρ0 ∇ × v with L_i ∇W and volumes at rest.
struct CorrectedVelocityGradient {
  using Reads = FieldList<Velocity, Correction>;
  using Sums = FieldList<StrainRate, Vorticity>;
  static constexpr bool on = true;

  template <class Pair, class I, class J, class Out>
  [[gnu::always_inline]] void operator()(const Pair& ij, const I& i, const J& j, Out& out) const {
    const auto difference = j[velocity] - i[velocity];
    const auto slope = i[correction] * ij.x;
    out.gradW(strain_rate, twice_symmetric(difference, slope));
    out.gradW(vorticity, curl_of(difference, slope));
  }
};

template <int Dim, class Real> struct PairwiseStress {
  using Reads =
      FieldList<Velocity, Compression, LaplacianCorrection, Inner, StrainRate, Vorticity, Viscosity, Thinning>;
  using Sums = FieldList<Acceleration>;
  bool on = false;
  bool one_curve = true;  // nothing depends on temperatures
  Real strength = 0;      // 1/ρ0², m⁶/kg²

  PairwiseStress(bool present, bool one_flow_curve, double rest_density)
      : on(present), one_curve(one_flow_curve), strength(Real(1 / (rest_density * rest_density))) {}

  template <class Pair, class I, class J, class Out>
  [[gnu::always_inline]] void operator()(const Pair& ij, const I& i, const J& j, Out& out) const {
    using L = std::decay_t<decltype(ij.r2)>;
    add(ij, i, j, L(Real(1.0 / 3)) * min(i[inner], j[inner]), out);
  }

  /// The stress in the fluid at a wall is not known but by the pair.
  template <class Pair, class I, class J, class Out>
  [[gnu::always_inline]] void before_wall(const Pair& ij, const I& i, const J& j, Out& out) const {
    add(ij, i, j, std::decay_t<decltype(ij.r2)>(Real(0)), out);
  }

 private:
  static constexpr Real tiny = std::numeric_limits<Real>::min() * Real(1e8);  // of padding

  /// `beyond`: by how much more the pair's traction counts than that of the particles' stresses.
  template <class Pair, class I, class J, class L, class Out>
  [[gnu::always_inline]] void add(const Pair& ij, const I& i, const J& j, const L& beyond, Out& out) const {
    const L half(Real(0.5));
    const SymTensor<Dim, L> strain = half * (i[strain_rate] + j[strain_rate]);
    const Vec<Dim, L> stretched = half * (strain * ij.x);  // with `turned` ∇v x
    const Vec<Dim, L> turned = half * turned_by(half * (i[vorticity] + j[vorticity]), ij.x);
    const Vec<Dim, L> difference = i[velocity] - j[velocity];
    const L mean_square = half * square_trace(strain);
    const L scale = scale_of(difference, stretched + turned, mean_square * ij.r2);
    const L square = mean_square * scale * scale;
    const L eta = one_curve ? between(i, j, square) : harmonic_mean(i, j, square);
    const Vec<Dim, L> pairs = eta * (difference + stretched - turned);
    const Vec<Dim, L> summed = half * (i[viscosity] * (i[strain_rate] * ij.x) + j[viscosity] * (j[strain_rate] * ij.x));
    const L densities = (L(1) + i[compression]) * (L(1) + j[compression]);  // over ρ0²
    const L factor = L(Real(2) * strength) * laplacian_correction_of(i, j) * reciprocal(densities);
    out.gradW(acceleration, factor * (pairs + beyond * (pairs - summed)));
  }

  /// What a pair differs by over what is expected of it, from 0 to 2; towards 1 where that is little beside `most`, the
  /// square of what a pair may differ by, as for pairs along the flow.
  template <class L>
  [[gnu::always_inline]] static L scale_of(const Vec<Dim, L>& difference, const Vec<Dim, L>& expected, const L& most) {
    const Vec<Dim, L> rest = difference - expected;
    const L bound = dot(expected, expected) + L(Real(0.25)) * dot(rest, rest) + L(Real(0.01)) * most;
    return L(1) + dot(rest, expected) * reciprocal(bound + L(tiny));
  }

  /// Viscosity at a rate of strain, given by the square of its magnitude, of the flow curve that both particles are on.
  template <class I, class J, class L>
  [[gnu::always_inline]] static L between(const I& i, const J& j, const L& square) {
    const L at_i = root(half_trace(i)), at_j = root(half_trace(j));
    const auto lower = [&](const L& of_i, const L& of_j) { return select_less(at_i, at_j, of_i, of_j); };
    const L low = min(at_i, at_j), high = max(at_i, at_j), strain = root(square);
    const L eta_low = lower(i[viscosity], j[viscosity]), eta_high = lower(j[viscosity], i[viscosity]);
    const L thins_low = lower(i[thinning], j[thinning]), thins_high = lower(j[thinning], i[thinning]);
    const L width = high - low, within = min(max(strain, low), high);
    const L part = (within - low) * reciprocal(width + L(tiny));
    const L stress = eta_low * low, rise = eta_high * high - stress;
    // How far the tangents at both ends are above the chord.
    const L first = part * (slope(eta_low, thins_low) * width - rise);
    const L second = (L(1) - part) * (rise - slope(eta_high, thins_high) * width);
    const L both = first * second, arch = select_less(L(0), both, both * reciprocal(first + second), L(0));
    const L eta = (stress + part * rise + arch) * reciprocal(within);
    return eta * power_law(within * within, square, select_less(strain, low, thins_low, thins_high));
  }

  template <class I, class J, class L>
  [[gnu::always_inline]] static L harmonic_mean(const I& i, const J& j, const L& square) {
    const L eta_i = i[viscosity] * power_law(half_trace(i), square, L(i[thinning]));
    const L eta_j = j[viscosity] * power_law(half_trace(j), square, L(j[thinning]));
    return L(Real(2)) * eta_i * eta_j * reciprocal(max(eta_i + eta_j, L(tiny)));
  }

  /// D², above 0.
  template <class K> [[gnu::always_inline]] static auto half_trace(const K& k) {
    const auto trace = square_trace(k[strain_rate]);
    using L = std::decay_t<decltype(trace)>;
    return L(L(Real(0.5)) * trace + L(tiny));
  }
  template <class L> [[gnu::always_inline]] static L root(const L& square) {
    return affine_root(max(square, L(tiny)), Real(0), Real(1));
  }
  /// dτ/dD
  template <class L> [[gnu::always_inline]] static L slope(const L& eta, const L& thins) {
    return eta * (L(1) - L(Real(2)) * thins);
  }
  /// Viscosity over that at another rate of strain, by the squares of both.
  template <class L> [[gnu::always_inline]] static L power_law(const L& own, const L& square, const L& thins) {
    const L there = min(max(square, L(Real(0.25)) * own), L(Real(4)) * own);
    const L sum = own + there, difference = thins * (own - there);
    return (sum + difference) * reciprocal(sum - difference);
  }
};

}  // namespace molten
