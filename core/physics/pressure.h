// Pressure: the equations of state and the symmetric force −Σ m_j (p_i/ρ_i² + p_j/ρ_j²) ∇W_ij ([P] 4-38, [D] 5.1).
#pragma once

#include <cmath>

#include "core/fields.h"
#include "core/scene.h"

namespace molten {

struct PressureForce {
  using Reads = FieldList<PressureTerm>;
  using Sums = FieldList<Acceleration>;
  using Radial = FieldList<Acceleration>;
  static constexpr bool on = true;

  template <class Pair, class I, class J, class Out>
  [[gnu::always_inline]] void operator()(const Pair&, const I& i, const J& j, Out& out) const {
    out.along(acceleration, -i[pressure_term] - j[pressure_term]);
  }
};

/// p(ρ) of a weakly compressible liquid; δ = ρ/ρ0 − 1 is what the particles carry.
struct EquationOfState {
  StateEquation kind = StateEquation::tait;
  double rest_density = 1000;  // ρ0, kg/m³
  double sound_speed = 1;      // c, m/s
  double gamma = 7;            // Tait only

  /// Pa. Linear: p = c²(ρ − ρ0) (Morris; [P]); ideal gas: p = k(ρ − ρ0) ([Q] 4.7), the same with c = √k; Tait: p =
  /// c²ρ0/γ ((ρ/ρ0)^γ − 1) ([D] 4.2).
  double pressure(double compression) const {
    const double stiffness = sound_speed * sound_speed * rest_density;
    if (kind != StateEquation::tait) return stiffness * compression;
    return stiffness / gamma * std::expm1(gamma * std::log1p(compression));
  }
  /// p/ρ², Pa m⁶/kg²
  double term(double compression) const {
    const double density = rest_density * (1 + compression);
    return pressure(compression) / (density * density);
  }
  /// The compression at which p is this (Pa).
  double compression(double pressure) const {
    const double stiffness = sound_speed * sound_speed * rest_density;
    if (kind != StateEquation::tait) return pressure / stiffness;
    return std::expm1(std::log1p(gamma * pressure / stiffness) / gamma);
  }
  /// The compression of a fluid at rest: dp = ρ dφ, p = 0 where φ = 0; φ = gravity times depth, m²/s².
  double compression_at_rest(double potential) const {
    const double part = potential / (sound_speed * sound_speed);
    if (kind == StateEquation::linear || gamma == 1) return std::expm1(part);
    return std::expm1(std::log1p((gamma - 1) * part) / (gamma - 1));
  }
};

}  // namespace molten
