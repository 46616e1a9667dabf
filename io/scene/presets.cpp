#include "io/scene/presets.h"

namespace molten {
namespace {

/// Paiva 2007 ([P]), chapter 6: pressure linear in density, leap-frog (6.4.3), artificial viscosity near 1 (6-15), XSPH
/// that overwrites the velocity (6-16) and the time step of 6-17: 0.1 of h/(|v| + c), 0.1/8 of h² rho/eta.
/// Not stated there and chosen here: kernel and smoothing length (cubic spline, 1.3 spacings) and epsilon (0.5 of its
/// [0, 1]). [P] has no force and no conduction limit; ours stay.
Numerics paiva() {
  Numerics numerics;
  numerics.preset = "paiva";
  numerics.kernel = KernelKind::cubic_spline;
  numerics.smoothing_ratio = 1.3;
  numerics.integrator = IntegratorKind::leap_frog;
  numerics.state_equation = StateEquation::linear;
  numerics.artificial_viscosity = 1;
  numerics.xsph = Xsph{Xsph::Form::velocity, 0.5};
  numerics.courant_sound = 0.1;
  numerics.courant_viscous = 0.1 / 8;
  return numerics;
}

/// For flows that fill their space (periodic, channels, cavities): what gave the least error per run time on
/// Taylor-Green vortices (tests/physics/taylor_green_test.cpp).
Numerics internal() {
  Numerics numerics;
  numerics.preset = "internal";
  numerics.smoothing_ratio = 1.7;
  numerics.state_equation = StateEquation::linear;
  numerics.artificial_viscosity = 0;
  numerics.gradient_correction = true;
  numerics.shifting.emplace();
  numerics.courant_sound = 0.4;
  return numerics;
}

}  // namespace

std::optional<Numerics> find_preset(std::string_view name) {
  if (name == "molten") return Numerics{};
  if (name == "internal") return internal();
  if (name == "paiva") return paiva();
  return std::nullopt;
}

}  // namespace molten
