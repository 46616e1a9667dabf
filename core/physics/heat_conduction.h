// Heat conduction dT/dt = k ∇²T (Cleary & Monaghan; [P] 6-2): dT_i/dt = k Σ 4 m_j/(ρ_i + ρ_j) (T_i − T_j) W'/r, the
// form that conserves heat to round-off. [P] 6-9 lacks a factor 2: it gives half of ∇²T.
// Where conductivities differ, the flux between two particles is that through both their materials in series, each as
// thick as its particle is far from the interface, d (heat_interface.h): k = (d_i + d_j)/(d_i/k_i + d_j/k_j), which
// with an interface half-way is the harmonic mean (Cleary & Monaghan 1999). Density times heat capacity is the same
// everywhere.
// Corrected: times the mean of the particles' factors (gradient_correction.h), which conserves heat as well. So does
// the mean of those that make up for what insulating walls hide (insulation.h).
#pragma once

#include <type_traits>

#include "core/fields.h"
#include "core/physics/gradient_correction.h"
#include "core/physics/heat_interface.h"
#include "core/physics/insulation.h"
#include "core/simd.h"

namespace molten {

/// What a general conduction takes in, the same for the whole pass.
struct HeatSwitches {
  bool varied = false;     // conductivities differ
  bool completed = false;  // beside insulating walls
};

/// `general`: in a pass that also serves scenes with one of the switches on.
template <class Real, bool corrected = false, bool general = false> struct HeatConduction {
  using GeneralReads = typename UnionOf<InterfaceReads, FieldList<HeatCompletion>>::type;
  using Reads = typename UnionOf<FieldList<LocalTemperature, Compression>,
                                 std::conditional_t<corrected, FieldList<LaplacianCorrection>, FieldList<>>,
                                 std::conditional_t<general, GeneralReads, FieldList<>>>::type;
  using Sums = FieldList<TemperatureRate>;
  bool on = false;
  Real strength = 0;  // 4 k/ρ0, m⁵/(kg s)
  HeatSwitches has;

  HeatConduction(double diffusivity, double rest_density, HeatSwitches switches = {})
      : on(diffusivity > 0), strength(Real(4 * diffusivity / rest_density)), has(switches) {}

  template <class Pair, class I, class J, class Out>
  [[gnu::always_inline]] void operator()(const Pair&, const I& i, const J& j, Out& out) const {
    using L = std::decay_t<decltype(i[compression])>;
    L factor = L(strength) * reciprocal(L(2) + i[compression] + j[compression]);
    if constexpr (corrected) factor = factor * laplacian_correction_of(i, j);
    if constexpr (general) {
      if (has.varied) factor = factor * conductivity_between<Real>(i, j);
      if (has.completed) factor = factor * heat_completion_of(i, j);
    }
    out.gradW(temperature_rate, factor * (i[local_temperature] - j[local_temperature]));
  }
};

}  // namespace molten
