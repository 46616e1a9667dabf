// Heat conduction dT/dt = k ∇²T (Cleary & Monaghan; [P] 6-2): dT_i/dt = k Σ 4 m_j/(ρ_i + ρ_j) (T_i − T_j) W'/r, the
// form that conserves heat to round-off. [P] 6-9 lacks a factor 2: it gives half of ∇²T.
// Corrected: times the mean of the particles' factors (gradient_correction.h), which conserves heat as well.
#pragma once

#include <type_traits>

#include "core/fields.h"
#include "core/physics/gradient_correction.h"
#include "core/simd.h"

namespace molten {

template <class Real, bool corrected = false> struct HeatConduction {
  using Reads = std::conditional_t<corrected, FieldList<LocalTemperature, Compression, LaplacianCorrection>,
                                   FieldList<LocalTemperature, Compression>>;
  using Sums = FieldList<TemperatureRate>;
  bool on = false;
  Real strength = 0;  // 4 k/ρ0, m⁵/(kg s)

  HeatConduction(double diffusivity, double rest_density)
      : on(diffusivity > 0), strength(Real(4 * diffusivity / rest_density)) {}

  template <class Pair, class I, class J, class Out>
  [[gnu::always_inline]] void operator()(const Pair&, const I& i, const J& j, Out& out) const {
    using L = std::decay_t<decltype(i[compression])>;
    L factor = L(strength) * reciprocal(L(2) + i[compression] + j[compression]);
    if constexpr (corrected) factor = factor * laplacian_correction_of(i, j);
    out.gradW(temperature_rate, factor * (i[local_temperature] - j[local_temperature]));
  }
};

}  // namespace molten
