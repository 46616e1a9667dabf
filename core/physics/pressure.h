// Pressure: the equations of state and the symmetric force −Σ m_j (p_i/ρ_i² + p_j/ρ_j²) ∇W_ij ([P] 4-38, [D] 5.1).
#pragma once

#include <bit>
#include <cmath>

#include "core/fields.h"
#include "core/scene.h"
#include "core/simd.h"

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

/// (1 + x)^γ − 1 without cancellation. For whole γ by squares, q_2n = q_n (q_n + 2), and one more, q_{n+1} = q_n (1 +
/// x)
/// + x, whose terms have one sign each: the logarithm takes ten times as long. T: double or lanes of it.
template <class T> T power_less_one(const T& x, double gamma) {
  constexpr double largest_whole = 16;
  if (gamma >= 1 && gamma <= largest_whole && gamma == std::floor(gamma)) {
    const auto n = static_cast<unsigned>(gamma);
    T power = x;
    for (int bit = std::bit_width(n) - 2; bit >= 0; --bit) {
      power = power * (power + T(2.0));
      if (n >> bit & 1) power = power * (T(1.0) + x) + x;
    }
    return power;
  }
  return each_lane(x, [gamma](double x) { return std::expm1(gamma * std::log1p(x)); });
}

/// p(ρ) of a weakly compressible liquid; δ = ρ/ρ0 − 1 is what the particles carry.
struct EquationOfState {
  StateEquation kind = StateEquation::tait;
  double rest_density = 1000;  // ρ0, kg/m³
  double sound_speed = 1;      // c, m/s
  double gamma = 7;            // Tait only

  /// Pa. Linear: p = c²(ρ − ρ0) (Morris; [P]); ideal gas: p = k(ρ − ρ0) ([Q] 4.7), the same with c = √k; Tait: p =
  /// c²ρ0/γ ((ρ/ρ0)^γ − 1) ([D] 4.2).
  template <class T> T pressure(const T& compression) const {
    const double stiffness = sound_speed * sound_speed * rest_density;
    if (kind != StateEquation::tait) return T(stiffness) * compression;
    return T(stiffness / gamma) * power_less_one(compression, gamma);
  }
  /// p/ρ², Pa m⁶/kg²
  template <class T> T term(const T& compression) const {
    const T density = T(rest_density) * (T(1) + compression);
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
    if (kind != StateEquation::tait || gamma == 1) return std::expm1(part);
    return std::expm1(std::log1p((gamma - 1) * part) / (gamma - 1));
  }
  /// The φ at which a fluid at rest is compressed so, m²/s².
  double potential_at_rest(double compression) const {
    const double c2 = sound_speed * sound_speed;
    if (kind != StateEquation::tait || gamma == 1) return c2 * std::log1p(compression);
    return c2 * std::expm1((gamma - 1) * std::log1p(compression)) / (gamma - 1);
  }
};

}  // namespace molten
