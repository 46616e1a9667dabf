// A standing wave on a basin of depth H = 1 (g = ρ = 1, wave length 2): nearly E_k ∝ (1 + cos 2ωt) e^{−4νk²t},
// ω² = gk tanh kH (Antuono et al. 2011); judged against linear theory with viscosity. It starts flat with the velocity
// of the potential φ = −(ε H g/2ω) cosh k(y + H)/cosh kH cos kx.
#include <cmath>

#include "bench/study/list.h"
#include "bench/study/metrics.h"
#include "bench/study/particles.h"
#include "bench/study/scene_text.h"
#include "bench/study/wave_fit.h"
#include "bench/study/wave_theory.h"

namespace molten::study {

namespace {

constexpr double wave_number = M_PI;

/// y from the bottom.
Triple velocity_at_start(const Triple& x, double amplitude, double omega) {
  const double a = amplitude / (2 * omega) * wave_number / std::cosh(wave_number);
  return {a * std::cosh(wave_number * x[1]) * std::sin(wave_number * x[0]),
          -a * std::sinh(wave_number * x[1]) * std::cos(wave_number * x[0]), 0};
}

void run(const Request& r, Report& report) {
  report.expect("frequency", 0.01);
  report.expect("decay_rate", 0.1);
  const double omega = std::sqrt(wave_number * std::tanh(wave_number)), viscosity = 1 / r["reynolds"];
  const double spacing = 1.0 / static_cast<double>(r.size);
  Setup s;
  s.scene = scene_head(2, {0, -1, 0}, periodic_text(2, {0, -1, 0}, {2, 3, 0}, "x")) +
            fluid_text(2, spacing, 1, newtonian_text(viscosity)) + "[numerics]\nviscosity_form = \"monaghan\"\n" +
            wall_support_text() +  // a free surface is without stress
            "[[boundary]]\nplane = { point = [0, 0], normal = [0, 1] }\nslip = 1\n";
  s.start = lattice(2, {}, {2, 1, 0}, spacing);
  set_velocity(s.start, [&](const Triple& x) { return velocity_at_start(x, r["amplitude"], omega); });
  for (const Triple& x : s.start.position) s.pressure.push_back(1 - x[1]);
  const auto simulation = Simulation::make(r, s, report);
  Series energy;
  const double every = M_PI / omega / 50;
  simulation->run_until(r["end_time"], every, [&](const Cloud& c) { energy.add(c.time, kinetic_energy(c)); });

  const double decay = 4 * viscosity * wave_number * wave_number;
  const Series theory = ViscousWave{wave_number, viscosity}.kinetic_energy(r["end_time"], every);
  const WaveFit fit = fit_wave(energy, omega, decay), exact = fit_wave(theory, omega, decay);
  report.judge("frequency", std::abs(fit.frequency / exact.frequency - 1));
  report.judge("decay_rate", std::abs(fit.decay / exact.decay - 1));
}

}  // namespace

Case standing_wave() {
  return {"standing-wave",
          "a standing wave in a basin of depth 1 and length 2 with g = 1; frequency and rate of decay of the kinetic "
          "energy, from fits to it and to that of linear theory with viscosity",
          "particles a depth",
          32,
          8,
          {{"reynolds", 250, "H √(gH)/ν"},
           {"amplitude", 0.1, "height of the wave from trough to crest over the depth"},
           {"end_time", 7.1, "two periods"}},
          run};
}

}  // namespace molten::study
