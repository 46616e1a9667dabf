// Dynamic viscosity η(D, T) of the common generalised Newtonian fluids, times a factor f(T).
//   Newtonian: η. Power law (Ostwald-de Waele): K D^{n−1}.
//   Bingham (n = 1) and Herschel-Bulkley, regularised by Papanastasiou (1987): K D^{n−1} + τ0 (1 − e^{−mD})/D.
//   Cross (1965): η∞ + (η0 − η∞)/(1 + (λD)^{1−n}). Carreau (1972): η∞ + (η0 − η∞)(1 + (λD)²)^{(n−1)/2}.
//   Arrhenius: f = exp(E (1/T − 1/T_r)). Vogel-Fulcher-Tammann: f = 10^{A + B/(T − C)}.
// η is cut at `largest`, which bounds the time step where D^{n−1} or f grows without limit.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/scene.h"

namespace molten {

/// f(T); T absolute for Arrhenius, in the scene's unit for VFT, which sets at T ≤ C: ∞.
inline double thermal_factor(const ThermalViscosity& t, double temperature) {
  if (t.kind == ThermalViscosity::Kind::arrhenius)
    return std::exp(t.activation_temperature * (1 / temperature - 1 / t.reference_temperature));
  return temperature > t.c ? std::pow(10, t.a + t.b / (temperature - t.c)) : HUGE_VAL;
}

/// Pa s, without the factor and the cut.
inline double flow_curve_viscosity(const Rheology& r, double strain) {
  using Model = Rheology::Model;
  const double tiny = 1e-30, rate = std::max(strain, tiny);
  const auto power = [&] { return r.consistency * std::pow(rate, r.flow_index - 1); };  // dear: where it is asked for
  switch (r.model) {
    case Model::power_law:
      return power();
    case Model::bingham:
      return r.viscosity - r.yield_stress * std::expm1(-r.regularisation * rate) / rate;
    case Model::herschel_bulkley:
      return power() - r.yield_stress * std::expm1(-r.regularisation * rate) / rate;
    case Model::cross:
      return r.fast_viscosity +
             (r.viscosity - r.fast_viscosity) / (1 + std::pow(r.relaxation_time * rate, 1 - r.flow_index));
    case Model::carreau:
      return r.fast_viscosity + (r.viscosity - r.fast_viscosity) *
                                    std::pow(1 + std::pow(r.relaxation_time * rate, 2), (r.flow_index - 1) / 2);
    default:
      return r.viscosity;
  }
}

/// Pa s
inline double viscosity_of(const Rheology& r, double strain, double temperature) {
  const double factor = r.thermal ? thermal_factor(*r.thermal, temperature) : 1;
  return std::min(r.largest_viscosity, factor * flow_curve_viscosity(r, strain));
}

}  // namespace molten
