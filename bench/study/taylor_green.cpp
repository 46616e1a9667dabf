// Taylor–Green vortices in a periodic box (L = U = ρ = 1): v = U e^{−8π²t/Re} (−cos 2πx sin 2πy, sin 2πx cos 2πy). The
// errors are those of PySPH's taylor_green.py, so that they compare with its.
#include <cmath>

#include "bench/study/list.h"
#include "bench/study/metrics.h"
#include "bench/study/particles.h"
#include "bench/study/scene_text.h"

namespace molten::study {

namespace {

Triple exact_velocity(const Triple& x, double decay) {
  const double kx = 2 * M_PI * x[0], ky = 2 * M_PI * x[1];
  return {-decay * std::cos(kx) * std::sin(ky), decay * std::sin(kx) * std::cos(ky), 0};
}

double exact_pressure(const Triple& x, double decay) {
  return -decay * decay * (std::cos(4 * M_PI * x[0]) + std::cos(4 * M_PI * x[1])) / 4;
}

double length(const Triple& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

Setup set_up(const Request& r) {
  const int dimensions = r["dimensions"] == 3 ? 3 : 2;
  const double spacing = 1.0 / static_cast<double>(r.size);
  const Triple size{1, 1, 8 * spacing};
  Setup s;
  s.scene = scene_head(dimensions, {}, periodic_text(dimensions, {}, size, dimensions == 3 ? "xyz" : "xy")) +
            fluid_text(dimensions, spacing, 1, newtonian_text(1 / r["reynolds"]));
  s.start = lattice(dimensions, {}, size, spacing);
  perturb(s.start, dimensions, r["perturbation"]);
  set_velocity(s.start, [](const Triple& x) { return exact_velocity(x, 1); });
  for (const Triple& x : s.start.position) s.pressure.push_back(exact_pressure(x, 1));
  return s;
}

void run(const Request& r, Report& report) {
  report.expect("speed_l1", 0.005);
  report.expect("max_speed", no_reach);
  report.expect("pressure_l1", no_reach);
  const auto simulation = Simulation::make(r, set_up(r), report);
  simulation->run_until(r["end_time"]);

  const Cloud c = simulation->cloud();
  const double decay = std::exp(-8 * M_PI * M_PI * c.time / r["reynolds"]);
  FieldError speed;
  double fastest = 0, mean_pressure = 0, pressure = 0;
  for (const double p : c.pressure) mean_pressure += p / static_cast<double>(c.count());
  for (std::size_t k = 0; k < c.count(); ++k) {
    speed.add(length(c.velocity[k]), length(exact_velocity(c.position[k], decay)));
    pressure += std::abs(c.pressure[k] - mean_pressure - exact_pressure(c.position[k], decay));
    fastest = std::max(fastest, length(c.velocity[k]));
  }
  report.judge("speed_l1", speed.l1());
  report.judge("max_speed", std::abs(fastest / decay - 1));
  report.judge("pressure_l1", pressure / static_cast<double>(c.count()) / (decay * decay / 2));
}

}  // namespace

Case taylor_green() {
  return {"taylor-green",
          "decaying vortices; L1 of the speed over its mean, largest speed, mean deviation of the pressure over its "
          "largest (as PySPH)",
          "particles a side",
          50,
          8,
          {{"reynolds", 100, "Re"},
           {"end_time", 2, "L/U"},
           {"perturbation", 0.2, "width of the random displacements at the start, spacings"},
           {"dimensions", 2, "2, or 3: a slab 8 particles deep"}},
          run};
}

}  // namespace molten::study
