// Conduction in a fluid at rest: a Gaussian hot spot, T = (s²/(s² + 4kt))^{d/2} e^{−r²/(s² + 4kt)}, and two slabs in
// contact (slab_theory.h).
#include <cmath>

#include "bench/study/list.h"
#include "bench/study/metrics.h"
#include "bench/study/particles.h"
#include "bench/study/scene_text.h"
#include "bench/study/slab_theory.h"

namespace molten::study {

namespace {

constexpr std::string_view heat_text = "[fluid.heat]\ndiffusivity = 1\ninitial = 0\n";
constexpr double slow_sound = 0.1;  // m/s: conduction alone bounds the step

// ---- hot spot -------------------------------------------------------------------------------------------------------

constexpr double spot_size = 0.1;  // s

double spot(const Triple& x, int dimensions, double time) {
  double r2 = 0;
  for (int d = 0; d < dimensions; ++d) r2 += (x[d] - 0.5) * (x[d] - 0.5);
  const double s2 = spot_size * spot_size, wide = s2 + 4 * time;
  return std::pow(s2 / wide, dimensions / 2.0) * std::exp(-r2 / wide);
}

void run_hot_spot(const Request& r, Report& report) {
  report.expect("temperature_l2", 0.005);
  const int dimensions = r["dimensions"] == 3 ? 3 : 2;
  const double spacing = 1.0 / static_cast<double>(r.size);
  Setup s;
  s.scene = scene_head(dimensions, {}, periodic_text(dimensions, {}, {1, 1, 1}, dimensions == 3 ? "xyz" : "xy")) +
            fluid_text(dimensions, spacing, 1, std::string(heat_text)) + sound_speed_text(slow_sound);
  s.start = lattice(dimensions, {}, {1, 1, 1}, spacing);
  perturb(s.start, dimensions, r["perturbation"]);
  for (const Triple& x : s.start.position) s.start.temperature.push_back(spot(x, dimensions, 0));
  const auto simulation = Simulation::make(r, s, report);
  simulation->run_until(spot_size * spot_size / 4);

  const Cloud c = simulation->cloud();
  FieldError error;
  for (std::size_t k = 0; k < c.count(); ++k) error.add(c.temperature[k], spot(c.position[k], dimensions, c.time));
  report.judge("temperature_l2", error.l2());
}

// ---- two slabs ------------------------------------------------------------------------------------------------------

/// Both slabs as bodies of their own, stand-ins as the particles are given; diffusivity 1 on the left.
std::string slabs_text(double spacing, double ratio) {
  const auto body = [](double left, double k) {
    return fmt::format("[[fluid.body]]\nbox = {}\n", box_text(2, {left, 0, 0}, {left + 1, 1, 0})) +
           (k == 1 ? "" : fmt::format("diffusivity = {:.17g}\n", k));
  };
  return fmt::format("[fluid]\nspacing = {:.17g}\ndensity = 1\n{}{}{}[run]\nend_time = 1\n", spacing, heat_text,
                     body(-1, 1), body(0, ratio)) +
         sound_speed_text(slow_sound);
}

/// A bar from −1 to 1, cold on the left and hot on the right, periodic across.
void run_two_slabs(const Request& r, Report& report) {
  report.expect("temperature_l2", 0.005);
  const double spacing = 1.0 / static_cast<double>(r.size), width = 8 * spacing, ratio = r["conductivity_ratio"];
  Setup s;
  s.scene = scene_head(2, {}, periodic_text(2, {-2, 0, 0}, {2, width, 0}, "y")) + slabs_text(spacing, ratio);
  s.start = lattice(2, {-1, 0, 0}, {1, width, 0}, spacing);
  for (const Triple& x : s.start.position) {
    s.start.temperature.push_back(x[0] < 0 ? -1 : 1);
    s.start.conductivity.push_back(x[0] < 0 ? 1 : ratio);
  }
  const auto simulation = Simulation::make(r, s, report);
  simulation->run_until(r["end_time"]);

  const Cloud c = simulation->cloud();
  const TwoSlabs exact(1, ratio, c.time);
  FieldError error;
  for (std::size_t k = 0; k < c.count(); ++k) error.add(c.temperature[k], exact.temperature(c.position[k][0], c.time));
  report.judge("temperature_l2", error.l2());
}

}  // namespace

Case hot_spot() {
  return {"hot-spot",
          "conduction of a Gaussian until it is √2 as wide; relative L2 of the temperature",
          "particles a side",
          50,
          10,
          {{"perturbation", 0, "width of the random displacements, spacings"}, {"dimensions", 2, "2 or 3"}},
          run_hot_spot};
}

Case two_slabs() {
  return {"two-slabs",
          "conduction between a cold and a hot slab in contact; relative L2 of the temperature",
          "particles a slab's thickness",
          50,
          10,
          {{"conductivity_ratio", 1, "of the hot slab over the cold one"},
           {"end_time", 0.02, "thickness²/k of the cold slab"}},
          run_two_slabs};
}

}  // namespace molten::study
