// Generalised Newtonian stress between the particles of a pair, for corrected gradients: the force
//   Σ m_j 2 η_ij λ_ij (v_ij + ∇vᵀ_ij x_ij)/(ρ_i ρ_j) W'/r
// of the traction half-way, η_ij (∇v + ∇vᵀ) x_ij/r with the pair's own difference for the slope along x_ij; ∇v_ij is
// the mean of the particles' velocity gradients, λ the factor that makes Laplacians whole (gradient_correction.h). A
// rigid rotation has no traction, whatever the viscosities, and for a constant viscosity it is Morris' form (1997).
//
// η_ij belongs to the rate of strain half-way, of which the mean of the particles' knows less than the pair: in that
// mean the slope along x_ij gives way to the pair's difference, as at the faces of finite volumes. The viscosity there
// is the harmonic mean, which keeps stresses whole where the viscosity jumps, of what either particle's fluid would
// have: by the power law that touches its flow curve,
//   η(D) = η_k (D/D_k)^−n_k, n_k = −d ln η/d ln D at the particle,
// as the ratio of first order in D² that has its value and its slope at D_k; D from half to twice D_k.
// A sum of the particles' stresses ([P] 4-38; viscous_stress.h) takes its rates of strain over the support, which
// flattens the profile where a fluid yields; and what damps its shortest waves adds to the viscosity.
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
  using Reads = FieldList<Velocity, Compression, LaplacianCorrection, StrainRate, Vorticity, Viscosity, Thinning>;
  using Sums = FieldList<Acceleration>;
  bool on = false;
  Real strength = 0;  // 1/ρ0², m⁶/kg²

  PairwiseStress(bool present, double rest_density) : on(present), strength(Real(1 / (rest_density * rest_density))) {}

  template <class Pair, class I, class J, class Out>
  [[gnu::always_inline]] void operator()(const Pair& ij, const I& i, const J& j, Out& out) const {
    using L = std::decay_t<decltype(ij.r2)>;
    const L half(Real(0.5));
    const SymTensor<Dim, L> strain = half * (i[strain_rate] + j[strain_rate]);
    const Vec<Dim, L> stretched = strain * ij.x;  // (∇v + ∇vᵀ) x
    const Vec<Dim, L> turned = turned_by(half * (i[vorticity] + j[vorticity]), ij.x);
    const Vec<Dim, L> difference = i[velocity] - j[velocity];
    const Vec<Dim, L> beyond = difference - half * (stretched + turned);  // what the pair knows better
    const L inverse_r2 = reciprocal(ij.r2), along = dot(beyond, ij.x) * inverse_r2;
    const L square = half * square_trace(strain) +
                     inverse_r2 * (L(Real(2)) * dot(beyond, stretched) + dot(beyond, beyond)) + along * along;
    const L eta_i = viscosity_at(i, square), eta_j = viscosity_at(j, square);
    const L densities = (L(1) + i[compression]) * (L(1) + j[compression]);  // over ρ0²
    const L below = max((eta_i + eta_j) * densities, L(tiny));
    const L factor = L(Real(4) * strength) * eta_i * eta_j * laplacian_correction_of(i, j) * reciprocal(below);
    out.gradW(acceleration, factor * (difference + half * (stretched - turned)));
  }

 private:
  static constexpr Real tiny = std::numeric_limits<Real>::min() * Real(1e8);  // of padding

  /// Of a particle's fluid at another rate of strain, given by the square of its magnitude.
  template <class K, class L> [[gnu::always_inline]] static L viscosity_at(const K& k, const L& square) {
    const L own = L(Real(0.5)) * square_trace(k[strain_rate]) + L(tiny);
    const L there = min(max(square, L(Real(0.25)) * own), L(Real(4)) * own);
    const L sum = own + there, difference = k[thinning] * (own - there);
    return k[viscosity] * (sum + difference) * reciprocal(sum - difference);
  }
};

}  // namespace molten
