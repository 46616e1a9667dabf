// XSPH (Monaghan; [P] 6-16): Σ (m_j/ρ̄_ij)(v_j − v_i) W_ij, which the integrator adds, times ε, to the velocity ([P],
// [Q]) or to the rate of the position alone ([D]). The mean density makes it conserve momentum; [Q] has ρ_j instead.
#pragma once

#include <type_traits>

#include "core/fields.h"
#include "core/simd.h"

namespace molten {

template <class Real> struct XsphTerm {
  using Reads = FieldList<Velocity, Compression>;
  using Sums = FieldList<XsphVelocity>;
  bool on = false;
  Real strength = 0;  // 2/ρ0, m³/kg
  bool neighbour_density = false;

  XsphTerm(bool on_, double rest_density, bool neighbour_density_ = false)
      : on(on_), strength(Real(2 / rest_density)), neighbour_density(neighbour_density_) {}

  template <class Pair, class I, class J, class Out>
  [[gnu::always_inline]] void operator()(const Pair&, const I& i, const J& j, Out& out) const {
    using L = std::decay_t<decltype(i[compression])>;
    const L delta_j = j[compression];
    const L twice_density = L(2) + delta_j + (neighbour_density ? delta_j : i[compression]);
    out.W(xsph_velocity, (L(strength) * reciprocal(twice_density)) * (j[velocity] - i[velocity]));
  }
};

}  // namespace molten
