// Linear theory of a standing wave on a viscous fluid, its boundary layers included, against which waves at moderate
// Reynolds numbers have to be judged: the decay 4νk² of the energy and ω² = gk tanh kH are its limit without viscosity,
// 11 % and 0.5 % off at H √(gH)/ν = 250.
#pragma once

#include "bench/study/metrics.h"

namespace molten::study {

/// Wave number k (1/m) and kinematic viscosity (m²/s) of a wave on a depth of 1 m with g = 1 m/s² over a free-slip
/// bottom.
struct ViscousWave {
  double wave_number = 0, viscosity = 0;

  /// Kinetic energy, in units of its own, from a flat surface with the velocity of the potential flow on, at every
  /// `every` s until `end` (s).
  Series kinetic_energy(double end, double every) const;
};

}  // namespace molten::study
