// Heat conduction dT/dt = k ∇²T (Cleary & Monaghan; [P] 6-2): dT_i/dt = k Σ 4 m_j/(ρ_i + ρ_j) (T_i − T_j) W'/r, the
// form that conserves heat to round-off. [P] 6-9 lacks a factor 2: it gives half of ∇²T.
#pragma once

#include <type_traits>

#include "core/fields.h"
#include "core/simd.h"

namespace molten {

template <class Real> struct HeatConduction {
  using Reads = FieldList<LocalTemperature, Compression>;
  using Sums = FieldList<TemperatureRate>;
  bool on = false;
  Real strength = 0;  // 4 k/ρ0, m⁵/(kg s)

  HeatConduction(double diffusivity, double rest_density)
      : on(diffusivity > 0), strength(Real(4 * diffusivity / rest_density)) {}

  template <class Pair, class I, class J, class Out>
  [[gnu::always_inline]] void operator()(const Pair&, const I& i, const J& j, Out& out) const {
    using L = std::decay_t<decltype(i[compression])>;
    const L twice_density = L(2) + i[compression] + j[compression];
    out.gradW(temperature_rate,
              L(strength) * (i[local_temperature] - j[local_temperature]) * reciprocal(twice_density));
  }
};

}  // namespace molten
