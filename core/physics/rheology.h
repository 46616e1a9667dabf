// Dynamic viscosity η(D, T). SMD ([P] 6-1; de Souza Mendes & Dutra 2004), in units:
//   η = (1 − e^{−η0 D/τ0}) (τ0/D + K D^{n−1}),  γ̇1 = (τ0/K)^{1/n},  η0 = (J + 1) τ0/γ̇1,
// which is (τ0/γ̇1) η*(D/γ̇1) with [P]'s dimensionless η*(D) = (1 − e^{−(J+1)D})(D^{n−1} + 1/D).
// J(T) = (1−u) J_cold + u J_hot, u = clamp((T − T_min)/(T_max − T_min), 0, 1) ([P] 6-3; the clamp is ours).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "core/vec.h"

namespace molten {

/// Strain-rate magnitude √(½ tr D²): |du/dy| in simple shear ([P] 6-1 prints ½ (tr D)², which vanishes there).
template <int Dim, class T> T strain_magnitude(const SymTensor<Dim, T>& strain) {
  return std::sqrt(square_trace(strain) / 2);
}

/// [P]'s dimensionless viscosity; D ≥ 0.
inline double smd_viscosity(double strain, double jump_number, double flow_index) {
  if (strain <= 1e-30) return jump_number + 1;
  const double power =
      flow_index == 0.5 ? 1 / std::sqrt(strain) : std::pow(strain, flow_index - 1);  // [P]'s n is quick
  return -std::expm1(-(jump_number + 1) * strain) * (power + 1 / strain);
}

struct Smd {
  double flow_index = 0.5;    // n
  double strain_unit = 1;     // γ̇1, 1/s
  double viscosity_unit = 1;  // τ0/γ̇1, Pa s
  double jump_hot = 0, jump_cold = 0;
  double melting_low = 0, melting_high = 0;  // T_min, T_max; equal: no dependence on temperature

  Smd() = default;
  Smd(double n, double yield_stress, double consistency, std::array<double, 2> jump_hot_cold)
      : flow_index(n),
        strain_unit(std::pow(yield_stress / consistency, 1 / n)),
        viscosity_unit(yield_stress / strain_unit),
        jump_hot(jump_hot_cold[0]),
        jump_cold(jump_hot_cold[1]) {}

  double jump_number(double temperature) const {
    if (melting_high <= melting_low) return jump_cold;
    const double u = std::clamp((temperature - melting_low) / (melting_high - melting_low), 0.0, 1.0);
    return (1 - u) * jump_cold + u * jump_hot;
  }
  /// Pa s
  double viscosity(double strain, double temperature) const {
    return viscosity_unit * smd_viscosity(strain / strain_unit, jump_number(temperature), flow_index);
  }
};

}  // namespace molten
