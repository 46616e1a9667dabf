// The energy-bounded two-step Euler method of [Q] (3.51-3.53, put right): u = v + Δt g, v' = u + α Δt a, x' = x + Δt
// v', with a the acceleration by pressure and viscosity. α is the largest share of it for which the particle's energy
// −g·x' + ½|v'|² does not exceed −g·x + ½|v|² + s: A α² + B α + C ≤ 0 with A = ½ Δt²|a|², B = Δt a·v,
// C = −½ Δt²|g|² − s; what particles leave of their bounds is the surplus m s that those after them may take.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/state.h"

namespace molten {

/// The largest α in [0, 1] with A α² + B α + C ≤ 0, for A ≥ 0 and C ≤ 0. ([Q] takes the root nearest 1, which may be
/// the negative one.)
inline double largest_share(double A, double B, double C) {
  if (A + B + C <= 0) return 1;
  const double root = std::sqrt(std::max(B * B - 4 * A * C, 0.0));
  const double share = B <= 0 ? (-B + root) / (2 * A) : -2 * C / (B + root);
  return std::clamp(share, 0.0, 1.0);
}

/// One step; walls as ever. Fills energy_share.
template <int Dim, class Real> void integrate_energy_bounded(State<Dim, Real>& s);

}  // namespace molten
