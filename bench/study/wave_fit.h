// A damped oscillation's frequency and decay rate from its kinetic energy.
#pragma once

#include "bench/study/metrics.h"

namespace molten::study {

struct WaveFit {
  double frequency = 0;  // ω, rad/s
  double decay = 0;      // of the energy, 1/s
};

/// Least squares of E (1 + cos(2ωt + φ)) e^{−βt} by Gauss and Newton, from a guess.
WaveFit fit_wave(const Series& energy, double frequency, double decay);

}  // namespace molten::study
